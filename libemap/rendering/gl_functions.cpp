#include "libemap/rendering/gl_functions.h"

namespace emap {
namespace {

struct Function {
  const char* name;
  void (*set)(GlFunction);
};

#define EMAP_GL(name)                                                                                        \
  {                                                                                                          \
    "gl" #name, [](GlFunction found) { epoxy_gl##name = reinterpret_cast<decltype(epoxy_gl##name)>(found); } \
  }

constexpr Function kFunctions[] = {
    EMAP_GL(ActiveTexture),
    EMAP_GL(AttachShader),
    EMAP_GL(BindAttribLocation),
    EMAP_GL(BindBuffer),
    EMAP_GL(BindFramebuffer),
    EMAP_GL(BindRenderbuffer),
    EMAP_GL(BindTexture),
    EMAP_GL(BindVertexArray),
    EMAP_GL(BlendFunc),
    EMAP_GL(BufferData),
    EMAP_GL(CheckFramebufferStatus),
    EMAP_GL(Clear),
    EMAP_GL(ClearColor),
    EMAP_GL(ClearDepth),
    EMAP_GL(ColorMask),
    EMAP_GL(CompileShader),
    EMAP_GL(CreateProgram),
    EMAP_GL(CreateShader),
    EMAP_GL(DeleteBuffers),
    EMAP_GL(DeleteFramebuffers),
    EMAP_GL(DeleteProgram),
    EMAP_GL(DeleteRenderbuffers),
    EMAP_GL(DeleteShader),
    EMAP_GL(DeleteTextures),
    EMAP_GL(DeleteVertexArrays),
    EMAP_GL(DepthFunc),
    EMAP_GL(DepthMask),
    EMAP_GL(Disable),
    EMAP_GL(DrawArrays),
    EMAP_GL(DrawElements),
    EMAP_GL(DrawElementsBaseVertex),
    EMAP_GL(Enable),
    EMAP_GL(EnableVertexAttribArray),
    EMAP_GL(Finish),
    EMAP_GL(FramebufferRenderbuffer),
    EMAP_GL(FramebufferTexture2D),
    EMAP_GL(GenBuffers),
    EMAP_GL(GenFramebuffers),
    EMAP_GL(GenRenderbuffers),
    EMAP_GL(GenTextures),
    EMAP_GL(GenVertexArrays),
    EMAP_GL(GenerateMipmap),
    EMAP_GL(GetError),
    EMAP_GL(GetIntegerv),
    EMAP_GL(GetProgramInfoLog),
    EMAP_GL(GetFloatv),
    EMAP_GL(GetProgramiv),
    EMAP_GL(GetShaderInfoLog),
    EMAP_GL(GetShaderiv),
    EMAP_GL(GetString),
    EMAP_GL(GetUniformLocation),
    EMAP_GL(LinkProgram),
    EMAP_GL(PixelStorei),
    EMAP_GL(ReadPixels),
    EMAP_GL(Scissor),
    EMAP_GL(RenderbufferStorage),
    EMAP_GL(ShaderSource),
    EMAP_GL(TexBuffer),
    EMAP_GL(TexImage2D),
    EMAP_GL(TexParameteri),
    EMAP_GL(Uniform1f),
    EMAP_GL(Uniform1i),
    EMAP_GL(Uniform2f),
    EMAP_GL(Uniform3fv),
    EMAP_GL(Uniform4fv),
    EMAP_GL(UniformMatrix3fv),
    EMAP_GL(UniformMatrix4fv),
    EMAP_GL(UseProgram),
    EMAP_GL(VertexAttribIPointer),
    EMAP_GL(VertexAttribPointer),
    EMAP_GL(Viewport),
};
#undef EMAP_GL

}  // namespace

std::string use_gl_functions(GlFunction (*find)(const char*)) {
  for (const Function& function : kFunctions) {
    const GlFunction found = find(function.name);
    if (!found) return function.name;
    function.set(found);
  }
  return {};
}

}  // namespace emap
