#pragma once

// The shaders: what is drawn times how it is shaded, put together from parts in GLSL 3.30.

#include <string>

namespace emap {

enum class Shading {
  lighting,    // a white light at the eye on light grey, per pixel
  reflection,  // a cube map of coloured faces with grid lines
  combined,    // the mean of the two
  split,       // upper left lighting, upper right reflection, lower right combined, lower left patches (figure 5.1)
  patches,     // a colour for each patch; splats at half their radius, so that each can be seen
  texture,     // a picture on the model's x and y, lit
  normals,     // (normal + 1) / 2 in the model's axes, alpha 1; nothing but zeros where nothing is
};

// Parts that vary.
enum class Stage {
  map_mesh,             // tiles of elevation maps as strips
  seam_mesh,            // triangles between patches
  seam_between_splats,  // the same where patches are drawn as splats
  seam_over_discs,      // the same, drawn against discs, a little nearer to the eye than it is
  plain_mesh,           // positions and normals from vertex buffers
  map_splats,           // discs, one normal each
  plain_splats,         // the same from vertex buffers
  map_identity,         // which sample is nearest, by tile and place
  map_resolve,          // from that the interpolation of 5.2.3, once for each pixel; over the whole picture
  map_interpolated,     // the same in one pass: every disc's fragments look up their neighbours
  map_visibility,       // depth alone, a little behind the discs
  plain_visibility,
  map_accumulation,  // normals weighted by a Gaussian, to be added up
  plain_accumulation,
  normalisation,  // the sums to normals, shaded; over the whole picture
};

// Splats of maps are no steeper over their base plane than this, whatever their normal says: neither the discs, for
// their radius (5.1), nor the squares of Stage::map_identity.
constexpr double kGentlestCosine = 0.2;

struct ShaderSources {
  std::string vertex, fragment;
};

// rounds: how often a fragment's place is corrected, of map_resolve and
// map_interpolated; 0 is direct interpolation.
ShaderSources shader_sources(Stage stage, Shading shading, int rounds = 0);

}  // namespace emap
