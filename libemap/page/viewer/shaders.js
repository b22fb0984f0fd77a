// One pair of shaders for all shadings.

const SHADINGS = ["lighting", "reflection", "patches"];

// The base grid is the vertex's number: cell = row * columns + column of its patch's map. What fills gaps between patches
// names patch and cell of each corner instead; `corner` is (patch, NO_CELL) where the vertex's number counts.
const NO_CELL = 0xffffffff;

const VERTEX_SHADER = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;

uniform usampler2D cells;   // elevation and normal, 16 bits each
uniform sampler2D planes;   // four texels to a patch: the matrix's columns; in their w: columns, row and column in cells
uniform mat4 camera;
layout(location = 0) in uvec2 corner;
out vec3 position;
out vec3 normal;
flat out uint patch_number;

vec3 unpacked(vec2 packed_normal) {
  vec2 xy = packed_normal * (2.0 / 65535.0) - 1.0;
  float z = 1.0 - abs(xy.x) - abs(xy.y);
  if (z < 0.0) xy = (1.0 - abs(xy.yx)) * vec2(xy.x < 0.0 ? -1.0 : 1.0, xy.y < 0.0 ? -1.0 : 1.0);
  return normalize(vec3(xy, z));
}

void main() {
  int width = textureSize(planes, 0).x;
  vec4 columns[4];
  for (int i = 0; i < 4; ++i) {
    int texel = int(corner.x) * 4 + i;
    columns[i] = texelFetch(planes, ivec2(texel % width, texel / width), 0);
  }
  int cell = corner.y == ${NO_CELL}u ? gl_VertexID : int(corner.y);
  int map_columns = int(columns[0].w);
  int place = int(columns[2].w) + cell;
  int cells_width = textureSize(cells, 0).x;
  uvec3 sample_here = texelFetch(cells, ivec2(place % cells_width, int(columns[1].w) + place / cells_width), 0).xyz;

  position = columns[0].xyz * float(cell % map_columns) + columns[1].xyz * float(cell / map_columns) +
             columns[2].xyz * (float(sample_here.x) / 65535.0) + columns[3].xyz;
  normal = unpacked(vec2(sample_here.yz));
  patch_number = corner.x;
  gl_Position = camera * vec4(position, 1.0);
}
`;

// A white light at the camera: 0.15 from everywhere and 0.85 by the angle, on grey 0.8; both sides alike.
const FRAGMENT_SHADER = `#version 300 es
precision highp float;
precision highp int;

uniform vec3 eye;
uniform int shading;
in vec3 position;
in vec3 normal;
flat in uint patch_number;
out vec4 colour;

// A room with a light ceiling, a dark floor and a long window on each side.
vec3 room(vec3 direction) {
  float height = direction.y;
  vec3 wall = mix(vec3(0.20, 0.19, 0.18), vec3(0.72, 0.74, 0.78), smoothstep(-0.9, 0.9, height));
  float window = smoothstep(0.05, 0.20, height) * smoothstep(0.75, 0.60, height) *
                 smoothstep(0.35, 0.60, abs(direction.x));
  float lamp = smoothstep(0.90, 0.97, height);
  return mix(wall, vec3(1.0), max(window, lamp));
}

// Neighbouring numbers get hues that lie far apart.
vec3 patch_colour(uint number) {
  float hue = fract(float(number) * 0.61803398875) * 6.0;
  vec3 pure = clamp(abs(mod(hue + vec3(0.0, 4.0, 2.0), 6.0) - 3.0) - 1.0, 0.0, 1.0);
  return mix(vec3(0.95), pure, 0.45);
}

void main() {
  vec3 view = normalize(eye - position);
  vec3 n = normalize(normal);
  if (dot(n, view) < 0.0) n = -n;
  float light = 0.15 + 0.85 * dot(n, view);
  vec3 seen = vec3(0.8) * light;
  if (shading == ${SHADINGS.indexOf("reflection")}) seen = room(reflect(-view, n));
  if (shading == ${SHADINGS.indexOf("patches")}) seen = patch_colour(patch_number) * light;
  colour = vec4(seen, 1.0);
}
`;
