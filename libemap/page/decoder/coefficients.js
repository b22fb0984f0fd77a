// Quantised coefficients of coder 2 (docs/emap-format.md, "Coder 2", "Values").

const LARGEST_VALUE = 1 << 28;
const UNARY = 14;          // magnitudes up to this one are counted out
const LONGEST_ESCAPE = 26;

const TWELVE_CLASSES = Uint8Array.from({ length: 42 }, (_, x) => {
  const limits = [0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 40];
  const found = limits.findIndex((limit) => x <= limit);
  return found < 0 ? 11 : found;
});

function twelve_classes(x) {
  return x > 40 ? 11 : TWELVE_CLASSES[x];
}

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

// 0 for 0, 1 for positive, 2 for negative
function sign_class(value) {
  return value === 0 ? 0 : value > 0 ? 1 : 2;
}

class CoefficientDecoding {
  constructor() {
    this.band_is_empty = new SimpleBits(4 * 8 * 2);
    this.escape = new SimpleBits(LONGEST_ESCAPE);
    this.zero = new MixedBits([12 * 32, 48 * 4, 48 * 4, 144 * 4, 36 * 16, 16 * 8, 12 * 32], 12);
    this.sign = new MixedBits([9 * 4, 27 * 4, 81], 4);
    this.larger = new MixedBits([UNARY * 12, UNARY * 36, UNARY * 32, UNARY * 36], UNARY);
  }

  // The map's values, whole numbers of steps.
  decode(decoder, columns, rows, bands, support) {
    this.decoder = decoder;
    this.columns = columns;
    this.support = support;
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
    const band = bands[b], parent = parent_band(bands, b), sisters = [];
    for (let i = 1; i < band.kind && i <= b; ++i)
      if (bands[b - i].level === band.level && bands[b - i].kind !== 0) sisters.push(bands[b - i]);
    for (let r = 0; r < band.rows && !this.decoder.exhausted(); ++r)
      for (let c = 0; c < band.columns; ++c) {
        const here = (band.row + r) * this.columns + band.column + c;
        if (!this.support[here]) continue;
        const coded = this.decode_value(band, parent, sisters, r, c, here);
        const value = band.kind === 0 ? this.predicted(r, c, here) + coded : coded;
        this.values[here] = Math.min(Math.max(value, -LARGEST_VALUE), LARGEST_VALUE);
        this.magnitudes[here] = Math.abs(coded);
      }
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

  surrounded(band, r, c, here) {
    const { columns, support } = this;
    let count = -1;
    if (c > 0) count += support[here - 1];
    if (r > 0) count += support[here - columns];
    if (c + 1 < band.columns) count += support[here + 1];
    if (r + 1 < band.rows) count += support[here + columns];
    return Math.max(count, 0);
  }

  decode_value(band, parent, sisters, r, c, here) {
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
    const near12 = twelve_classes(near), near8 = eight_classes(near);
    const parent6 = six_classes(parent_weight), sisters6 = six_classes(sister_weight);
    const pattern = (((Math.min(west, 2) * 3 + Math.min(north, 2)) * 2 + Math.min(north_west, 1)) * 2 +
      Math.min(north_east, 1)) * 4 + 2 * Math.min(west2, 1) + Math.min(north2, 1);
    const zero = this.zero.contexts;
    zero[0] = (near12 * 4 + kind) * 8 + level;
    zero[1] = (parent6 * 8 + near8) * 4 + kind;
    zero[2] = (sisters6 * 8 + near8) * 4 + kind;
    zero[3] = pattern * 4 + kind;
    zero[4] = ((parent6 * 6 + sisters6) * 4 + Math.min(near, 3)) * 4 + kind;
    zero[5] = sixteen_classes(all) * 8 + level;
    zero[6] = ((this.surrounded(band, r, c, here) * 3 + Math.min(near, 2)) * 4 + kind) * 8 + level;
    if (this.zero.decode(decoder, near12)) return 0;

    const negative = this.decode_sign(kind, r, c, here);
    const magnitude = this.decode_magnitude(near12, parent6 * 6 + sisters6, kind * 8 + level,
      Math.min(Math.max(west, north), 5) * 6 + Math.min(Math.max(parent_weight >> 1, sister_weight >> 1), 5));
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

  decode_magnitude(near12, coarser36, kind_and_level, largest36) {
    const contexts = this.larger.contexts;
    let magnitude = 1;
    for (; magnitude < UNARY; ++magnitude) {
      const i = magnitude - 1;
      contexts[0] = i * 12 + near12;
      contexts[1] = i * 36 + coarser36;
      contexts[2] = i * 32 + kind_and_level;
      contexts[3] = i * 36 + largest36;
      if (!this.larger.decode(this.decoder, i)) return magnitude;
    }
    let length = 0;
    while (length < LONGEST_ESCAPE && this.escape.decode(this.decoder, length)) ++length;
    return magnitude + 2 ** length + this.decoder.uniform(length) - 1;
  }
}
