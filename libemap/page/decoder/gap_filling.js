// Gaps between the patches, closed by triangles between samples that are there: the smallest and flattest first, unless
// one crosses a triangle that exists or an edge would get a third one (libemap/elevation/gap_filling.h, which see for the
// numbers).

const REACH = 2.5, REACH_WITHIN_PATCH = 1.6;  // longest inserted sides, in sample spacings
const LONGEST_SIDE = 4;  // in spacings, of an edge by which the reach grows
const SMALL_HOLE_EDGES = 12, SMALL_HOLE_REACH = 4;
const CANDIDATES_PER_EDGE = 12;
const SHARPEST_FOLD = -0.7;  // cosine between the normals of neighbouring triangles
const LEAST_HEIGHT = 1e-3;   // of a triangle, in lengths of its longest side

function is_before(a, b) {
  return a.score - b.score || a.from - b.from || a.to - b.to || a.tip - b.tip;
}

// A binary heap: the least first.
class CandidateQueue {
  constructor() {
    this.heap = [];
  }

  push(candidate) {
    const { heap } = this;
    let i = heap.push(candidate) - 1;
    for (let parent; i > 0 && is_before(candidate, heap[(parent = (i - 1) >> 1)]) < 0; i = parent) heap[i] = heap[parent];
    heap[i] = candidate;
  }

  // undefined where there is none
  pop() {
    const { heap } = this, least = heap[0], last = heap.pop();
    if (heap.length === 0) return least;
    let i = 0;
    for (let child; (child = 2 * i + 1) < heap.length; i = child) {
      if (child + 1 < heap.length && is_before(heap[child + 1], heap[child]) < 0) ++child;
      if (is_before(last, heap[child]) <= 0) break;
      heap[i] = heap[child];
    }
    heap[i] = last;
    return least;
  }
}

// surface: { positions: 3 numbers to a vertex, patch_of_vertex, triangles: 3 vertices each, boundary: { from, to, opposite }
// for each side that has one triangle }.
class GapFiller {
  constructor(surface, spacing, least) {
    Object.assign(this, surface);
    this.spacing = spacing;
    this.vertex_count = this.patch_of_vertex.length;
    this.at = (vertex) => [
      this.positions[3 * vertex], this.positions[3 * vertex + 1], this.positions[3 * vertex + 2],
    ];
    this.boundary_degree = new Uint16Array(this.vertex_count);
    [this.vertices, this.surroundings, this.filed] = [0, 1, 2].map(() => new CubeHash(2 * spacing, least));
    this.used = new Set();  // directed sides between boundary vertices that have a triangle
    this.candidates = new CandidateQueue();
    this.inserted = [];
    this.within_small_holes = false;
  }

  // The triangles that fill the gaps, three vertices each.
  fill() {
    this.file_boundary();
    this.file_surroundings();
    for (const edge of this.boundary) this.propose(edge, this.reach_of(edge));
    this.insert_best_first();
    this.within_small_holes = true;
    for (const edge of this.edges_of_small_holes()) this.propose(edge, this.reach_of(edge));
    this.insert_best_first();
    return this.inserted;
  }

  side(from, to) {
    return from * this.vertex_count + to;
  }

  is_used(from, to) {
    return this.used.has(this.side(from, to));
  }

  is_boundary(from, to) {
    return this.is_used(from, to) && !this.is_used(to, from);
  }

  triangle(number) {
    const known = this.triangles.length / 3;
    if (number >= known) return this.inserted[number - known];
    return [this.triangles[3 * number], this.triangles[3 * number + 1], this.triangles[3 * number + 2]];
  }

  box_of_triangle([a, b, c]) {
    return box_of(0, this.at(a), this.at(b), this.at(c));
  }

  file_boundary() {
    for (const { from, to } of this.boundary)
      for (const vertex of [from, to])
        if (this.boundary_degree[vertex]++ === 0) this.vertices.add(vertex, box_of(0, this.at(vertex), this.at(vertex)));
  }

  // Triangles near enough to the boundary to be crossed, and the sides of those at boundary vertices.
  file_surroundings() {
    for (const edge of this.boundary) {
      const reach = Math.max(SMALL_HOLE_REACH * this.spacing, this.reach_of(edge));
      this.surroundings.mark(box_of(reach, this.at(edge.from), this.at(edge.to)));
    }
    for (let i = 0; i < this.triangles.length / 3; ++i) {
      const triangle = this.triangle(i);
      this.filed.add_where(this.surroundings, i, this.box_of_triangle(triangle));
      for (let corner = 0; corner < 3; ++corner) {
        const from = triangle[corner], to = triangle[(corner + 1) % 3];
        if (this.boundary_degree[from] > 0 && this.boundary_degree[to] > 0) this.used.add(this.side(from, to));
      }
    }
  }

  // On steep slopes samples, and gaps, are wider than the spacing.
  reach_of({ from, to }) {
    const length = Math.sqrt(distance_squared(this.at(from), this.at(to)));
    const grown = Math.max(this.spacing, Math.min(length, LONGEST_SIDE * this.spacing) / 2);
    return (this.within_small_holes ? SMALL_HOLE_REACH : REACH) * grown;
  }

  // The best tips for triangles on the free side of the edge into the queue.
  propose({ from, to, opposite }, reach) {
    const a = this.at(from), b = this.at(to);
    const normal = normalised(cross(difference_of(b, a), difference_of(this.at(opposite), a)));
    const middle = scaled(0.5, sum_of(a, b)), found = [];
    this.vertices.some(box_of(reach, middle, middle), (tip) => {
      if (tip === from || tip === to || this.boundary_degree[tip] === 0) return false;
      const score = this.score_of(from, to, tip, normal, reach);
      if (score < Infinity) found.push({ score, from, to, tip, reach });
      return false;
    });
    found.sort(is_before);
    for (const candidate of found.slice(0, CANDIDATES_PER_EDGE)) this.candidates.push(candidate);
  }

  // Small where the triangle is small and goes on flat; infinite where it is out of reach, folds back or is a line.
  score_of(from, to, tip, normal, reach) {
    const a = this.at(from), b = this.at(to), c = this.at(tip);
    const from_squared = distance_squared(c, a), to_squared = distance_squared(c, b);
    if (!this.may_join(from, tip, from_squared, reach) || !this.may_join(tip, to, to_squared, reach)) return Infinity;
    const scaled_normal = cross(difference_of(a, b), difference_of(c, b));
    const length = Math.sqrt(dot(scaled_normal, scaled_normal));
    if (!(length > LEAST_HEIGHT * Math.max(from_squared, to_squared, distance_squared(a, b)))) return Infinity;
    const cosine = dot(normal, scaled_normal) / length;
    return cosine < SHARPEST_FOLD ? Infinity : (from_squared + to_squared) * (2 - cosine);
  }

  may_join(from, to, length_squared, reach) {
    const is_within = !this.within_small_holes && this.patch_of_vertex[from] === this.patch_of_vertex[to];
    const longest = is_within ? (reach * REACH_WITHIN_PATCH) / REACH : reach;
    return length_squared <= longest * longest || this.is_used(to, from);
  }

  // The open edges on loops that are short enough.
  edges_of_small_holes() {
    const leaving = new Map(), open = this.open_edges();
    for (const edge of open) if (!leaving.has(edge.from)) leaving.set(edge.from, edge.to);
    return open.filter(({ from, to }) => {
      let edges = 1;
      for (; to !== from && to !== undefined && edges <= SMALL_HOLE_EDGES; ++edges) to = leaving.get(to);
      return to === from && edges <= SMALL_HOLE_EDGES;
    });
  }

  // In the order of the other decoder: where loops meet at a vertex, the first edge is followed.
  open_edges() {
    const of_inserted = this.inserted.flatMap(([a, b, c]) => [
      { from: a, to: b, opposite: c }, { from: b, to: c, opposite: a }, { from: c, to: a, opposite: b },
    ]);
    const least = (edge) => Math.min(edge.from, edge.to), largest = (edge) => Math.max(edge.from, edge.to);
    return [...this.boundary, ...of_inserted]
      .filter(({ from, to }) => this.is_boundary(from, to))
      .sort((a, b) => least(a) - least(b) || largest(a) - largest(b));
  }

  insert_best_first() {
    for (let candidate; (candidate = this.candidates.pop()); )
      if (this.is_open(candidate) && this.fits(candidate)) this.insert(candidate);
  }

  is_open({ from, to, tip }) {
    return this.is_boundary(from, to) && this.boundary_degree[tip] > 0 && !this.is_used(from, tip) &&
      !this.is_used(tip, to);
  }

  fits({ from, to, tip }) {
    const triangle = [to, from, tip], box = this.box_of_triangle(triangle);
    if (!this.surroundings.covers(box)) return false;
    return !this.filed.some(box, (number) => {
      const other = this.triangle(number);
      return boxes_meet(box, this.box_of_triangle(other)) && triangles_cross(this.at, triangle, other);
    });
  }

  insert({ from, to, tip, reach }) {
    const triangle = [to, from, tip];
    this.filed.add(this.triangles.length / 3 + this.inserted.length, this.box_of_triangle(triangle));
    this.inserted.push(triangle);
    this.take_side(to, from);
    this.take_side(from, tip);
    this.take_side(tip, to);
    if (this.is_boundary(from, tip)) this.propose({ from, to: tip, opposite: to }, reach);
    if (this.is_boundary(tip, to)) this.propose({ from: tip, to, opposite: from }, reach);
  }

  // The side gets its triangle: it closes an open edge, or opens one.
  take_side(from, to) {
    this.used.add(this.side(from, to));
    const change = this.is_used(to, from) ? -1 : 1;
    this.boundary_degree[from] += change;
    this.boundary_degree[to] += change;
  }
}

function distance_squared(a, b) {
  const difference = difference_of(a, b);
  return dot(difference, difference);
}

// What holds the points a to b, or c, and a margin around them.
function box_of(margin, a, b, c = b) {
  const low = [0, 0, 0], high = [0, 0, 0];
  for (let axis = 0; axis < 3; ++axis) {
    low[axis] = Math.min(a[axis], b[axis], c[axis]) - margin;
    high[axis] = Math.max(a[axis], b[axis], c[axis]) + margin;
  }
  return { low, high };
}

function boxes_meet(a, b) {
  for (let axis = 0; axis < 3; ++axis) if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return false;
  return true;
}
