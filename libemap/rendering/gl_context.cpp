#include "libemap/rendering/gl_context.h"

#include <fmt/format.h>

#include "libemap/rendering/gl_functions.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

// EGL and OSMesa share Mesa's idea of a current context: the one must let go before the other takes over.
void (*release_current)() = nullptr;

}  // namespace

void release_current_context() {
  if (release_current) release_current();
  release_current = nullptr;
}

void set_current_context(void (*release)()) {
  release_current = release;
}

std::optional<Backend> find_backend(const std::string& name) {
  if (name == "auto") return Backend::automatic;
  if (name == "egl") return Backend::egl;
  if (name == "osmesa") return Backend::osmesa;
  return std::nullopt;
}

std::string GlContext::renderer() const {
  const auto text = [](GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); };
  return fmt::format("{}, OpenGL {}", text(GL_RENDERER), text(GL_VERSION));
}

Result<std::unique_ptr<GlContext>> create_context(Backend backend, const ContextLibraries& libraries) {
  if (backend == Backend::egl) return create_egl_context(libraries.egl);
  if (backend == Backend::osmesa) return create_osmesa_context(libraries.osmesa);
  Result<std::unique_ptr<GlContext>> egl = create_egl_context(libraries.egl);
  if (egl) return egl;
  Result<std::unique_ptr<GlContext>> osmesa = create_osmesa_context(libraries.osmesa);
  if (osmesa) return osmesa;
  return Error{ErrorKind::configuration,
               fmt::format("no way to draw here. {}. {}", egl.error().message, osmesa.error().message)};
}

}  // namespace emap
