#include "libemap/rendering/image.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "libthin/foundation/file_bytes.h"

namespace emap {
namespace {

class ImageTest : public testing::Test {
 protected:
  std::string path_ = testing::TempDir() + "emap_image_" + std::to_string(::getpid()) + ".png";
  void TearDown() override { std::filesystem::remove(path_); }
};

TEST_F(ImageTest, APictureGoesThereAndBack) {
  Image image{5, 3, 4, {}};
  for (int i = 0; i < 5 * 3 * 4; ++i) image.values.push_back(static_cast<std::uint8_t>(i * 4));
  ASSERT_TRUE(write_png(path_, image));
  const auto back = read_png(path_);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->width, 5);
  EXPECT_EQ(back->height, 3);
  EXPECT_EQ(back->values, image.values);
}

TEST_F(ImageTest, SixteenBitsKeepTheirUpperByte) {
  const DeepImage image{2, 1, 4, {0x1234, 0xABCD, 0, 65535, 65535, 0, 0x8000, 65535}};
  ASSERT_TRUE(write_png(path_, image));
  const auto back = read_png(path_);
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->values[0], 0x12, 1);
  EXPECT_NEAR(back->values[1], 0xAB, 1);
  EXPECT_NEAR(back->values[6], 0x80, 1);
}

TEST_F(ImageTest, TheSamePictureIsTheSameFile) {
  const Image image{2, 2, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
  ASSERT_TRUE(write_png(path_, image));
  const auto first = *thin::read_file_bytes(path_);
  ASSERT_TRUE(write_png(path_, image));
  EXPECT_EQ(*thin::read_file_bytes(path_), first);
}

TEST_F(ImageTest, WhatIsNoPictureIsAnError) {
  std::ofstream(path_) << "no picture";
  EXPECT_EQ(read_png(path_).error().kind, thin::ErrorKind::input);
  const Image image{40, 40, 3, std::vector<std::uint8_t>(4800, 7)};
  ASSERT_TRUE(write_png(path_, image));
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2);
  EXPECT_FALSE(read_png(path_));
  EXPECT_FALSE(write_png("/no/such/folder/a.png", image));
}

}  // namespace
}  // namespace emap
