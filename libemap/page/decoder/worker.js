// Decoding beside the page, in a worker made of this same text: { bytes } comes in; { progress }, then { model } or
// { error } go out.

// How much of the time each part takes, roughly.
const SHARES = { masks: [0, 0.35], elevations: [0.35, 0.4], model: [0.75, 0.25] };

// report(done): with done 0 to 1, each time that it has grown by a hundredth.
function decode_model(bytes, report) {
  let reported = 0;
  const progress = (part, done) => {
    const all = SHARES[part][0] + SHARES[part][1] * done;
    if (all - reported >= 0.01) report((reported = all));
  };
  const begin = performance.now();
  const stream = decode_stream(bytes, progress);
  const decoded = performance.now();
  const model = build_model(stream, progress);
  return {
    ...model,
    bytes: bytes.length,
    coder_name: stream.coder_name,
    decode_seconds: (decoded - begin) / 1000,
    model_seconds: (performance.now() - decoded) / 1000,
  };
}

// What to tell of an error: a damaged stream's own words, or the browser's.
function message_of(error) {
  if (error instanceof StreamError) return `The model is damaged: ${error.message}.`;
  if (error instanceof RangeError) return `The model is too large for this browser's memory (${error.message}).`;
  return `The model could not be decoded: ${error.message}.`;
}

if (typeof document === "undefined")
  self.onmessage = ({ data }) => {
    try {
      const model = decode_model(data.bytes, (progress) => self.postMessage({ progress }));
      self.postMessage({ model }, buffers_of(model));
    } catch (error) {
      self.postMessage({ error: message_of(error) });
    }
  };
