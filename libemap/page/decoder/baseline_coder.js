// Elevations of coder 1, `baseline` (docs/emap-format.md, "Coder 1").

const MOST_PLANES = 29;

// One for all the maps of a stream.
class BaselineCoder {
  constructor(stream) {
    this.finest_step = stream.diagonal / 2 ** 22;
    this.models = new SetSplittingModels();
    this.plane_bits = new SimpleBits(1 << 5);
    this.pass_bits = new SimpleBits(1 << 6);
  }

  decode(decoder, { columns, rows, mask }) {
    const planes = this.decode_number(decoder, this.plane_bits, 5);
    const passes = planes > 0 ? this.decode_number(decoder, this.pass_bits, 6) : 0;
    if (planes > MOST_PLANES || passes > 2 * planes) throw new StreamError("a map has more bit planes than there are");
    const levels = shape_adaptive_levels(columns, rows);
    const masks = masks_of_steps(columns, rows, levels, mask);
    const elevations = new Float64Array(mask.length);
    if (passes === 0) return elevations;
    const sets = new SetSplitting(this.models, decoder, columns, rows, wavelet_bands(columns, rows, levels),
      masks[masks.length - 1], planes - 1);
    const halves = sets.decode(passes);
    for (let i = 0; i < halves.length; ++i) elevations[i] = halves[i] * (this.finest_step / 2);
    shape_adaptive_synthesis(columns, rows, levels, masks, elevations);
    return elevations;
  }

  // Bit by bit from the highest, with the bits before as context.
  decode_number(decoder, bits, length) {
    let prefix = 1;
    for (let i = 0; i < length; ++i) prefix = prefix * 2 + bits.decode(decoder, prefix);
    return prefix - 2 ** length;
  }
}
