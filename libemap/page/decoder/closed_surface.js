// From maps to what closes the gaps between them, for the viewer: corners are named by patch and cell.

// Sides of a patch's triangles that no other of its triangles has, { from, to, opposite }, in cells. triangles: three cells
// each.
function boundary_of_triangles(triangles, columns, cell_count) {
  const sides = new Uint16Array(cell_count);  // which of its neighbours a cell has a side to, one bit each
  const direction = (from, to) => {
    const rows = Math.floor(to / columns) - Math.floor(from / columns);
    return 3 * (rows + 1) + (to - from - rows * columns) + 1;
  };
  const visit_sides = (visit) => {
    for (let i = 0; i < triangles.length; i += 3)
      for (let k = 0; k < 3; ++k) visit(triangles[i + k], triangles[i + ((k + 1) % 3)], triangles[i + ((k + 2) % 3)]);
  };
  visit_sides((from, to) => (sides[from] |= 1 << direction(from, to)));
  const boundary = [];
  visit_sides((from, to, opposite) => {
    if (!(sides[to] & (1 << direction(to, from)))) boundary.push({ from, to, opposite });
  });
  return boundary;
}

// All patches as one mesh of samples, for GapFiller; and where each vertex comes from.
function surface_of(stream, model) {
  const { patches, header } = stream;
  const surface = {
    positions: new Float64Array(3 * model.samples),
    patch_of_vertex: new Uint32Array(model.samples),
    cell_of_vertex: new Uint32Array(model.samples),
    triangles: new Uint32Array(3 * model.triangles),
    boundary: [],
  };
  let vertex = 0, corner = 0;
  patches.forEach((patch, number) => {
    const { indices } = model.patches[number], vertex_of_cell = new Uint32Array(patch.mask.length);
    for (let cell = 0; cell < patch.mask.length; ++cell) {
      if (!patch.mask[cell]) continue;
      vertex_of_cell[cell] = vertex;
      surface.patch_of_vertex[vertex] = number;
      surface.cell_of_vertex[vertex] = cell;
      surface.positions.set(sample_position(patch, cell, header.spacing), 3 * vertex++);
    }
    for (let i = 0; i < indices.length; ++i) surface.triangles[corner++] = vertex_of_cell[indices[i]];
    for (const { from, to, opposite } of boundary_of_triangles(indices, patch.columns, patch.mask.length))
      surface.boundary.push({
        from: vertex_of_cell[from], to: vertex_of_cell[to], opposite: vertex_of_cell[opposite],
      });
  });
  return surface;
}

function sample_position(patch, cell, spacing) {
  const u = spacing * (cell % patch.columns), v = spacing * Math.floor(cell / patch.columns);
  const in_plane = sum_of(sum_of(patch.origin, scaled(u, patch.axis_u)), scaled(v, patch.axis_v));
  return sum_of(in_plane, scaled(patch.elevation[cell], patch.normal));
}

// Normals of boundary samples from all triangles around them, by area: differences within one map are one-sided there, and
// show as seams. Calls visit(vertex, normal).
function visit_boundary_normals(surface, inserted, visit) {
  const { positions, triangles, boundary } = surface;
  const sums = new Map(boundary.flatMap(({ from, to }) => [[from, [0, 0, 0]], [to, [0, 0, 0]]]));
  const at = (vertex) => [positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]];
  const add = (a, b, c) => {
    const corners = [a, b, c].filter((vertex) => sums.has(vertex));
    if (corners.length === 0) return;
    const normal = cross(difference_of(at(b), at(a)), difference_of(at(c), at(a)));
    for (const vertex of corners) sums.set(vertex, sum_of(sums.get(vertex), normal));
  };
  for (let i = 0; i < triangles.length; i += 3) add(triangles[i], triangles[i + 1], triangles[i + 2]);
  for (const triangle of inserted) add(...triangle);
  for (const [vertex, sum] of sums) if (dot(sum, sum) > 0) visit(vertex, normalised(sum));
}

// { corners: patch and cell of each vertex, indices: three vertices to a triangle, cells: as the model's, with better
// normals at the boundaries of patches }
function build_gaps(stream, model) {
  const surface = surface_of(stream, model);
  const triangles = new GapFiller(surface, stream.header.spacing, stream.header.least).fill();
  const numbers = new Map(), corners = [], indices = [];
  for (const vertex of triangles.flat()) {
    if (!numbers.has(vertex)) {
      numbers.set(vertex, numbers.size);
      corners.push(surface.patch_of_vertex[vertex], surface.cell_of_vertex[vertex]);
    }
    indices.push(numbers.get(vertex));
  }
  const cells = model.cells.slice();
  visit_boundary_normals(surface, triangles, (vertex, normal) => {
    const cell = model.patches[surface.patch_of_vertex[vertex]].first_cell + surface.cell_of_vertex[vertex];
    cells.set(packed_normal(normal), 3 * cell + 1);
  });
  return { corners: Uint32Array.from(corners), indices: Uint32Array.from(indices), cells };
}
