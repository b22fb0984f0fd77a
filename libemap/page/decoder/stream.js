// A whole .emap file (docs/emap-format.md, "The file").

const CODERS = { 1: { name: "baseline", type: BaselineCoder }, 2: { name: "contexts", type: ContextsCoder } };
const CHECK_OFFSET = 7;
const MOST_PATCHES = 2 ** 20;

// CRC-16/CCITT-FALSE of all bytes but the check itself.
function check_of(bytes) {
  const table = Uint16Array.from({ length: 256 }, (_, byte) => {
    let crc = byte << 8;
    for (let bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ (crc & 0x8000 ? 0x1021 : 0);
    return crc & 0xffff;
  });
  let crc = 0xffff;
  for (let i = 0; i < bytes.length; ++i)
    if (i !== CHECK_OFFSET && i !== CHECK_OFFSET + 1) crc = ((crc << 8) & 0xffff) ^ table[(crc >> 8) ^ bytes[i]];
  return crc;
}

// 2^(k/64) for k in 0 ... 63, rounded to the nearest double: by whole numbers, because browsers' Math.pow may differ in
// the last bit. The sixth square root of 2^k, with 60 digits behind the point more than a double has.
function sixty_fourth_power_of_two(k) {
  const digits = 120n;
  let root = 1n << (digits + BigInt(k));  // 2^k, then its square roots, in 2^-digits
  for (let i = 0; i < 6; ++i) root = integer_square_root(root << digits);
  return Number(root) / 2 ** 120;
}

function integer_square_root(x) {
  let root = 1n << BigInt((x.toString(2).length + 1) >> 1);
  for (;;) {
    const next = (root + x / root) >> 1n;
    if (next >= root) return root;
    root = next;
  }
}

// 2^(-code/64)
function step_factor(code) {
  const octaves = Math.ceil(code / 64);
  return sixty_fourth_power_of_two(octaves * 64 - code) * 2 ** -octaves;
}

function read_varint(bytes, state) {
  let value = 0;
  for (let shift = 0; shift < 35; shift += 7) {
    if (state.next >= bytes.length) throw new StreamError("it ends within its header");
    const byte = bytes[state.next++];
    value += (byte & 127) * 2 ** shift;
    if (byte < 128) break;
  }
  return value;
}

function read_header(bytes) {
  if (bytes.length < 4 || String.fromCharCode(...bytes.subarray(0, 4)) !== "EMAP")
    throw new StreamError("it does not begin with EMAP");
  if (bytes.length < 36) throw new StreamError("it ends within its header");
  if (bytes[4] !== 2) throw new StreamError(`it has version ${bytes[4]}, and this page reads version 2`);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const corner = (offset) => [0, 4, 8].map((axis) => view.getFloat32(offset + axis, true));
  const state = { next: 35 };
  const header = {
    coder: bytes[5],
    from_points: (bytes[6] & 1) !== 0,
    check: view.getUint16(CHECK_OFFSET, true),
    least: corner(9),
    most: corner(21),
    step_code: view.getUint16(33, true),
    samples_per_diagonal: read_varint(bytes, state),
    patch_count: read_varint(bytes, state),
    header_bytes: state.next,
  };
  const size = difference_of(header.most, header.least);
  header.diagonal = Math.sqrt(size[0] * size[0] + size[1] * size[1] + size[2] * size[2]);
  header.spacing = header.diagonal / header.samples_per_diagonal;
  header.step = header.diagonal * step_factor(header.step_code);
  return header;
}

function refuse_bad_header(header, bytes) {
  const finite = [...header.least, ...header.most].every(Number.isFinite);
  if (!finite || header.least.some((x, axis) => x > header.most[axis]) || !(header.diagonal > 0))
    throw new StreamError("its bounding box is not one");
  if (header.samples_per_diagonal < 1 || header.samples_per_diagonal > 65536)
    throw new StreamError("its number of samples per diagonal is not 1 to 65536");
  if (check_of(bytes) !== header.check) throw new StreamError("its check does not match its bytes");
  if (!CODERS[header.coder]) throw new StreamError(`it was written by coder number ${header.coder}, unknown to this page`);
  const most_bits = 8 * (bytes.length + 8);
  if (header.patch_count > MOST_PATCHES || header.patch_count * plane_bits(header.samples_per_diagonal) > most_bits)
    throw new StreamError("it has more patches than bytes for them");
}

function refuse_exhausted(decoder, part) {
  if (decoder.exhausted()) throw new StreamError(`it ends within its ${part}`);
}

function read_patches(decoder, header, byte_count) {
  const patches = [];
  let spanned = 0;
  for (let i = 0; i < header.patch_count; ++i) {
    patches.push(read_plane(decoder, header.samples_per_diagonal));
    spanned += patches[i].columns * patches[i].rows;
  }
  refuse_exhausted(decoder, "planes");
  if (spanned > Math.min(2 ** 22 + 1024 * byte_count, 2 ** 28))
    throw new StreamError("its maps have more samples than its bytes may hold");
  return patches;
}

// Where the sample of column 0 and row 0 lies at elevation 0.
function origin_of(patch, header) {
  const centre = header.least.map((x, axis) => (x + header.most[axis]) / 2);
  const [u, v, n] = patch.origin;
  const offset = sum_of(sum_of(scaled(u, patch.axis_u), scaled(v, patch.axis_v)), scaled(n, patch.normal));
  return sum_of(centre, scaled(header.spacing, offset));
}

// The file's header and its patches: each with its plane (origin, axis_u, axis_v, normal), columns, rows, mask (one byte
// a sample) and elevation (doubles, 0 outside the mask), in the model's units.
//
// progress(part, done): called now and then, done being 0 to 1. Throws StreamError for damaged bytes.
function decode_stream(bytes, progress = () => {}) {
  const header = read_header(bytes);
  refuse_bad_header(header, bytes);
  const decoder = new RangeDecoder(bytes, header.header_bytes);
  const patches = read_patches(decoder, header, bytes.length);
  const masks = new MaskDecoding();
  patches.forEach((patch, i) => {
    patch.origin = origin_of(patch, header);
    patch.mask = masks.decode(decoder, patch.columns, patch.rows);
    refuse_exhausted(decoder, "masks");
    progress("masks", (i + 1) / patches.length);
  });
  const coder = new CODERS[header.coder].type(header);
  patches.forEach((patch, i) => {
    patch.elevation = coder.decode(decoder, patch);
    refuse_exhausted(decoder, "elevations");
    progress("elevations", (i + 1) / patches.length);
  });
  return { header, patches, coder_name: CODERS[header.coder].name };
}
