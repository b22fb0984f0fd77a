#pragma once

// The OpenGL functions that the renderer calls, by libepoxy's declarations. libepoxy finds functions of EGL and GLX
// contexts only, and keeps what it found first; so every context hands its own functions to libepoxy's pointers when it
// becomes current, OSMesa's among them.

#include <epoxy/gl.h>

#include <string>

namespace emap {

using GlFunction = void (*)();

// find: a context's lookup by name ("glClear"). Returns the name of the first function that it lacks, or nothing.
std::string use_gl_functions(GlFunction (*find)(const char*));

}  // namespace emap
