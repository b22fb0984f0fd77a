#include "libemap/rendering/gl_functions.h"

namespace emap {
namespace {

template <class Pointer>
bool set(Pointer& pointer, GlFunction function) {
  pointer = reinterpret_cast<Pointer>(function);
  return function != nullptr;
}

}  // namespace

#define EMAP_GL_FUNCTIONS(X)                                                                                           \
  X(glActiveTexture)                                                                                                   \
  X(glAttachShader)                                                                                                    \
  X(glBindAttribLocation)                                                                                              \
  X(glBindBuffer)                                                                                                      \
  X(glBindFramebuffer)                                                                                                 \
  X(glBindRenderbuffer)                                                                                                \
  X(glBindTexture)                                                                                                     \
  X(glBindVertexArray)                                                                                                 \
  X(glBlendFunc)                                                                                                       \
  X(glBufferData)                                                                                                      \
  X(glCheckFramebufferStatus) X(glClear) X(glClearColor) X(glClearDepth) X(glColorMask) X(glCompileShader)             \
      X(glCreateProgram) X(glCreateShader) X(glDeleteBuffers) X(glDeleteFramebuffers) X(glDeleteProgram)               \
          X(glDeleteRenderbuffers) X(glDeleteShader) X(glDeleteTextures) X(glDeleteVertexArrays) X(glDepthFunc)        \
              X(glDepthMask) X(glDisable) X(glDrawArrays) X(glDrawElements) X(glDrawElementsBaseVertex) X(glEnable)    \
                  X(glEnableVertexAttribArray) X(glFinish) X(glFramebufferRenderbuffer) X(glFramebufferTexture2D)      \
                      X(glGenBuffers) X(glGenFramebuffers) X(glGenRenderbuffers) X(glGenTextures) X(glGenVertexArrays) \
                          X(glGenerateMipmap) X(glGetError) X(glGetIntegerv) X(glGetProgramInfoLog) X(glGetFloatv)     \
                              X(glGetProgramiv) X(glGetShaderInfoLog) X(glGetShaderiv) X(glGetString)                  \
                                  X(glGetUniformLocation) X(glLinkProgram) X(glPixelStorei) X(glReadPixels)            \
                                      X(glScissor) X(glRenderbufferStorage) X(glShaderSource) X(glTexBuffer)           \
                                          X(glTexImage2D) X(glTexParameteri) X(glUniform1f) X(glUniform1i)             \
                                              X(glUniform2f) X(glUniform3fv) X(glUniform4fv) X(glUniformMatrix3fv)     \
                                                  X(glUniformMatrix4fv) X(glUseProgram) X(glVertexAttribIPointer)      \
                                                      X(glVertexAttribPointer) X(glViewport)

std::string use_gl_functions(GlFunction (*find)(const char*)) {
#define EMAP_USE(name) \
  if (!set(epoxy_##name, find(#name))) return #name;
  EMAP_GL_FUNCTIONS(EMAP_USE)
#undef EMAP_USE
  return {};
}

}  // namespace emap
