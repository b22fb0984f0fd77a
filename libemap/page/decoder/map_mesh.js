// Elevation maps as a graphics card takes them: 16-bit elevations and normals for each cell of each map, triangles between
// supported samples (libemap/elevation/canonical_mesh.h), one matrix for each patch.

const STEEPEST_SLOPE = Math.tan((85 * Math.PI) / 180);  // steeper triangles are walls that the surface does not have

// Calls visit(a, b, c) for the canonical triangles of a map, cells of the map, counter-clockwise.
function visit_grid_triangles(patch, visit) {
  const { columns, rows, mask, elevation } = patch;
  for (let row = 0; row + 1 < rows; ++row)
    for (let column = 0; column + 1 < columns; ++column) {
      const a = row * columns + column, b = a + 1, d = a + columns, c = d + 1;
      const supported = mask[a] + mask[b] + mask[c] + mask[d];
      if (supported < 3) continue;
      if (!mask[a]) visit(b, c, d);
      else if (!mask[b]) visit(a, c, d);
      else if (!mask[c]) visit(a, b, d);
      else if (!mask[d]) visit(a, b, c);
      else if (Math.abs(elevation[a] - elevation[c]) <= Math.abs(elevation[b] - elevation[d])) {
        visit(a, b, c);
        visit(a, c, d);
      } else {
        visit(a, b, d);
        visit(b, c, d);
      }
    }
}

// Tangent of a canonical triangle's angle to the base plane: one of its sides runs along u and one along v.
function slope_of(patch, spacing, a, b, c) {
  const { columns, elevation } = patch;
  let along_u = 0, along_v = 0;
  for (const [i, j] of [[a, b], [b, c], [c, a]]) {
    const low = Math.min(i, j), high = Math.max(i, j);
    if (high === low + 1 && high % columns !== 0) along_u = elevation[high] - elevation[low];
    if (high === low + columns) along_v = elevation[high] - elevation[low];
  }
  return Math.sqrt(along_u * along_u + along_v * along_v) / spacing;
}

// Cells of the corners, three to a triangle.
function patch_triangles(patch, spacing) {
  const corners = new Uint32Array(6 * patch.mask.length);
  let count = 0;
  visit_grid_triangles(patch, (a, b, c) => {
    if (slope_of(patch, spacing, a, b, c) > STEEPEST_SLOPE) return;
    corners[count++] = a;
    corners[count++] = b;
    corners[count++] = c;
  });
  return corners.slice(0, count);
}

// The mean slope between a cell's supported neighbours on one axis. `step`: between cells of this axis.
function mean_slope(patch, cell, step, has_before, has_after, spacing) {
  const { mask, elevation } = patch;
  const before = has_before && mask[cell - step] ? cell - step : cell;
  const after = has_after && mask[cell + step] ? cell + step : cell;
  return before === after ? 0 : (elevation[after] - elevation[before]) / (((after - before) / step) * spacing);
}

function sample_normal(patch, row, column, spacing) {
  const cell = row * patch.columns + column;
  const slope_u = mean_slope(patch, cell, 1, column > 0, column + 1 < patch.columns, spacing);
  const slope_v = mean_slope(patch, cell, patch.columns, row > 0, row + 1 < patch.rows, spacing);
  const along = sum_of(scaled(slope_u, patch.axis_u), scaled(slope_v, patch.axis_v));
  return normalised(difference_of(patch.normal, along));
}

// A unit vector as two numbers of 16 bits: on an octahedron, its lower half folded outwards.
function packed_normal([x, y, z]) {
  const length = Math.abs(x) + Math.abs(y) + Math.abs(z);
  let u = x / length, v = y / length;
  if (z < 0) [u, v] = [(1 - Math.abs(v)) * sign_of(u), (1 - Math.abs(u)) * sign_of(v)];
  return [Math.round((u * 0.5 + 0.5) * 65535), Math.round((v * 0.5 + 0.5) * 65535)];
}

function elevation_range(patch) {
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < patch.mask.length; ++i) {
    if (!patch.mask[i]) continue;
    low = Math.min(low, patch.elevation[i]);
    high = Math.max(high, patch.elevation[i]);
  }
  return low <= high ? { low, height: high - low } : { low: 0, height: 0 };
}

// Writes three numbers of 16 bits for each cell of the patch's map: elevation within its range, normal.
function write_cells(patch, range, spacing, cells) {
  for (let row = 0; row < patch.rows; ++row)
    for (let column = 0; column < patch.columns; ++column) {
      const cell = row * patch.columns + column;
      if (!patch.mask[cell]) continue;
      const elevation = range.height > 0 ? (patch.elevation[cell] - range.low) / range.height : 0;
      cells[3 * cell] = Math.round(elevation * 65535);
      [cells[3 * cell + 1], cells[3 * cell + 2]] = packed_normal(sample_normal(patch, row, column, spacing));
    }
}

// From (column, row, elevation in its range, 1) to the model, centred, its diagonal being 1. Columns of a 4 x 3 matrix.
function patch_matrix(patch, range, header) {
  const centre = header.least.map((x, axis) => (x + header.most[axis]) / 2);
  const base = sum_of(difference_of(patch.origin, centre), scaled(range.low, patch.normal));
  const columns = [
    scaled(header.spacing, patch.axis_u), scaled(header.spacing, patch.axis_v), scaled(range.height, patch.normal), base,
  ];
  return columns.map((column) => scaled(1 / header.diagonal, column));
}

// What the page needs to draw a decoded stream, but for the gaps between patches.
//
// cells: Uint16Array, 3 to a cell, patch by patch. patches: { first_cell, columns, matrix, indices }, the indices being cells
// of the patch's own map: 16 bits where they fit.
function build_model(stream, progress = () => {}) {
  const { header, patches } = stream;
  const cell_count = patches.reduce((sum, patch) => sum + patch.mask.length, 0);
  const model = { cells: new Uint16Array(3 * cell_count), patches: [], samples: 0, triangles: 0 };
  let first_cell = 0;
  patches.forEach((patch, i) => {
    const count = patch.mask.length, range = elevation_range(patch);
    write_cells(patch, range, header.spacing, model.cells.subarray(3 * first_cell, 3 * (first_cell + count)));
    const triangles = patch_triangles(patch, header.spacing);
    // 0xFFFF restarts a primitive in WebGL 2.
    const indices = count <= 0xffff ? Uint16Array.from(triangles) : triangles;
    model.patches.push({ first_cell, columns: patch.columns, matrix: patch_matrix(patch, range, header), indices });
    model.samples += patch.mask.reduce((sum, bit) => sum + bit, 0);
    model.triangles += triangles.length / 3;
    first_cell += count;
    progress("model", (i + 1) / patches.length);
  });
  return model;
}
