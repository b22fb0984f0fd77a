#pragma once

// An OpenGL 3.3 core context that draws into memory, without a display: by EGL on any GPU (or on Mesa's software
// renderer where there is none), or by OSMesa, which needs neither GPU nor driver files. Their libraries are opened at
// run time, so that a machine that lacks one can use the other.

#include <memory>
#include <optional>
#include <string>

#include "libthin/foundation/result.h"

namespace emap {

enum class Backend { automatic, egl, osmesa };

std::optional<Backend> find_backend(const std::string& name);  // "auto", "egl", "osmesa"

class GlContext {
 public:
  virtual ~GlContext() = default;

  // One context is current at a time in a process; objects are made, used and destroyed while theirs is.
  virtual thin::Result<void> make_current() = 0;

  virtual std::string backend() const = 0;  // "egl (surfaceless)", "egl (device)", "osmesa"
  std::string renderer() const;             // what OpenGL calls itself. REQUIRES: current
};

// Files of the two libraries, to be tried in this order.
struct ContextLibraries {
  std::string egl = "libEGL.so.1";
  std::string osmesa = "libOSMesa.so.8:libOSMesa.so.6";
};

// A context, current. `automatic` takes EGL where it works and OSMesa otherwise.
// Errors (configuration): what is missing, and which Debian package brings it.
thin::Result<std::unique_ptr<GlContext>> create_context(Backend backend, const ContextLibraries& libraries = {});

// The two behind it.
thin::Result<std::unique_ptr<GlContext>> create_egl_context(const std::string& library);
thin::Result<std::unique_ptr<GlContext>> create_osmesa_context(const std::string& libraries);

// Lets go of the current context, if any, so that another library's can become current. For contexts' own use.
void release_current_context();
void set_current_context(void (*release)());

}  // namespace emap
