#pragma once

// Meshes as they come out of other programs, made ready to be cut into patches.

#include "libemap/surface/surface.h"

namespace emap {

// The same surface with one vertex at each place: vertices at exactly the same coordinates become one (files without
// shared vertices, seams of textures), triangles that are then no longer triangles go, and so do vertices that none
// uses. What is left keeps its order. O(n log n).
Mesh weld_vertices(const Mesh& mesh);

// Turns triangles round so that neighbours have the same side outside: in each part that hangs together by edges of two
// triangles, as most of its area had it. Where no choice suits all (a Möbius strip), some edges stay as they are. O(n
// log n).
void orient_consistently(Mesh& mesh);

}  // namespace emap
