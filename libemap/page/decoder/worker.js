// Decoding beside the page, in a worker made of this same text: { bytes } comes in; { progress }, { model }, { gaps } go
// out, in this order, or { error }.

// How much of the time to the model each part takes, roughly.
const SHARES = { masks: [0, 0.35], elevations: [0.35, 0.4], model: [0.75, 0.25] };

// send(message): progress is 0 to 1 and sent each time that it grew by a hundredth.
function decode_in_steps(bytes, send) {
  let reported = 0;
  const progress = (part, done) => {
    const all = SHARES[part][0] + SHARES[part][1] * done;
    if (all - reported >= 0.01) send({ progress: (reported = all) });
  };
  try {
    const begin = performance.now();
    const stream = decode_stream(bytes, progress);
    const decoded = performance.now();
    const model = build_model(stream, progress);
    Object.assign(model, {
      bytes: bytes.length,
      coder_name: stream.coder_name,
      decode_seconds: (decoded - begin) / 1000,
      build_seconds: (performance.now() - decoded) / 1000,
    });
    send({ model });
    send({ gaps: gaps_if_possible(stream, model) });
  } catch (error) {
    send({ error: message_of(error) });
  }
}

// null where they can't be closed: then the model is seen with them.
function gaps_if_possible(stream, model) {
  try {
    const begin = performance.now();
    return { ...build_gaps(stream, model), seconds: (performance.now() - begin) / 1000 };
  } catch {
    return null;
  }
}

// What to tell of an error: a damaged stream's own words, or the browser's.
function message_of(error) {
  if (error instanceof StreamError) return `The model is damaged: ${error.message}.`;
  if (error instanceof RangeError) return `The model is too large for this browser's memory (${error.message}).`;
  return `The model could not be decoded: ${error.message}.`;
}

if (typeof document === "undefined")
  self.onmessage = ({ data }) => decode_in_steps(data.bytes, (message) => self.postMessage(message));
