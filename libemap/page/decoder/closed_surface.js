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

// Normals of all vertices from the triangles around them, each weighted by the inverse of the squares of its two sides there
// (N. Max, "Weights for computing vertex normals from facet normals", 1999); not normalised, three numbers to a vertex.
// Differences of elevations are one-sided at the rims of maps and show there as seams.
function sums_of_normals(positions, triangles, inserted) {
  const sums = new Float64Array(positions.length), side = new Float64Array(9), squared = new Float64Array(3);
  const add = (a, b, c) => {
    for (let axis = 0; axis < 3; ++axis) {
      const at_a = positions[3 * a + axis], at_b = positions[3 * b + axis], at_c = positions[3 * c + axis];
      side[axis] = at_b - at_a;
      side[3 + axis] = at_c - at_b;
      side[6 + axis] = at_a - at_c;
    }
    for (let i = 0; i < 3; ++i) squared[i] = side[3 * i] ** 2 + side[3 * i + 1] ** 2 + side[3 * i + 2] ** 2;
    for (let axis = 0; axis < 3; ++axis) {
      const u = (axis + 1) % 3, v = (axis + 2) % 3;
      const normal = side[u] * side[3 + v] - side[v] * side[3 + u];
      sums[3 * a + axis] += normal / (squared[0] * squared[2]);
      sums[3 * b + axis] += normal / (squared[0] * squared[1]);
      sums[3 * c + axis] += normal / (squared[1] * squared[2]);
    }
  };
  for (let i = 0; i < triangles.length; i += 3) add(triangles[i], triangles[i + 1], triangles[i + 2]);
  for (const triangle of inserted) add(...triangle);
  return sums;
}

// { corners: patch and cell of each vertex, indices: three vertices to a triangle, cells: as the model's, with the normals of
// the closed surface }
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
  const cells = model.cells.slice(), sums = sums_of_normals(surface.positions, surface.triangles, triangles);
  for (let vertex = 0; vertex < model.samples; ++vertex) {
    const sum = [sums[3 * vertex], sums[3 * vertex + 1], sums[3 * vertex + 2]];
    const cell = model.patches[surface.patch_of_vertex[vertex]].first_cell + surface.cell_of_vertex[vertex];
    if (dot(sum, sum) > 0 && Number.isFinite(dot(sum, sum))) cells.set(packed_normal(normalised(sum)), 3 * cell + 1);
  }
  return { corners: Uint32Array.from(corners), indices: Uint32Array.from(indices), cells };
}
