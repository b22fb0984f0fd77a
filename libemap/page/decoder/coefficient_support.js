// Which coefficients coder 2 codes, and what they see (docs/emap-format.md, "Coder 2").

// Which coefficients are coded, one byte each.
function coefficient_support(columns, rows, levels, mask) {
  const support = new Uint8Array(mask.length);
  if (mask.length === 0) return support;
  const put = (image, row, column) => {
    for (let r = 0; r < image.rows; ++r)
      support.set(image.values.subarray(r * image.columns, (r + 1) * image.columns), (row + r) * columns + column);
  };
  let low = { columns, rows, values: mask };
  for (let level = 1; level <= levels; ++level) {
    const left = support_along_rows(low, 0), right = support_along_rows(low, 1);
    const next = support_along_columns(left, 0);
    if (level > 1) {
      put(support_along_columns(right, 0), 0, next.columns);
      put(support_along_columns(left, 1), next.rows, 0);
      put(support_along_columns(right, 1), next.rows, next.columns);
    }
    low = next;
  }
  low.values.fill(1);
  put(low, 0, 0);
  return support;
}

// high: 0 for the low-pass half, 1 for the high-pass half.
function support_along_rows(image, high) {
  const columns = (image.columns + 1 - high) >> 1;
  const values = new Uint8Array(columns * image.rows);
  for (let r = 0; r < image.rows; ++r)
    for (let n = 0, row = r * image.columns; n < columns; ++n) {
      const middle = 2 * n + high;
      values[r * columns + n] = image.values[row + Math.max(middle - 1, 0)] | image.values[row + middle] |
        image.values[row + Math.min(middle + 1, image.columns - 1)];
    }
  return { columns, rows: image.rows, values };
}

function support_along_columns(image, high) {
  const columns = image.columns, rows = (image.rows + 1 - high) >> 1;
  const values = new Uint8Array(columns * rows);
  for (let n = 0; n < rows; ++n) {
    const middle = 2 * n + high;
    const before = Math.max(middle - 1, 0) * columns, after = Math.min(middle + 1, image.rows - 1) * columns;
    for (let c = 0; c < columns; ++c)
      values[n * columns + c] = image.values[before + c] | image.values[middle * columns + c] | image.values[after + c];
  }
  return { columns, rows, values };
}

const VISIBILITY_CLASSES = 7;

function class_of_share(part, whole) {
  if (part === 0) return 0;
  if (10 * part < whole) return 1;
  if (4 * part < whole) return 2;
  if (2 * part < whole) return 3;
  if (4 * part < 3 * whole) return 4;
  return part < whole ? 5 : 6;
}

// Supported samples in blocks twice as large.
function halved_counts(fine) {
  const columns = (fine.columns + 1) >> 1, rows = (fine.rows + 1) >> 1;
  const values = new Uint32Array(columns * rows);
  for (let r = 0; r < fine.rows; ++r)
    for (let c = 0; c < fine.columns; ++c) values[(r >> 1) * columns + (c >> 1)] += fine.values[r * fine.columns + c];
  return { columns, rows, values };
}

// Class of the part of the mask that each coefficient sees.
function coefficient_visibility(columns, rows, bands, mask) {
  const visibility = new Uint8Array(mask.length);
  const levels = [{ columns, rows, values: mask }];
  for (const band of bands) {
    while (levels.length <= band.level) levels.push(halved_counts(levels[levels.length - 1]));
    const counts = levels[band.level];
    const at = (r, c) => (r < counts.rows && c < counts.columns ? counts.values[r * counts.columns + c] : 0);
    const right = band.kind & 1, down = band.kind >> 1;
    const whole = ((1 + right) * (1 + down)) << (2 * band.level);
    for (let r = 0; r < band.rows; ++r)
      for (let c = 0; c < band.columns; ++c) {
        let part = at(r, c);
        if (right) part += at(r, c + 1);
        if (down) part += at(r + 1, c);
        if (right && down) part += at(r + 1, c + 1);
        visibility[(band.row + r) * columns + band.column + c] = class_of_share(part, whole);
      }
  }
  return visibility;
}
