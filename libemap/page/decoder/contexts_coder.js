// Elevations of coder 2, `contexts` (docs/emap-format.md, "Coder 2").

const RECONSTRUCTION = 0.03;

// Elevations from values, 0 outside the mask.
function elevations_of_values(patch, bands, levels, values, step) {
  const { columns, rows } = patch;
  const elevations = new Float64Array(values.length);
  for (const band of bands) {
    const band_step = (2 * step) / synthesis_norm(band), offset = band.kind === 0 ? 0 : RECONSTRUCTION;
    for (let r = band.row; r < band.row + band.rows; ++r)
      for (let i = r * columns + band.column; i < r * columns + band.column + band.columns; ++i)
        if (values[i] !== 0) elevations[i] = band_step * (values[i] < 0 ? values[i] - offset : values[i] + offset);
  }
  rectangular_synthesis(columns, rows, levels, elevations);
  for (let i = 0; i < elevations.length; ++i) if (!patch.mask[i]) elevations[i] = 0;
  return elevations;
}

// One for all the maps of a stream.
class ContextsCoder {
  constructor(stream) {
    this.step = stream.step;
    this.coding = new CoefficientDecoding();
  }

  decode(decoder, patch) {
    const levels = rectangular_levels(patch.columns, patch.rows);
    const bands = wavelet_bands(patch.columns, patch.rows, levels);
    const support = coefficient_support(patch.columns, patch.rows, levels, patch.mask);
    const visibility = coefficient_visibility(patch.columns, patch.rows, bands, patch.mask);
    const values = this.coding.decode(decoder, patch.columns, patch.rows, bands, support, visibility);
    return elevations_of_values(patch, bands, levels, values, this.step);
  }
}
