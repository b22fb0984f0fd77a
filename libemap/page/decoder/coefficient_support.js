// Which coefficients coder 2 codes (docs/emap-format.md, "Coder 2").

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
