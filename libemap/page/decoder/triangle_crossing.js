// Whether triangles of a mesh cross (libemap/elevation/triangle_crossing.h), in plain doubles: for drawing, where triangles
// that touch within rounding may count as either.

// Six times the volume between four points.
function orientation(a, b, c, d) {
  return dot(cross(difference_of(b, a), difference_of(c, a)), difference_of(d, a));
}

function same_side(x, y, z) {
  return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
}

function segment_meets_triangle(p, q, a, b, c) {
  const side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
  if (side_p * side_q > 0) return false;
  if (side_p === 0 && side_q === 0) return segment_meets_triangle_in_plane(p, q, a, b, c);
  return same_side(orientation(p, q, a, b), orientation(p, q, b, c), orientation(p, q, c, a));
}

// All five in one plane: seen along the axis that is nearest to its normal.
function segment_meets_triangle_in_plane(p, q, a, b, c) {
  const normal = cross(difference_of(b, a), difference_of(c, a)).map(Math.abs);
  const axis = normal.indexOf(Math.max(...normal)), u = (axis + 1) % 3, v = (axis + 2) % 3;
  const turn = (i, j, k) => (j[u] - i[u]) * (k[v] - i[v]) - (j[v] - i[v]) * (k[u] - i[u]);
  const inside = (x) => same_side(turn(a, b, x), turn(b, c, x), turn(c, a, x));
  const meets = (i, j) => turn(p, q, i) * turn(p, q, j) <= 0 && turn(i, j, p) * turn(i, j, q) <= 0;
  return inside(p) || inside(q) || meets(a, b) || meets(b, c) || meets(c, a);
}

// first, second: three vertices each; at(vertex): its position.
function triangles_cross(at, first, second) {
  const shared = first.filter((vertex) => second.includes(vertex));
  if (shared.length === 3) return true;
  const one = first.map(at), other = second.map(at);
  if (shared.length === 2) {
    const [a, b] = shared.map(at);
    const tip = at(first.find((vertex) => !shared.includes(vertex)));
    const other_tip = at(second.find((vertex) => !shared.includes(vertex)));
    if (orientation(a, b, tip, other_tip) !== 0) return false;
    const edge = difference_of(b, a);
    return dot(cross(edge, difference_of(tip, a)), cross(edge, difference_of(other_tip, a))) > 0;
  }
  // With one vertex in common they cross where the side opposite to it of one meets the other.
  const crosses = (sides, vertices, triangle) =>
    [0, 1, 2].some((i) => {
      const j = (i + 1) % 3;
      if (shared.includes(vertices[i]) || shared.includes(vertices[j])) return false;
      return segment_meets_triangle(sides[i], sides[j], ...triangle);
    });
  return crosses(one, first, other) || crosses(other, second, one);
}
