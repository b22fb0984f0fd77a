#include "libemap/rendering/gl_objects.h"

#include <fmt/format.h>

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

Result<GlShader> compiled(GLenum kind, const std::string& source) {
  GlShader shader(glCreateShader(kind));
  const char* text = source.c_str();
  glShaderSource(shader.get(), 1, &text, nullptr);
  glCompileShader(shader.get());
  GLint good = 0;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &good);
  if (!good) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader.get(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return Error{ErrorKind::internal, fmt::format("a {} shader does not compile: {}",
                                                  kind == GL_VERTEX_SHADER ? "vertex" : "fragment", log)};
  }
  return shader;
}

}  // namespace

GlVertexArray gl_vertex_array() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  glBindVertexArray(name);
  return GlVertexArray(name);
}

GlTexture gl_texture(GLenum target) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(target, name);
  return GlTexture(name);
}

Result<GlProgram> GlProgram::create(const std::string& vertex_source, const std::string& fragment_source) {
  const Result<GlShader> vertex = compiled(GL_VERTEX_SHADER, vertex_source);
  if (!vertex) return vertex.error();
  const Result<GlShader> fragment = compiled(GL_FRAGMENT_SHADER, fragment_source);
  if (!fragment) return fragment.error();
  GlProgram program;
  program.name_ = GlName<delete_gl_program>(glCreateProgram());
  const GLuint name = program.name_.get();
  glAttachShader(name, vertex->get());
  glAttachShader(name, fragment->get());
  glBindAttribLocation(name, 0, "position");
  glBindAttribLocation(name, 1, "polar");
  glBindAttribLocation(name, 2, "radius");
  glLinkProgram(name);
  GLint good = 0;
  glGetProgramiv(name, GL_LINK_STATUS, &good);
  if (!good) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(name, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return Error{ErrorKind::internal, fmt::format("shaders do not link: {}", log)};
  }
  return program;
}

void GlProgram::set(const char* uniform, const Eigen::Vector2d& value) const {
  glUniform2f(location(uniform), static_cast<float>(value.x()), static_cast<float>(value.y()));
}

void GlProgram::set(const char* uniform, const Eigen::Vector3d& value) const {
  const Eigen::Vector3f single = value.cast<float>();
  glUniform3fv(location(uniform), 1, single.data());
}

void GlProgram::set(const char* uniform, const Eigen::Matrix3d& value) const {
  const Eigen::Matrix3f single = value.cast<float>();
  glUniformMatrix3fv(location(uniform), 1, GL_FALSE, single.data());
}

void GlProgram::set(const char* uniform, const Eigen::Matrix4d& value) const {
  const Eigen::Matrix4f single = value.cast<float>();
  glUniformMatrix4fv(location(uniform), 1, GL_FALSE, single.data());
}

GLint GlProgram::location(const char* uniform) const {
  const auto [entry, is_new] = locations_.try_emplace(uniform, -1);
  if (is_new) entry->second = glGetUniformLocation(name_.get(), uniform);
  return entry->second;
}

}  // namespace emap
