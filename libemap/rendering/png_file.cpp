#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <memory>

#include "libemap/rendering/image.h"
#include "libthin/foundation/file_bytes.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

void append(png_structp png, png_bytep bytes, png_size_t count) {
  auto& file = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  file.insert(file.end(), bytes, bytes + count);
}

void keep_quiet(png_structp, png_const_charp) {}

// rows: pointers into the picture. libpng leaves by longjmp where it fails: no object with a destructor may live here.
bool encode(int width, int height, int channels, int bits, png_bytepp rows, std::vector<std::uint8_t>* file) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, keep_quiet);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, file, append, nullptr);
  // One plain filter for pictures that are measured, so that readers in slow languages can undo it at once.
  if (bits == 16) png_set_filter(png, 0, PNG_FILTER_UP);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (bits == 16) png_set_swap(png);
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

template <class Channel>
Result<void> write(const std::string& path, const ImageOf<Channel>& image) {
  std::vector<png_bytep> rows;
  for (int y = 0; y < image.height; ++y)
    rows.push_back(reinterpret_cast<png_bytep>(const_cast<Channel*>(image.pixel(0, y))));
  std::vector<std::uint8_t> file;
  if (!encode(image.width, image.height, image.channels, 8 * static_cast<int>(sizeof(Channel)), rows.data(), &file))
    return Error{ErrorKind::internal,
                 fmt::format("{}: libpng does not write a picture of {} x {}", path, image.width, image.height)};
  return thin::write_file_bytes(path, file);
}

}  // namespace

Result<void> write_png(const std::string& path, const Image& image) {
  return write(path, image);
}

Result<void> write_png(const std::string& path, const DeepImage& image) {
  return write(path, image);
}

Result<Image> read_png(const std::string& path) {
  const Result<std::vector<std::uint8_t>> bytes = thin::read_file_bytes(path);
  if (!bytes) return bytes.error();
  png_image reader{};
  reader.version = PNG_IMAGE_VERSION;
  const auto fail = [&](const std::string& why) {
    png_image_free(&reader);
    return Error{ErrorKind::input, fmt::format("{}: {}", path, why)};
  };
  if (!png_image_begin_read_from_memory(&reader, bytes->data(), bytes->size()))
    return fail(fmt::format("no PNG ({})", reader.message));
  reader.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // or 16 bits would be taken for linear light
  constexpr unsigned kMostPixels = 16384;
  if (reader.width > kMostPixels || reader.height > kMostPixels)
    return fail(fmt::format("{} x {} pixels, which may be {} each", reader.width, reader.height, kMostPixels));
  reader.format = PNG_FORMAT_RGBA;
  Image image{static_cast<int>(reader.width), static_cast<int>(reader.height), 4, {}};
  image.values.resize(PNG_IMAGE_SIZE(reader));
  if (!png_image_finish_read(&reader, nullptr, image.values.data(), 0, nullptr))
    return fail(fmt::format("a damaged PNG ({})", reader.message));
  return image;
}

}  // namespace emap
