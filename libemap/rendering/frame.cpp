#include "libemap/rendering/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "libemap/rendering/shader_set.h"
#include "libthin/foundation/memory.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

GlTexture attachment(GLenum internal_format, GLenum format, GLenum type, int width, int height) {
  GlTexture texture = gl_texture(GL_TEXTURE_2D);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal_format), width, height, 0, format, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

GlFramebuffer framebuffer(GLuint colour, GLuint depth) {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
  if (depth) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  return GlFramebuffer(name);
}

int half_of_largest_point(int width, int height) {
  std::array<GLfloat, 2> sizes = {1, 1};
  glGetFloatv(GL_POINT_SIZE_RANGE, sizes.data());
  std::array<GLint, 2> most = {width, height};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, most.data());
  const int half = static_cast<int>(std::ceil(sizes[1] / 2));
  return std::max(0, std::min({half, (most[0] - width) / 2, (most[1] - height) / 2}));
}

// Rows from the top instead of from the bottom.
template <class Channel>
ImageOf<Channel> read_picture(int width, int height, GLenum type) {
  ImageOf<Channel> image{width, height, 4, {}};
  const std::size_t row = static_cast<std::size_t>(width) * 4;
  image.values.resize(row * static_cast<std::size_t>(height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, type, image.values.data());
  for (std::size_t y = 0; y < static_cast<std::size_t>(height) / 2; ++y)
    std::swap_ranges(image.values.begin() + static_cast<std::ptrdiff_t>(y * row),
                     image.values.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                     image.values.end() - static_cast<std::ptrdiff_t>((y + 1) * row));
  return image;
}

}  // namespace

Result<Frame> Frame::create(int width, int height, bool deep) {
  GLint most = 0, most_attached = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most_attached);
  most = std::min(most, most_attached);
  if (width < 1 || height < 1 || width > most || height > most)
    return Error{ErrorKind::configuration,
                 fmt::format("a picture of {} x {} pixels: this driver draws 1 to {} each way", width, height, most)};
  // Colour, depth and sums on the card or in memory, and what is read back.
  const std::uint64_t bytes = 32 * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (bytes > thin::available_memory_bytes())
    return Error{
        ErrorKind::configuration,
        fmt::format("a picture of {} x {} pixels needs {} MB, more than this machine has: choose a smaller one", width,
                    height, bytes >> 20)};
  Frame frame;
  frame.width_ = width;
  frame.height_ = height;
  frame.deep_ = deep;
  frame.pixels_beyond_ = half_of_largest_point(width, height);
  frame.colour_ =
      attachment(deep ? GL_RGBA16 : GL_RGBA8, GL_RGBA, deep ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, width, height);
  frame.depth_ = attachment(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, width, height);
  frame.picture_ = framebuffer(frame.colour_.get(), frame.depth_.get());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE || glGetError() != GL_NO_ERROR)
    return Error{ErrorKind::configuration,
                 fmt::format("this driver does not draw pictures of {} x {} pixels", width, height)};
  frame.resolving_ = framebuffer(frame.colour_.get(), 0);
  return frame;
}

void Frame::begin() const {
  resume();
  const float ground = deep_ ? 0.0F : 1.0F;
  glClearColor(ground, ground, ground, ground);
  glClearDepth(1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Frame::resume() const {
  glBindFramebuffer(GL_FRAMEBUFFER, picture_.get());
  glViewport(-pixels_beyond_, -pixels_beyond_, width_ + 2 * pixels_beyond_, height_ + 2 * pixels_beyond_);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glEnable(GL_PROGRAM_POINT_SIZE);
}

Result<void> Frame::begin_sums() {
  if (!sums_.get()) {
    sums_ = attachment(GL_RGBA16F, GL_RGBA, GL_FLOAT, width_, height_);
    summing_ = framebuffer(sums_.get(), depth_.get());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      return Error{ErrorKind::configuration, "this driver does not blend 16-bit numbers: blended splats need that"};
  }
  glBindFramebuffer(GL_FRAMEBUFFER, summing_.get());
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  return {};
}

Result<void> Frame::begin_identities() {
  if (!identities_.get()) {
    identities_ = attachment(GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, width_, height_);
    identifying_ = framebuffer(identities_.get(), depth_.get());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      return Error{ErrorKind::configuration,
                   "this driver does not draw whole numbers: interpolated splats need that, or --one-pass"};
  }
  glBindFramebuffer(GL_FRAMEBUFFER, identifying_.get());
  return {};
}

void Frame::resume_with_identities() const {
  resume();
  glActiveTexture(GL_TEXTURE0 + kIdentitiesUnit);
  glBindTexture(GL_TEXTURE_2D, identities_.get());
}

void Frame::begin_resolve() const {
  glBindFramebuffer(GL_FRAMEBUFFER, resolving_.get());
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glActiveTexture(GL_TEXTURE0 + kSumsUnit);
  glBindTexture(GL_TEXTURE_2D, sums_.get());
  glActiveTexture(GL_TEXTURE0 + kDepthsUnit);
  glBindTexture(GL_TEXTURE_2D, depth_.get());
}

Image Frame::image() const {
  glBindFramebuffer(GL_FRAMEBUFFER, picture_.get());
  return read_picture<std::uint8_t>(width_, height_, GL_UNSIGNED_BYTE);
}

DeepImage Frame::deep_image() const {
  glBindFramebuffer(GL_FRAMEBUFFER, picture_.get());
  return read_picture<std::uint16_t>(width_, height_, GL_UNSIGNED_SHORT);
}

}  // namespace emap
