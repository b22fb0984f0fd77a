#pragma once

// OpenGL objects that end with their owner; their context must be current when they are made and when they end.

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "libemap/rendering/gl_functions.h"
#include "libthin/foundation/result.h"

namespace emap {

// One object's name; Delete is called with it at the end.
template <void (*Delete)(GLuint)>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint name) : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_) Delete(name_);
  }
  GLuint get() const { return name_; }

 private:
  GLuint name_ = 0;
};

inline void delete_gl_buffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
inline void delete_gl_texture(GLuint name) {
  glDeleteTextures(1, &name);
}
inline void delete_gl_renderbuffer(GLuint name) {
  glDeleteRenderbuffers(1, &name);
}
inline void delete_gl_framebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}
inline void delete_gl_vertex_array(GLuint name) {
  glDeleteVertexArrays(1, &name);
}
inline void delete_gl_program(GLuint name) {
  glDeleteProgram(name);
}
inline void delete_gl_shader(GLuint name) {
  glDeleteShader(name);
}

using GlBuffer = GlName<delete_gl_buffer>;
using GlTexture = GlName<delete_gl_texture>;
using GlRenderbuffer = GlName<delete_gl_renderbuffer>;
using GlFramebuffer = GlName<delete_gl_framebuffer>;
using GlVertexArray = GlName<delete_gl_vertex_array>;
using GlShader = GlName<delete_gl_shader>;

template <class Item>
GlBuffer gl_buffer(GLenum target, const std::vector<Item>& items) {
  GLuint name = 0;
  glGenBuffers(1, &name);
  glBindBuffer(target, name);
  glBufferData(target, static_cast<GLsizeiptr>(items.size() * sizeof(Item)), items.data(), GL_STATIC_DRAW);
  return GlBuffer(name);
}

GlVertexArray gl_vertex_array();      // and binds it
GlTexture gl_texture(GLenum target);  // and binds it

// A list that shaders read by index.
class BufferTexture {
 public:
  BufferTexture() = default;
  template <class Item>
  BufferTexture(const std::vector<Item>& items, GLenum format)
      : buffer_(gl_buffer(GL_TEXTURE_BUFFER, items)), texture_(gl_texture(GL_TEXTURE_BUFFER)) {
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer_.get());
  }
  void bind(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_BUFFER, texture_.get());
  }

 private:
  GlBuffer buffer_;
  GlTexture texture_;
};

class GlProgram {
 public:
  // Error (internal): what the compiler says.
  static thin::Result<GlProgram> create(const std::string& vertex_source, const std::string& fragment_source);

  void use() const { glUseProgram(name_.get()); }
  // Of the program in use; a uniform that it does not have is nothing to set.
  void set(const char* uniform, int value) const { glUniform1i(location(uniform), value); }
  void set(const char* uniform, double value) const { glUniform1f(location(uniform), static_cast<float>(value)); }
  void set(const char* uniform, const Eigen::Vector2d& value) const;
  void set(const char* uniform, const Eigen::Vector3d& value) const;
  void set(const char* uniform, const Eigen::Matrix3d& value) const;
  void set(const char* uniform, const Eigen::Matrix4d& value) const;

 private:
  GLint location(const char* uniform) const;

  GlName<delete_gl_program> name_;
  mutable std::unordered_map<const char*, GLint> locations_;  // by the address of the literal that names it
};

}  // namespace emap
