#pragma once

// What is drawn into: a picture with depth, and the sums that blended splats need.

#include "libemap/rendering/gl_objects.h"
#include "libemap/rendering/image.h"

namespace emap {

class Frame {
 public:
  // deep: 16 bits a channel instead of 8. Errors (configuration): a size that is not one, or that the driver or the
  // memory cannot hold.
  static thin::Result<Frame> create(int width, int height, bool deep);

  int width() const { return width_; }
  int height() const { return height_; }
  // Beyond the picture on all sides the viewport goes on: by half the largest point that the driver draws.
  int pixels_beyond() const { return pixels_beyond_; }

  // Clears the picture to white, or to zeros where it is deep, and depth to the farthest; draws go there.
  void begin() const;
  // Draws go to the sums, additively, against the depth as it is; cleared first. Made when first asked for.
  thin::Result<void> begin_sums();
  // Draws go to a picture of numbers, with the picture's depth. Made when first asked for.
  thin::Result<void> begin_identities();
  // Draws go to the picture again; the numbers can be read as a texture.
  void resume_with_identities() const;
  // Draws go to the picture, without looking at depths; sums and depths can be read as textures.
  void begin_resolve() const;
  // Draws go to the picture and its depth again.
  void resume() const;

  // What was drawn; 4 channels. REQUIRES: not deep / deep
  Image image() const;
  DeepImage deep_image() const;

 private:
  int width_ = 0, height_ = 0, pixels_beyond_ = 0;
  bool deep_ = false;
  GlTexture colour_, depth_, sums_, identities_;
  GlFramebuffer picture_, summing_, resolving_, identifying_;
};

}  // namespace emap
