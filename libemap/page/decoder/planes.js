// Base planes of the patches (docs/emap-format.md, "Planes").

const NORMAL_BITS = 10;
const TURN_BITS = 6;

// The length of a whole number in binary.
function bit_length(x) {
  return 32 - Math.clz32(x);
}

function farthest_origin(samples_per_diagonal) {
  return Math.floor(samples_per_diagonal / 2) + 2;
}

function plane_bits(samples_per_diagonal) {
  return 2 * NORMAL_BITS + TURN_BITS + 3 * bit_length(2 * farthest_origin(samples_per_diagonal)) +
    2 * bit_length(samples_per_diagonal + 2);
}

function read_plane(decoder, samples_per_diagonal) {
  const farthest = farthest_origin(samples_per_diagonal);
  const origin_bits = bit_length(2 * farthest), size_bits = bit_length(samples_per_diagonal + 2);
  const normal_x = decoder.uniform(NORMAL_BITS), normal_y = decoder.uniform(NORMAL_BITS);
  const turn = decoder.uniform(TURN_BITS);
  const origin = [0, 1, 2].map(() => decoder.uniform(origin_bits) - farthest);
  const columns = decoder.uniform(size_bits), rows = decoder.uniform(size_bits);
  return { ...axes_of(normal_of(normal_x, normal_y), turn), origin, columns, rows };
}

function sign_of(x) {
  return x < 0 ? -1 : 1;
}

function scaled(factor, a) {
  return [factor * a[0], factor * a[1], factor * a[2]];
}

function sum_of(a, b) {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

function difference_of(a, b) {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function normalised(a) {
  const length = Math.sqrt(dot(a, a));
  return [a[0] / length, a[1] / length, a[2] / length];
}

function normal_of(coded_x, coded_y) {
  const x = (2 * coded_x) / 1023 - 1, y = (2 * coded_y) / 1023 - 1, z = 1 - Math.abs(x) - Math.abs(y);
  if (z >= 0) return normalised([x, y, z]);
  return normalised([(1 - Math.abs(y)) * sign_of(x), (1 - Math.abs(x)) * sign_of(y), z]);
}

function axes_of(normal, turn) {
  const [x, y, z] = normal, s = sign_of(z), a = -1 / (s + z), b = x * y * a;
  const u = [1 + s * x * x * a, s * b, -s * x], v = [b, s + y * y * a, -y];
  const angle = (Math.PI * turn) / 128, cosine = Math.cos(angle), sine = Math.sin(angle);
  return {
    normal,
    axis_u: sum_of(scaled(cosine, u), scaled(sine, v)),
    axis_v: difference_of(scaled(cosine, v), scaled(sine, u)),
  };
}
