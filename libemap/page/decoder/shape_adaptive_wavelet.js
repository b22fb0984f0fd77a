// The shape-adaptive 9/7 wavelet of coder 1 (docs/emap-format.md, "Coder 1").

const LIFTING = [
  { parity: 0, factor: -0.443506852043971 },
  { parity: 1, factor: -0.882911075530934 },
  { parity: 0, factor: 0.052980118572961 },
  { parity: 1, factor: 1.586134342059924 },
];
const LOW_PASS_SCALE = 1 / 1.149604398860241;
const HIGH_PASS_SCALE = 1.149604398860241;

function shape_adaptive_levels(columns, rows) {
  let levels = 0;
  for (let side = Math.min(columns, rows); side >= 16 && levels < 6; side = Math.ceil(side / 2)) ++levels;
  return levels;
}

// Calls visit(begin, end) for each run of supported samples of a line.
function for_runs(mask, first, stride, length, visit) {
  for (let begin = 0; begin < length; ++begin) {
    if (!mask[first + begin * stride]) continue;
    let end = begin + 1;
    while (end < length && mask[first + end * stride]) ++end;
    visit(begin, end);
    begin = end;
  }
}

// Where the coefficient of position p of a line lies.
function coefficient_place(p, is_single, length) {
  return p % 2 === 0 || is_single ? p >> 1 : ((length + 1) >> 1) + (p >> 1);
}

function synthesise_run(x, begin, end) {
  if (end - begin === 1) {
    x[begin] /= Math.SQRT2;
    return;
  }
  for (let p = begin; p < end; ++p) x[p] *= p & 1 ? HIGH_PASS_SCALE : LOW_PASS_SCALE;
  for (const { parity, factor } of LIFTING)
    for (let p = begin + ((begin ^ parity) & 1); p < end; p += 2)
      x[p] += factor * (x[p > begin ? p - 1 : p + 1] + x[p + 1 < end ? p + 1 : p - 1]);
}

// The mask before each step of the analysis (rows of level 1, columns of level 1, rows of level 2, ...), and last the
// support.
function masks_of_steps(columns, rows, levels, mask) {
  const masks = [mask];
  for (const size of sizes_of_levels(columns, rows, levels)) {
    masks.push(moved_mask(masks[masks.length - 1], size.rows, columns, size.columns, 1));
    masks.push(moved_mask(masks[masks.length - 1], size.columns, 1, size.rows, columns));
  }
  return masks;
}

// Each of `count` lines, `line_stride` apart, with its supported samples moved as the coefficients move.
function moved_mask(mask, count, line_stride, length, stride) {
  const moved = mask.slice();
  for (let line = 0; line < count; ++line) {
    const first = line * line_stride;
    for (let i = 0; i < length; ++i) moved[first + i * stride] = 0;
    for_runs(mask, first, stride, length, (begin, end) => {
      for (let p = begin; p < end; ++p) moved[first + coefficient_place(p, end - begin === 1, length) * stride] = 1;
    });
  }
  return moved;
}

function synthesise_lines(mask, samples, count, line_stride, length, stride) {
  const line = new Float64Array(length);
  for (let i = 0; i < count; ++i) {
    const first = i * line_stride;
    line.fill(0);
    for_runs(mask, first, stride, length, (begin, end) => {
      for (let p = begin; p < end; ++p)
        line[p] = samples[first + coefficient_place(p, end - begin === 1, length) * stride];
      synthesise_run(line, begin, end);
    });
    for (let p = 0; p < length; ++p) samples[first + p * stride] = line[p];
  }
}

function shape_adaptive_synthesis(columns, rows, levels, masks, coefficients) {
  const sizes = sizes_of_levels(columns, rows, levels);
  for (let level = levels - 1; level >= 0; --level) {
    const size = sizes[level];
    synthesise_lines(masks[2 * level + 1], coefficients, size.columns, 1, size.rows, columns);
    synthesise_lines(masks[2 * level], coefficients, size.rows, columns, size.columns, 1);
  }
}
