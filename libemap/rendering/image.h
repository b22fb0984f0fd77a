#pragma once

// Pictures in memory, and as PNG.

#include <cstdint>
#include <string>
#include <vector>

#include "libthin/foundation/result.h"

namespace emap {

// Rows from the top; 8 or 16 bits a channel, as the type says.
template <class Channel>
struct ImageOf {
  int width = 0, height = 0, channels = 0;
  std::vector<Channel> values;  // height x width x channels

  const Channel* pixel(int x, int y) const {
    return values.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels);
  }
};
using Image = ImageOf<std::uint8_t>;
using DeepImage = ImageOf<std::uint16_t>;

// 3 or 4 channels; no time and no program's name in the file. Errors: temporary or internal, by errno.
thin::Result<void> write_png(const std::string& path, const Image& image);
thin::Result<void> write_png(const std::string& path, const DeepImage& image);

// Any PNG as red, green, blue, alpha of 8 bits. Errors: input (no PNG, damaged, wider or higher than 16,384).
thin::Result<Image> read_png(const std::string& path);

}  // namespace emap
