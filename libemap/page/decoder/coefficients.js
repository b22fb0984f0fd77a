// Quantised coefficients of coder 2 (docs/emap-format.md, "Coder 2", "Values").

const LARGEST_VALUE = 1 << 28;
const LONGEST = 27;       // bits of a magnitude
const EXPECTED = 64;      // classes of the magnitude that is expected
const FIRST_MEAN = 64 * 256;
const MEAN_MEMORY = 100;

// The expected magnitude's weights, in 1/256, by kind: running mean, W, N, NW, NE, WW, NN, parent, sisters.
const EXPECTATION = [
  [256, 0, 0, 0, 0, 0, 0, 0, 0],
  [6, 73, 97, 24, 31, 2, 13, 1, 0],
  [4, 99, 44, 21, 28, 20, 0, 1, 7],
  [1, 57, 50, 23, 29, 0, 0, 1, 3],
];

function eight_classes(x) {
  return x < 5 ? x : x < 8 ? 5 : x < 16 ? 6 : 7;
}

function six_classes(x) {
  return x < 3 ? x : x < 6 ? 3 : x < 12 ? 4 : 5;
}

function sixteen_classes(x) {
  if (x < 8) return x;
  const length = bit_length(x);
  return Math.min(7 + 2 * (length - 4) + ((x >>> (length - 2)) & 1), 15);
}

// Two to an octave.
function expected_class(expected) {
  const x = Math.min(expected, 1073741823);
  if (x < 2) return x;
  const length = bit_length(x);
  return 2 * (length - 1) + ((x >> (length - 2)) & 1);
}

// 0 for 0, 1 for positive, 2 for negative
function sign_class(value) {
  return value === 0 ? 0 : value > 0 ? 1 : 2;
}

class CoefficientDecoding {
  constructor() {
    this.band_is_empty = new SimpleBits(4 * 8 * 2);
    this.second_bit = new SimpleBits((LONGEST + 1) * 2);
    this.zero = new MixedBits(
      [48 * 4, 144 * 4, 16 * 8, VISIBILITY_CLASSES * 96, EXPECTED * VISIBILITY_CLASSES], VISIBILITY_CLASSES * 3);
    this.sign = new MixedBits([9 * 4, 27 * 4, 81], 4);
    this.longer = new MixedBits(
      [7 * EXPECTED * VISIBILITY_CLASSES, EXPECTED * 4, LONGEST * 32, LONGEST * 49, LONGEST * 64],
      LONGEST * VISIBILITY_CLASSES);
    this.first_bit = new MixedBits(
      [(LONGEST + 1) * EXPECTED, (LONGEST + 1) * 32, (LONGEST + 1) * VISIBILITY_CLASSES], LONGEST + 1);
    // Mean magnitude so far, in 1/256, by kind and level.
    this.means = Array.from({ length: 32 }, () => ({ value: 0, count: 0 }));
  }

  // The map's values, whole numbers of steps.
  decode(decoder, columns, rows, bands, support, visibility) {
    this.decoder = decoder;
    this.columns = columns;
    this.support = support;
    this.visibility = visibility;
    this.values = new Int32Array(support.length);
    this.magnitudes = new Int32Array(support.length);  // of what was coded
    const last_was_empty = [0, 0, 0, 0];
    for (let b = 0; b < bands.length && !decoder.exhausted(); ++b) {
      const band = bands[b];
      if (!this.any_supported(band)) continue;
      const context = (band.kind * 8 + Math.min(band.level, 8) - 1) * 2 + last_was_empty[band.kind];
      last_was_empty[band.kind] = this.band_is_empty.decode(decoder, context);
      if (!last_was_empty[band.kind]) this.decode_band(bands, b);
    }
    return this.values;
  }

  any_supported(band) {
    for (let r = band.row; r < band.row + band.rows; ++r)
      for (let c = band.column; c < band.column + band.columns; ++c) if (this.support[r * this.columns + c]) return true;
    return false;
  }

  decode_band(bands, b) {
    const band = bands[b], parent = parent_band(bands, b), mean = this.begun_mean(band), sisters = [];
    for (let i = 1; i < band.kind && i <= b; ++i)
      if (bands[b - i].level === band.level && bands[b - i].kind !== 0) sisters.push(bands[b - i]);
    for (let r = 0; r < band.rows && !this.decoder.exhausted(); ++r)
      for (let c = 0; c < band.columns; ++c) {
        const here = (band.row + r) * this.columns + band.column + c;
        if (!this.support[here]) continue;
        const coded = this.decode_value(band, mean, parent, sisters, r, c, here);
        const value = band.kind === 0 ? this.predicted(r, c, here) + coded : coded;
        this.values[here] = Math.min(Math.max(value, -LARGEST_VALUE), LARGEST_VALUE);
        this.magnitudes[here] = Math.abs(coded);
        mean.count = Math.min(mean.count + 1, MEAN_MEMORY);
        mean.value += Math.trunc((256 * Math.abs(coded) - mean.value) / mean.count);
      }
  }

  begun_mean(band) {
    const level = Math.min(band.level, 8) - 1, place = band.kind * 8 + level;
    const mean = this.means[place];
    if (mean.count > 0) return mean;
    mean.count = 1;
    if (band.kind === 0) mean.value = FIRST_MEAN;
    else if (level + 1 < 8 && this.means[place + 1].count > 0) mean.value = Math.trunc(this.means[place + 1].value / 4);
    else mean.value = this.means[place - 8].value;
    return mean;
  }

  predicted(r, c, here) {
    if (r > 0 && c > 0) return Math.trunc((this.values[here - 1] + this.values[here - this.columns]) / 2);
    return c > 0 ? this.values[here - 1] : r > 0 ? this.values[here - this.columns] : 0;
  }

  weight_in(band, row, column) {
    const { columns, magnitudes } = this;
    row = Math.min(row, band.rows - 1);
    column = Math.min(column, band.columns - 1);
    const here = (band.row + row) * columns + band.column + column;
    let sum = 2 * magnitudes[here];
    if (row > 0) sum += magnitudes[here - columns];
    if (row + 1 < band.rows) sum += magnitudes[here + columns];
    if (column > 0) sum += magnitudes[here - 1];
    if (column + 1 < band.columns) sum += magnitudes[here + 1];
    return sum;
  }

  decode_value(band, mean, parent, sisters, r, c, here) {
    const { columns, magnitudes, decoder } = this;
    const kind = band.kind, level = Math.min(band.level, 8) - 1;
    const west = c > 0 ? magnitudes[here - 1] : 0, west2 = c > 1 ? magnitudes[here - 2] : 0;
    const north = r > 0 ? magnitudes[here - columns] : 0, north2 = r > 1 ? magnitudes[here - 2 * columns] : 0;
    const north_west = r > 0 && c > 0 ? magnitudes[here - columns - 1] : 0;
    const north_east = r > 0 && c + 1 < band.columns ? magnitudes[here - columns + 1] : 0;
    const parent_weight = parent ? this.weight_in(parent, r >> 1, c >> 1) : 0;
    let sister_weight = 0;
    for (const sister of sisters) sister_weight += this.weight_in(sister, r, c);

    const near = 2 * (west + north) + north_west + north_east;
    const all = 2 * near + west2 + north2 + 2 * parent_weight + sister_weight;
    const weights = EXPECTATION[kind];
    const expected = expected_class(Math.floor((weights[0] * mean.value) / 256) + weights[1] * west +
      weights[2] * north + weights[3] * north_west + weights[4] * north_east + weights[5] * west2 +
      weights[6] * north2 + weights[7] * parent_weight + weights[8] * sister_weight);
    const visible = this.visibility[here], visible_near = visible * 3 + Math.min(near, 2);
    const pattern = (((Math.min(west, 2) * 3 + Math.min(north, 2)) * 2 + Math.min(north_west, 1)) * 2 +
      Math.min(north_east, 1)) * 4 + 2 * Math.min(west2, 1) + Math.min(north2, 1);
    const zero = this.zero.contexts;
    zero[0] = (six_classes(sister_weight) * 8 + eight_classes(near)) * 4 + kind;
    zero[1] = pattern * 4 + kind;
    zero[2] = sixteen_classes(all) * 8 + level;
    zero[3] = (visible_near * 4 + kind) * 8 + level;
    zero[4] = expected * VISIBILITY_CLASSES + visible;
    if (this.zero.decode(decoder, visible_near)) return 0;

    const negative = this.decode_sign(kind, r, c, here);
    const beside = Math.min(bit_length(west), 6) * 7 + Math.min(bit_length(north), 6);
    const coarser = Math.min(bit_length(parent_weight), 7) * 8 + Math.min(bit_length(sister_weight), 7);
    const magnitude = this.decode_magnitude(kind, level, visible, expected, beside, coarser);
    return negative ? -magnitude : magnitude;
  }

  decode_sign(kind, r, c, here) {
    if (kind === 0) return this.decoder.bit(32768);
    const { columns, values } = this, contexts = this.sign.contexts;
    const west = c > 0 ? sign_class(values[here - 1]) : 0, west2 = c > 1 ? sign_class(values[here - 2]) : 0;
    const north = r > 0 ? sign_class(values[here - columns]) : 0;
    const north2 = r > 1 ? sign_class(values[here - 2 * columns]) : 0;
    const north_west = r > 0 && c > 0 ? sign_class(values[here - columns - 1]) : 0;
    const beside = west * 3 + north;
    contexts[0] = beside * 4 + kind;
    contexts[1] = (beside * 3 + north_west) * 4 + kind;
    contexts[2] = (beside * 3 + west2) * 3 + north2;
    return this.sign.decode(this.decoder, kind);
  }

  decode_magnitude(kind, level, visible, expected, beside, coarser) {
    const longer = this.longer.contexts;
    let length = 1;
    for (; length < LONGEST; ++length) {
      const relative = Math.max(expected - 2 * (length - 1), 0);
      longer[0] = (Math.min(length, 6) * EXPECTED + relative) * VISIBILITY_CLASSES + visible;
      longer[1] = relative * 4 + kind;
      longer[2] = length * 32 + kind * 8 + level;
      longer[3] = length * 49 + beside;
      longer[4] = length * 64 + coarser;
      if (!this.longer.decode(this.decoder, length * VISIBILITY_CLASSES + visible)) break;
    }
    if (length === 1) return 1;
    const first = this.first_bit.contexts;
    first[0] = length * EXPECTED + expected;
    first[1] = length * 32 + kind * 8 + level;
    first[2] = length * VISIBILITY_CLASSES + visible;
    const first_bit = this.first_bit.decode(this.decoder, length);
    if (length === 2) return 2 + first_bit;
    const top = (2 + first_bit) * 2 + this.second_bit.decode(this.decoder, length * 2 + first_bit);
    return top * 2 ** (length - 3) + this.decoder.uniform(length - 3);
  }
}
