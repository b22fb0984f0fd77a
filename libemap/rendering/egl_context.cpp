// EGL without a window system: Mesa's surfaceless platform, else the device platform (as NVIDIA has it).

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

#include "libemap/rendering/gl_context.h"
#include "libemap/rendering/gl_functions.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

bool has(const char* extensions, std::string_view name) {
  return extensions && (" " + std::string(extensions) + " ").find(" " + std::string(name) + " ") != std::string::npos;
}

struct Display {
  EGLDisplay display = EGL_NO_DISPLAY;
  std::string platform;
};

// Every display that may work here, the likeliest first: GPUs by the device platform, then whatever Mesa has.
std::vector<Display> displays() {
  std::vector<Display> found;
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has(extensions, "EGL_EXT_platform_base")) return found;
  if (has(extensions, "EGL_EXT_platform_device") && has(extensions, "EGL_EXT_device_enumeration")) {
    std::array<EGLDeviceEXT, 16> devices;
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count))
      for (EGLint i = 0; i < count; ++i)
        if (!has(eglQueryDeviceStringEXT(devices[static_cast<std::size_t>(i)], EGL_EXTENSIONS),
                 "EGL_MESA_device_software"))
          found.push_back(
              {eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr),
               "device"});
  }
  if (has(extensions, "EGL_MESA_platform_surfaceless"))
    found.push_back(
        {eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), "surfaceless"});
  return found;
}

EGLContext core_context(EGLDisplay display) {
  constexpr std::array<EGLint, 7> kAttributes = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!has(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) {
    constexpr std::array<EGLint, 5> kWanted = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                               EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(display, kWanted.data(), &config, 1, &count) || count == 0) return EGL_NO_CONTEXT;
  }
  return eglCreateContext(display, config, EGL_NO_CONTEXT, kAttributes.data());
}

EGLDisplay current_display = EGL_NO_DISPLAY;

// Displays stay initialised until the process ends: contexts of one display share it.
class EglGlContext : public GlContext {
 public:
  EglGlContext(const Display& display, EGLContext context) : display_(display), context_(context) {}
  ~EglGlContext() override {
    release_current_context();
    eglDestroyContext(display_.display, context_);
  }

  Result<void> make_current() override {
    release_current_context();
    if (!eglMakeCurrent(display_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      return Error{ErrorKind::configuration,
                   fmt::format("EGL ({}) does not make a context current without a surface (error {:#x}): its driver "
                               "lacks EGL_KHR_surfaceless_context; use --backend osmesa",
                               display_.platform, eglGetError())};
    current_display = display_.display;
    set_current_context([] { eglMakeCurrent(current_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); });
    const std::string missing =
        use_gl_functions([](const char* name) { return reinterpret_cast<GlFunction>(eglGetProcAddress(name)); });
    if (!missing.empty()) return Error{ErrorKind::configuration, fmt::format("EGL's driver lacks {}", missing)};
    return {};
  }

  std::string backend() const override { return fmt::format("egl ({})", display_.platform); }

 private:
  Display display_;
  EGLContext context_;
};

}  // namespace

Result<std::unique_ptr<GlContext>> create_egl_context(const std::string& library) {
  // libepoxy ends the process where it finds no EGL, so its library is looked for first; it stays open.
  if (!dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL))
    return Error{ErrorKind::configuration,
                 fmt::format("EGL's library ({}) is not here: install the package libegl1 (and libgl1-mesa-dri or the "
                             "GPU's driver), or use --backend osmesa",
                             library)};
  std::string tried;
  for (const Display& display : displays()) {
    if (display.display == EGL_NO_DISPLAY || !eglInitialize(display.display, nullptr, nullptr)) {
      tried += (tried.empty() ? "" : ", ") + display.platform;
      continue;
    }
    const EGLContext created = core_context(display.display);
    if (created == EGL_NO_CONTEXT) {
      tried += (tried.empty() ? "" : ", ") + display.platform;
      continue;
    }
    auto context = std::make_unique<EglGlContext>(display, created);
    if (context->make_current()) return std::unique_ptr<GlContext>(std::move(context));
    tried += (tried.empty() ? "" : ", ") + display.platform;
  }
  return Error{ErrorKind::configuration,
               fmt::format("EGL is here, but none of its platforms ({}) gives an OpenGL 3.3 core context: install the "
                           "GPU's driver or the package libgl1-mesa-dri, or use --backend osmesa",
                           tried.empty() ? "no device or surfaceless platform" : tried)};
}

}  // namespace emap
