// OSMesa: Mesa's software renderer in a library of its own.

// libepoxy's declarations must come before OSMesa's.
#include "libemap/rendering/gl_functions.h"
//
#include <GL/osmesa.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <array>

#include "libemap/rendering/gl_context.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

struct OsMesa {
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaGetProcAddress) find = nullptr;
};

// Stays open until the process ends: LLVM inside it does not survive being closed.
Result<OsMesa> open_library(const std::string& names) {
  void* library = nullptr;
  for (std::size_t begin = 0; !library && begin <= names.size();) {
    const std::size_t end = std::min(names.find(':', begin), names.size());
    library = dlopen(names.substr(begin, end - begin).c_str(), RTLD_NOW | RTLD_LOCAL);
    begin = end + 1;
  }
  if (!library)
    return Error{
        ErrorKind::configuration,
        fmt::format("OSMesa's library ({}) is not here: install the package libosmesa6, or use --backend egl", names)};
  OsMesa mesa;
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    return function != nullptr;
  };
  if (!load(mesa.create, "OSMesaCreateContextAttribs") || !load(mesa.destroy, "OSMesaDestroyContext") ||
      !load(mesa.make_current, "OSMesaMakeCurrent") || !load(mesa.find, "OSMesaGetProcAddress"))
    return Error{ErrorKind::configuration,
                 fmt::format("OSMesa's library ({}) is too old to make core contexts: install libosmesa6 of Mesa 11.2 "
                             "or later, or use --backend egl",
                             names)};
  return mesa;
}

OsMesa current_library;

class OsMesaGlContext : public GlContext {
 public:
  OsMesaGlContext(const OsMesa& mesa, OSMesaContext context) : mesa_(mesa), context_(context) {}
  ~OsMesaGlContext() override {
    release_current_context();
    mesa_.destroy(context_);
  }

  Result<void> make_current() override {
    release_current_context();
    current_library = mesa_;
    // OSMesa asks for a picture of its own; everything is drawn into framebuffer objects instead.
    if (!mesa_.make_current(context_, unused_picture_.data(), GL_UNSIGNED_BYTE, 1, 1))
      return Error{ErrorKind::internal, "OSMesa does not make its context current"};
    set_current_context([] { current_library.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); });
    const std::string missing =
        use_gl_functions([](const char* name) { return reinterpret_cast<GlFunction>(current_library.find(name)); });
    if (!missing.empty())
      return Error{ErrorKind::configuration, fmt::format("OSMesa lacks {}: its Mesa is too old", missing)};
    return {};
  }

  std::string backend() const override { return "osmesa"; }

 private:
  OsMesa mesa_;
  OSMesaContext context_;
  std::array<unsigned char, 64> unused_picture_{};
};

}  // namespace

Result<std::unique_ptr<GlContext>> create_osmesa_context(const std::string& libraries) {
  const Result<OsMesa> mesa = open_library(libraries);
  if (!mesa) return mesa.error();
  const std::array<int, 9> attributes = {OSMESA_FORMAT,
                                         OSMESA_RGBA,
                                         OSMESA_PROFILE,
                                         OSMESA_CORE_PROFILE,
                                         OSMESA_CONTEXT_MAJOR_VERSION,
                                         3,
                                         OSMESA_CONTEXT_MINOR_VERSION,
                                         3,
                                         0};
  const OSMesaContext created = mesa->create(attributes.data(), nullptr);
  if (!created)
    return Error{ErrorKind::configuration,
                 "OSMesa makes no OpenGL 3.3 core context: install libosmesa6 of Mesa 17 or later"};
  auto context = std::make_unique<OsMesaGlContext>(*mesa, created);
  if (const Result<void> current = context->make_current(); !current) return current.error();
  return std::unique_ptr<GlContext>(std::move(context));
}

}  // namespace emap
