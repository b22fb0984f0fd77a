// The 13/7 wavelet of coder 2 (docs/emap-format.md, "Coder 2").

function rectangular_levels(columns, rows) {
  let levels = 1;
  for (let side = Math.ceil(Math.max(columns, rows) / 2); side > 4 && levels < 8; side = Math.ceil(side / 2)) ++levels;
  return levels;
}

// Index mirrored at 0 and at length - 1.
function mirrored(i, length) {
  const last = length - 1;
  while (i < 0 || i > last) i = i < 0 ? -i : 2 * last - i;
  return i;
}

// Adds factor times (9 (a + b) - (c + d)) to every second line from `parity` on: `count` lines of `width` numbers, the
// numbers of a line next to each other, lines `stride` apart.
function lift_lines(values, count, width, stride, parity, factor) {
  for (let i = parity; i < count; i += 2) {
    const a = mirrored(i - 1, count) * stride, b = mirrored(i + 1, count) * stride;
    const c = mirrored(i - 3, count) * stride, d = mirrored(i + 3, count) * stride;
    for (let k = 0, target = i * stride; k < width; ++k, ++target)
      values[target] += factor * (9 * (values[a + k] + values[b + k]) - (values[c + k] + values[d + k]));
  }
}

// One line of numbers, in place.
function lift_line(values, count, parity, factor) {
  for (let i = parity; i < count; i += 2) {
    const inside = i >= 3 && i + 3 < count;
    const a = inside ? i - 1 : mirrored(i - 1, count), b = inside ? i + 1 : mirrored(i + 1, count);
    const c = inside ? i - 3 : mirrored(i - 3, count), d = inside ? i + 3 : mirrored(i + 3, count);
    values[i] += factor * (9 * (values[a] + values[b]) - (values[c] + values[d]));
  }
}

function synthesise_line(values, count) {
  if (count < 2) return;
  lift_line(values, count, 0, -1 / 32);
  lift_line(values, count, 1, 1 / 16);
}

// Where the number that belongs at `position` of a line lies: low-pass in front.
function unmixed(position, length) {
  return position % 2 === 0 ? position / 2 : Math.ceil(length / 2) + (position - 1) / 2;
}

// image: Float64Array of `stride` columns; its rectangle of `columns` by `rows` is synthesised in place.
function synthesise_level(image, stride, columns, rows) {
  const scratch = new Float64Array(columns * rows);
  for (let r = 0; r < rows; ++r) {
    const from = unmixed(r, rows) * stride;
    scratch.set(image.subarray(from, from + columns), r * columns);
  }
  if (rows > 1) {
    lift_lines(scratch, rows, columns, columns, 0, -1 / 32);
    lift_lines(scratch, rows, columns, columns, 1, 1 / 16);
  }
  for (let r = 0; r < rows; ++r) {
    const line = image.subarray(r * stride, r * stride + columns);
    for (let c = 0; c < columns; ++c) line[c] = scratch[r * columns + unmixed(c, columns)];
    synthesise_line(line, columns);
  }
}

function rectangular_synthesis(columns, rows, levels, coefficients) {
  for (const size of sizes_of_levels(columns, rows, levels).reverse())
    synthesise_level(coefficients, columns, size.columns, size.rows);
}

// The root of the sum of squares of what one coefficient becomes on a long line.
function line_norm(level, is_high) {
  let line = new Float64Array(16);
  line[8] = 1;
  for (let l = level; l > 0; --l) {
    const mixed = new Float64Array(2 * line.length);
    for (let i = 0; i < line.length; ++i) mixed[2 * i + (is_high && l === level ? 1 : 0)] = line[i];
    synthesise_line(mixed, mixed.length);
    line = mixed;
  }
  return Math.sqrt(line.reduce((sum, x) => sum + x * x, 0));
}

const line_norms = new Map();

function synthesis_norm(band) {
  const norm = (is_high) => {
    const key = 2 * band.level + (is_high ? 1 : 0);
    if (!line_norms.has(key)) line_norms.set(key, line_norm(band.level, is_high));
    return line_norms.get(key);
  };
  return norm(band.kind % 2 === 1) * norm(band.kind >= 2);
}
