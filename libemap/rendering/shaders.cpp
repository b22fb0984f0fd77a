#include "libemap/rendering/shaders.h"

#include <fmt/format.h>

namespace emap {
namespace {

// ---- parts of vertex shaders -------------------------------------------------------------------------------------

// Normals from two 16-bit angles. sin(pi/2 x) on [-1, 1] is a polynomial right to 1e-6: shorter than sin() where that
// is computed in software.
constexpr const char* kNormalCode = R"(
float quarter_sine(float x) {
  float s = x * x;
  return x * (1.57079574 + s * (-0.645922978 + s * (0.0794876 + s * -0.00436028)));
}
vec3 normal_of(uvec2 code) {
  float z = -quarter_sine(float(code.x) * (2.0 / 65535.0) - 1.0);
  float around = float(code.y) * (2.0 / 65535.0) - 1.0;
  float across = sqrt(max(0.0, 1.0 - z * z));
  float half_turns = abs(around);
  float y = quarter_sine(1.0 - abs(2.0 * half_turns - 1.0));
  return vec3(across * quarter_sine(1.0 - 2.0 * half_turns), around < 0.0 ? -across * y : across * y, z);
}
)";

// Samples by their place in the grid of 256 x 256 (map_geometry.h).
constexpr const char* kMapCode = R"(
uniform usamplerBuffer elevations;
uniform usamplerBuffer normals;
uniform isamplerBuffer rows;
ivec2 place_of(int index) {
  int row = index >> 8;
  return ivec2((index & 255) ^ ((row & 7) << 5), row);
}
)";

// The same expression wherever a sample becomes a vertex, so that tiles and seams meet to the last bit.
constexpr const char* kPositionCode = R"(
invariant gl_Position;
vec4 position_of(mat4 frame, ivec2 place, float code) {
  return frame[0] * float(place.x) + (frame[1] * float(place.y) + (frame[2] * code + frame[3]));
}
)";

constexpr const char* kMapMeshVertex = R"(
uniform int first_row;
uniform mat4 clip_from_grid;
uniform mat3 eye_from_plane;
out vec3 normal;
void main() {
  ivec2 place = place_of(gl_VertexID);
  int sample_index = texelFetch(rows, first_row + place.y).x + place.x;
  normal = eye_from_plane * normal_of(texelFetch(normals, sample_index).xy);
  gl_Position = position_of(clip_from_grid, place, float(texelFetch(elevations, sample_index).x));
}
)";

// Everything of a tile by its number (drawn_maps.cpp writes it).
constexpr const char* kFramesCode = R"(
uniform samplerBuffer frames;
const int frame_texels = 12;
mat3 eye_from_plane_of(int frame) {
  return mat3(texelFetch(frames, frame + 4).xyz, texelFetch(frames, frame + 5).xyz, texelFetch(frames, frame + 6).xyz);
}
)";

constexpr const char* kSeamVertex = R"(
in uvec2 position;
out vec3 normal;
void main() {
  int frame = frame_texels * int(position.x);
  ivec2 place = place_of(int(position.y));
  int sample_index = texelFetch(rows, int(texelFetch(frames, frame + 4).w) + place.y).x + place.x;
  normal = eye_from_plane_of(frame) * normal_of(texelFetch(normals, sample_index).xy);
  mat4 clip_from_grid = mat4(texelFetch(frames, frame), texelFetch(frames, frame + 1), texelFetch(frames, frame + 2),
                             texelFetch(frames, frame + 3));
  gl_Position = position_of(clip_from_grid, place, float(texelFetch(elevations, sample_index).x));
}
)";

// Against splats, which they need not meet to the last bit, with fewer look-ups; and a little nearer to the eye.
constexpr const char* kForwardSeamVertex = R"(
uniform mat4 clip_from_eye;
uniform vec2 depth_line;
uniform float forward;
in uvec2 position;
out vec3 normal;
void main() {
  int frame = frame_texels * int(position.x);
  ivec2 place = place_of(int(position.y));
  vec4 u = texelFetch(frames, frame + 7), v = texelFetch(frames, frame + 8), up = texelFetch(frames, frame + 9);
  vec4 origin = texelFetch(frames, frame + 10);
  int sample_index = texelFetch(rows, int(u.w) + place.y).x + place.x;
  vec3 over_plane = normal_of(texelFetch(normals, sample_index).xy);
  float inverse_step = inversesqrt(dot(u.xyz, u.xyz));
  normal = u.xyz * (over_plane.x * inverse_step) + v.xyz * (over_plane.y * inverse_step) +
           up.xyz * (over_plane.z * sqrt(origin.w));
  float elevation = float(texelFetch(elevations, sample_index).x);
  vec3 p = u.xyz * float(place.x) + (v.xyz * float(place.y) + (up.xyz * elevation + origin.xyz));
  gl_Position = clip_from_eye * vec4(p, 1.0);
  gl_Position.z -= 2.0 * depth_line.y * forward / gl_Position.w;
}
)";

constexpr const char* kPlainMeshVertex = R"(
uniform mat4 clip_from_grid;
uniform mat3 eye_from_plane;
in uvec3 position;
in uvec2 polar;
out vec3 normal;
void main() {
  normal = eye_from_plane * normal_of(polar);
  vec3 code = vec3(position);
  gl_Position = clip_from_grid[0] * code.x + (clip_from_grid[1] * code.y + (clip_from_grid[2] * code.z + clip_from_grid[3]));
}
)";

// A disc as a square of pixels around its centre; the fragments cut it out. The square holds the disc's bounding
// rectangle: along a direction a of the picture it reaches r |a - <a, n> n|.
constexpr const char* kSplatVertex = R"(
uniform mat4 clip_from_eye;
uniform float pixels;
uniform float radius_factor;
uniform float largest_square;
uniform bool one_sided;
flat out vec4 centre;  // and the squared radius
flat out vec4 facet;   // the normal n, and 1 / <n, centre>
void place_splat(vec3 p, vec3 n, float radius) {
  radius *= radius_factor;
  float facing = dot(n, p);
  centre = vec4(p, radius * radius);
  facet = vec4(n, 1.0 / (abs(facing) < 1e-9 ? 1e-9 : facing));
  float depth = -p.z;
  vec2 slope = p.xy / depth;
  vec2 along = vec2(n.x + slope.x * n.z, n.y + slope.y * n.z);
  vec2 reach = vec2(1.0) + slope * slope - along * along;
  gl_PointSize = min(2.0 * pixels * radius * sqrt(max(reach.x, reach.y)) / max(depth - radius, 0.1 * depth),
                     largest_square);
  gl_Position = clip_from_eye * vec4(p, 1.0);
  if (one_sided && facing > 0.0) gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
}
)";

// Radii by (5.1), with which the discs of a flat map just touch in the middle of its squares: so a little wider, the
// more so where they are seen from the side, and as much more as the list of splats asks for. Sheer samples have the
// discs of less steep ones: a wrong normal among them would else be a disc of many samples' size, upright on the
// surface.
constexpr const char* kMapSplatVertex = R"(
uniform float widening;
uniform int first_row;
uniform mat4 eye_from_grid;
uniform mat3 eye_from_plane;
uniform float spacing;
void main() {
  ivec2 place = place_of(gl_VertexID);
  int sample_index = texelFetch(rows, first_row + place.y).x + place.x;
  vec3 over_plane = normal_of(texelFetch(normals, sample_index).xy);
  vec3 p = (eye_from_grid * vec4(place, float(texelFetch(elevations, sample_index).x), 1.0)).xyz;
  vec3 n = eye_from_plane * over_plane;
  float facing = -dot(n, p) * inversesqrt(dot(p, p));
  float wider = widening * (1.01 + 0.02 / max(facing, 0.08));
  place_splat(p, n, wider * 0.70710678 * spacing / (0.1 + 0.9 * max(over_plane.z, gentlest_cosine)));
}
)";

// A sample's square: what lies half a step and a little more beside it over the base plane, in the surface's tangent
// plane, so that squares overlap whatever the slope; the more so where they are seen from the side, for there what they
// leave the surface by shows between them. As far as the picture is concerned the tangent plane is where the sample is:
// squares are small, and where a ray meets the surface is found out later.
constexpr const char* kSquareVertex = R"(
uniform mat4 clip_from_eye;
uniform float pixels;
uniform vec2 picture_centre;
uniform float largest_square;
uniform bool one_sided;
uniform float widening;
uniform int first_row;
uniform int tile;
uniform mat4 eye_from_grid;
uniform mat3 eye_from_plane;
uniform float spacing;
flat out vec4 sides_of_pixels;  // from pixels beside the centre to half sides, column by column
flat out uvec3 square;          // the centre's pixel as floats' bits, and which sample it is
void main() {
  ivec2 place = place_of(gl_VertexID);
  int sample_index = texelFetch(rows, first_row + place.y).x + place.x;
  vec3 over_plane = normal_of(texelFetch(normals, sample_index).xy);
  vec3 p = (eye_from_grid * vec4(place, float(texelFetch(elevations, sample_index).x), 1.0)).xyz;
  float facing = -dot(eye_from_plane * over_plane, p) * inversesqrt(dot(p, p));
  float half_side = widening * min(0.55 + 0.05 / max(facing, 0.01), 0.8);
  vec2 rise = over_plane.xy * (-spacing / max(over_plane.z, gentlest_cosine));
  vec3 u = eye_from_grid[0].xyz + rise.x * eye_from_plane[2], v = eye_from_grid[1].xyz + rise.y * eye_from_plane[2];
  float scale = -1.0 / p.z;
  vec2 ray = p.xy * scale;
  scale *= pixels * half_side;
  vec2 right = scale * (u.xy + ray * u.z), up = scale * (v.xy + ray * v.z);
  float area = right.x * up.y - right.y * up.x;
  sides_of_pixels = vec4(up.y, -right.y, -up.x, right.x) / (abs(area) < 1e-6 ? 1e-6 : area);
  square = uvec3(floatBitsToUint(ray * pixels + picture_centre), uint(tile) << 16 | uint(gl_VertexID));
  vec2 reach = abs(right) + abs(up);
  gl_PointSize = min(2.0 * max(reach.x, reach.y), largest_square);
  gl_Position = clip_from_eye * vec4(p, 1.0);
  if (one_sided && facing < 0.0) gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
}
)";

constexpr const char* kPlainSplatVertex = R"(
uniform mat4 eye_from_grid;
uniform mat3 eye_from_plane;
in uvec3 position;
in uvec2 polar;
in float radius;
void main() {
  place_splat((eye_from_grid * vec4(position, 1.0)).xyz, eye_from_plane * normal_of(polar), radius);
}
)";

// As far away as anything can be without being the ground.
constexpr const char* kWholePictureVertex = R"(
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.9999, 1.0);
}
)";

// ---- parts of fragment shaders -----------------------------------------------------------------------------------

// Depth in the picture is linear in 1 / (distance along the view).
constexpr const char* kRayDepth = "uniform vec2 depth_line;\n";

constexpr const char* kRayCode = R"(
uniform vec2 ray_scale;
uniform vec2 ray_offset;
vec3 ray() { return vec3(gl_FragCoord.xy * ray_scale + ray_offset, -1.0); }
float depth_at(float inverse_distance) { return depth_line.x - depth_line.y * inverse_distance; }
float distance_at(float depth) { return depth_line.y / (depth_line.x - depth); }
)";

constexpr const char* kShadingCode = R"(
uniform vec2 picture_centre;
uniform mat3 model_from_eye;
uniform vec3 eye_in_model;
uniform samplerCube environment;
uniform sampler2D picture;
out vec4 colour;
vec3 lit(vec3 n, vec3 d, vec3 ground) { return ground * (0.15 + 0.85 * abs(dot(n, normalize(d)))); }
vec3 mirrored(vec3 n, vec3 d) { return textureLod(environment, model_from_eye * reflect(d, n), 0.0).rgb; }
vec3 textured(vec3 d, float distance) {
  vec3 p = model_from_eye * (d * distance) + eye_in_model;
  return texture(picture, vec2(p.x, -p.y) + 0.5).rgb;
}
)";

// n: of unit length. distance: along the view.
std::string shade_function(Shading shading) {
  const std::string body = [shading]() -> std::string {
    switch (shading) {
      case Shading::lighting:
        return "colour = vec4(lit(n, d, vec3(0.8)), 1.0);";
      case Shading::reflection:
        return "colour = vec4(mirrored(n, d), 1.0);";
      case Shading::combined:
        return "colour = vec4(0.5 * (lit(n, d, vec3(0.8)) + mirrored(n, d)), 1.0);";
      case Shading::split:
        return R"(vec3 light = lit(n, d, vec3(0.8));
  bool left = gl_FragCoord.x < picture_centre.x, low = gl_FragCoord.y < picture_centre.y;
  if (left) light = low ? lit(n, d, patch_colour) : light;
  else light = low ? 0.5 * (light + mirrored(n, d)) : mirrored(n, d);
  colour = vec4(light, 1.0);)";
      case Shading::patches:
        return "colour = vec4(lit(n, d, patch_colour), 1.0);";
      case Shading::texture:
        return "colour = vec4(lit(n, d, textured(d, distance)), 1.0);";
      case Shading::normals:
        return "colour = vec4(0.5 + 0.5 * (model_from_eye * n), 1.0);";
    }
    return "";
  }();
  return "void shade(vec3 n, vec3 d, float distance) {\n  " + body + "\n}\n";
}

constexpr const char* kMeshFragment = R"(
in vec3 normal;
void main() {
  vec3 d = ray();
  shade(normalize(normal), d, distance_at(gl_FragCoord.z));
}
)";

// Cuts the disc out of its square; leaves where the ray meets it.
constexpr const char* kDiscCode = R"(
flat in vec4 centre;
flat in vec4 facet;
struct DiscHit { vec3 d; float inverse_distance; vec3 from_centre; float squared; };
DiscHit hit_disc() {
  DiscHit hit;
  hit.d = ray();
  hit.inverse_distance = dot(facet.xyz, hit.d) * facet.w;
  hit.from_centre = hit.d / hit.inverse_distance - centre.xyz;
  hit.squared = dot(hit.from_centre, hit.from_centre);
  if (!(hit.inverse_distance > 0.0 && hit.squared <= centre.w)) discard;
  return hit;
}
)";

// At half their radius where single splats are to be seen.
std::string reduction_of(Shading shading) {
  return shading == Shading::patches ? "if (hit.squared > 0.25 * centre.w) discard;" : "";
}

std::string splat_fragment(Shading shading) {
  return fmt::format(R"(
void main() {{
  DiscHit hit = hit_disc();
  {}
  gl_FragDepth = depth_at(hit.inverse_distance);
  shade(facet.xyz, hit.d, 1.0 / hit.inverse_distance);
}}
)",
                     reduction_of(shading));
}

// A little farther along the view: what lies between is one surface and blends.
constexpr const char* kVisibilityFragment = R"(
uniform float behind;
void main() {
  DiscHit hit = hit_disc();
  gl_FragDepth = depth_at(1.0 / (1.0 / hit.inverse_distance + behind));
}
)";

constexpr const char* kAccumulationFragment = R"(
out vec4 colour;
void main() {
  DiscHit hit = hit_disc();
  gl_FragDepth = depth_at(hit.inverse_distance);
  colour = vec4(facet.xyz, 1.0) * exp(-2.0 * hit.squared / centre.w);
}
)";

constexpr const char* kNormalisationFragment = R"(
uniform sampler2D sums;
uniform sampler2D depths;
void main() {
  vec4 sum = texelFetch(sums, ivec2(gl_FragCoord.xy), 0);
  if (sum.w <= 0.0) discard;
  shade(normalize(sum.xyz), ray(), distance_at(texelFetch(depths, ivec2(gl_FragCoord.xy), 0).x));
}
)";

// The triangle of three samples that is `inside` over the plane, its plane, and the samples' weights at `place`.
// Diagonals and the steepest slope are those of the canonical mesh.
constexpr const char* kCellCode = R"(
int first_row, row_count;  // of the tile
float steepest;            // squared, in elevation codes to a sample's step
struct Cell { bool found; vec3 plane; vec3 weights; ivec3 samples; };
Cell cell_of(vec2 inside, vec2 place) {
  Cell cell;
  vec2 low = floor(inside);
  vec2 f = inside - low;
  int row = clamp(int(low.y), 0, row_count - 2), column = int(low.x);
  ivec2 near = texelFetch(rows, first_row + row).xy, far = texelFetch(rows, first_row + row + 1).xy;
  ivec2 first = ivec2(near.y, far.y) & 65535, last = ivec2(near.y, far.y) >> 16;
  int a_index = near.x + clamp(column, first.x, last.x), b_index = near.x + clamp(column + 1, first.x, last.x);
  int d_index = far.x + clamp(column, first.y, last.y), c_index = far.x + clamp(column + 1, first.y, last.y);
  vec4 h = vec4(texelFetch(elevations, a_index).x, texelFetch(elevations, b_index).x, texelFetch(elevations, c_index).x,
                texelFetch(elevations, d_index).x);
  bvec4 there = bvec4(column >= first.x && column <= last.x && h.x < 65535.0,
                      column + 1 >= first.x && column + 1 <= last.x && h.y < 65535.0,
                      column + 1 >= first.y && column + 1 <= last.y && h.z < 65535.0,
                      column >= first.y && column <= last.y && h.w < 65535.0);
  bool falling = there.x && there.z ? (there.y && there.w ? abs(h.x - h.z) > abs(h.y - h.w) : false) : true;
  bool with_a_b = falling ? f.x + f.y <= 1.0 : f.x > f.y;
  // falling: (a, b, d) or (c, d, b); else (a, b, c) or (a, c, d)
  bool upper = falling && !with_a_b;
  float gradient_u = with_a_b ? h.y - h.x : h.z - h.w;
  float gradient_v = with_a_b == falling ? h.w - h.x : h.z - h.y;
  float corner = upper ? h.y + h.w - h.z : h.x;
  cell.plane = vec3(gradient_u, gradient_v, corner - gradient_u * low.x - gradient_v * low.y);
  f = place - low;
  cell.samples = falling ? ivec3(upper ? c_index : a_index, b_index, d_index)
                         : ivec3(a_index, with_a_b ? b_index : c_index, with_a_b ? c_index : d_index);
  cell.weights = falling ? (upper ? vec3(f.x + f.y - 1.0, 1.0 - f.y, 1.0 - f.x) : vec3(1.0 - f.x - f.y, f.x, f.y))
                         : (with_a_b ? vec3(1.0 - f.x, f.x - f.y, f.y) : vec3(1.0 - f.y, f.x, f.y - f.x));
  bool whole = falling ? there.y && there.w && (upper ? there.z : there.x)
                       : there.x && there.z && (with_a_b ? there.y : there.w);
  cell.found = whole && low.y >= 0.0 && int(low.y) < row_count - 1 &&
               gradient_u * gradient_u + gradient_v * gradient_v <= steepest;
  return cell;
}
// The triangle that lies `slack` steps from the place towards where there is support, continued to the place: what lies
// beside the map's edge by no more than that still gets the triangle at the edge, and inside nothing changes, for
// triangles agree where they meet.
Cell cell_at(vec2 place, vec2 towards, float slack) {
  vec2 way = towards - place;
  return cell_of(place + way * min(0.9, slack / max(1e-6, length(way))), place);
}
)";

// From where the ray meets a disc to where it meets the triangle of the three samples there, and their normals' mean.
constexpr const char* kInterpolationCode = R"(
struct Interpolated { bool found; bool passes; float along; vec3 over_plane; };
// start: where the ray meets the disc, middle: the disc's centre, eye: the ray's origin, all over the grid. along: of the
// way from the eye to the disc. facing: negative where the disc is seen from outside. passes: the ray sees no triangle of
// the surface near the disc from this side.
Interpolated interpolate(vec3 start, vec2 middle, vec3 eye, float facing, int rounds) {
  Interpolated result = Interpolated(false, false, 1.0, vec3(0.0));
  vec3 way = start - eye;
  vec3 place = start;
  // Discs and triangles are apart by parallax, which the first look must bear; later ones only what rounding takes.
  Cell cell = cell_at(place.xy, middle, rounds > 0 ? 0.4 : 0.01);
  for (int i = 0; i < rounds; ++i) {
    if (!cell.found) break;
    float approach = way.z - dot(cell.plane.xy, way.xy);
    float stride = (dot(cell.plane, vec3(place.xy, 1.0)) - place.z) / approach;
    place += stride * way;
    result.along += stride;
    vec2 moved = abs(place.xy - start.xy);
    if (approach * facing <= 0.0 || max(moved.x, moved.y) > 3.0) {
      result.passes = true;
      break;
    }
    cell = cell_at(place.xy, middle, 0.01);
  }
  result.found = cell.found && !result.passes;
  result.over_plane = cell.weights.x * normal_of(texelFetch(normals, cell.samples.x).xy) +
                      cell.weights.y * normal_of(texelFetch(normals, cell.samples.y).xy) +
                      cell.weights.z * normal_of(texelFetch(normals, cell.samples.z).xy);
  return result;
}
)";

// In one pass (5.2.3). Where neighbours are missing, triangles close the gap; or, where patches overlap instead, the
// splat keeps its own normal, and gives way to those that know better.
std::string interpolated_fragment(Shading shading, int rounds) {
  return fmt::format(R"(
uniform mat4 grid_from_eye;
uniform vec3 eye_in_grid;
uniform mat3 eye_from_plane;
uniform float behind;
uniform bool keeps_own_normal;
uniform int tile_first_row;
uniform int tile_row_count;
uniform float tile_steepest;
void main() {{
  DiscHit hit = hit_disc();
  {}
  first_row = tile_first_row;
  row_count = tile_row_count;
  steepest = tile_steepest;
  vec3 start = (grid_from_eye * vec4(hit.d / hit.inverse_distance, 1.0)).xyz;
  vec2 middle = (grid_from_eye * vec4(centre.xyz, 1.0)).xy;
  Interpolated at = interpolate(start, middle, eye_in_grid, facet.w, {});
  if (at.passes || !(at.found || keeps_own_normal)) discard;
  float distance = at.found ? at.along / hit.inverse_distance : 1.0 / hit.inverse_distance;
  gl_FragDepth = depth_at(1.0 / (at.found ? distance : distance + behind));
  shade(normalize(at.found ? eye_from_plane * at.over_plane : facet.xyz), hit.d, distance);
}}
)",
                     reduction_of(shading), rounds);
}

// Which sample's square is nearest, by tile and place. At the sample's own depth: software renderers pay dearly for
// depths of pixels, and only what squares overlap by differs.
constexpr const char* kIdentityFragment = R"(
flat in vec4 sides_of_pixels;
flat in uvec3 square;
out uint nearest;
void main() {
  vec2 aside = gl_FragCoord.xy - uintBitsToFloat(square.xy);
  vec2 sides = abs(sides_of_pixels.xy * aside.x + sides_of_pixels.zw * aside.y);
  if (max(sides.x, sides.y) > 1.0) discard;
  nearest = square.z;
}
)";

// The interpolation of 5.2.3 once for each pixel, from the disc that is nearest there. Where neighbours are missing the
// disc's own normal stays: triangles that close the gap are drawn over it. Neither discards nor moves depths, so that
// pixels that show nothing can be sorted out before.
std::string resolve_fragment(Shading shading, int rounds) {
  return fmt::format(R"(
uniform usampler2D identities;
void main() {{
  uint identity = texelFetch(identities, ivec2(gl_FragCoord.xy), 0).x;
  int frame = frame_texels * int(identity >> 16);
  ivec2 place = place_of(int(identity & 65535u));
  // Axes of the grid, a step and an elevation code long, and at right angles: their transpose over squares is the inverse.
  vec4 u = texelFetch(frames, frame + 7), v = texelFetch(frames, frame + 8), up = texelFetch(frames, frame + 9);
  vec4 origin = texelFetch(frames, frame + 10);
  first_row = int(u.w);
  row_count = int(v.w);
  steepest = up.w;
  float inverse_step = inversesqrt(dot(u.xyz, u.xyz));
  vec3 inverse_squares = vec3(inverse_step * inverse_step, inverse_step * inverse_step, origin.w);
  mat3 eye_from_plane = mat3(u.xyz * inverse_step, v.xyz * inverse_step, up.xyz * sqrt(origin.w));
  int sample_index = texelFetch(rows, first_row + place.y).x + place.x;
  vec3 middle = vec3(place, float(texelFetch(elevations, sample_index).x));
  vec3 p = u.xyz * middle.x + v.xyz * middle.y + up.xyz * middle.z + origin.xyz;
  vec3 n = eye_from_plane * normal_of(texelFetch(normals, sample_index).xy);
  vec3 d = ray();
  float facing = dot(n, p);
  float distance = facing / dot(n, d);
  mat3 axes = mat3(u.xyz, v.xyz, up.xyz);
  vec3 start = ((d * distance - origin.xyz) * axes) * inverse_squares;
  vec3 eye = (-origin.xyz * axes) * inverse_squares;
  Interpolated at = interpolate(start, middle.xy, eye, facing, {});
  if (at.found) {{
    n = eye_from_plane * at.over_plane;
    distance *= at.along;
  }}
  {}
  shade(normalize(n), d, distance);
}}
)",
                     rounds, shading == Shading::split ? "patch_colour = texelFetch(frames, frame + 11).xyz;" : "");
}

std::string vertex_of(Stage stage) {
  const std::string map = std::string(kNormalCode) + kMapCode;
  const std::string gentlest = fmt::format("const float gentlest_cosine = {};\n", kGentlestCosine);
  switch (stage) {
    case Stage::map_mesh:
      return map + kPositionCode + kMapMeshVertex;
    case Stage::seam_mesh:
    case Stage::seam_between_splats:
      return map + kPositionCode + kFramesCode + kSeamVertex;
    case Stage::seam_over_discs:
      return map + kFramesCode + kForwardSeamVertex;
    case Stage::plain_mesh:
      return std::string(kNormalCode) + kPlainMeshVertex;
    case Stage::map_splats:
    case Stage::map_interpolated:
    case Stage::map_visibility:
    case Stage::map_accumulation:
      return map + gentlest + kSplatVertex + kMapSplatVertex;
    case Stage::plain_splats:
    case Stage::plain_visibility:
    case Stage::plain_accumulation:
      return std::string(kNormalCode) + kSplatVertex + kPlainSplatVertex;
    case Stage::map_identity:
      return map + gentlest + kSquareVertex;
    case Stage::normalisation:
    case Stage::map_resolve:
      return kWholePictureVertex;
  }
  return "";
}

std::string fragment_of(Stage stage, Shading shading, int rounds) {
  const std::string colour = stage == Stage::map_resolve ? "vec3 patch_colour;\n" : "uniform vec3 patch_colour;\n";
  const std::string shade = std::string(kRayDepth) + kRayCode + colour + kShadingCode + shade_function(shading);
  switch (stage) {
    case Stage::map_mesh:
    case Stage::seam_mesh:
    case Stage::plain_mesh:
    case Stage::seam_over_discs:
    case Stage::seam_between_splats:
      return shade + kMeshFragment;
    case Stage::map_splats:
    case Stage::plain_splats:
      return shade + kDiscCode + splat_fragment(shading);
    case Stage::map_interpolated:
      return shade + kNormalCode + kMapCode + kDiscCode + kCellCode + kInterpolationCode +
             interpolated_fragment(shading, rounds);
    case Stage::map_identity:
      return kIdentityFragment;
    case Stage::map_resolve:
      return shade + kNormalCode + kMapCode + kFramesCode + kCellCode + kInterpolationCode +
             resolve_fragment(shading, rounds);
    case Stage::map_visibility:
    case Stage::plain_visibility:
      return std::string(kRayDepth) + kRayCode + kDiscCode + kVisibilityFragment;
    case Stage::map_accumulation:
    case Stage::plain_accumulation:
      return std::string(kRayDepth) + kRayCode + kDiscCode + kAccumulationFragment;
    case Stage::normalisation:
      return shade + kNormalisationFragment;
  }
  return "";
}

}  // namespace

ShaderSources shader_sources(Stage stage, Shading shading, int rounds) {
  const std::string version = "#version 330 core\n";
  return {version + vertex_of(stage), version + fragment_of(stage, shading, rounds)};
}

}  // namespace emap
