#pragma once

// Pages opened in the browser, for the tests of this folder.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "libemap/coding/stream.h"
#include "libemap/page/page.h"
#include "tests/support/browser.h"
#include "tests/support/drawn_mesh.h"

namespace emap::test {

// What the browser is asked for beside the page's own functions.
constexpr const char* kPack = R"(
  const pack = (values) => {
    const bytes = new Uint8Array(values.buffer, values.byteOffset, values.byteLength);
    let text = "";
    for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
    return btoa(text);
  };
)";

class PageTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!Browser::installed()) GTEST_SKIP() << "no chromium on this machine";
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Of a file of this test alone.
  std::string path(const std::string& name) const { return folder_ / name; }

  // Writes the page and returns its address.
  std::string address_of(const std::string& html) const {
    std::ofstream(path("page.html"), std::ios::binary) << html;
    return "file://" + path("page.html");
  }

  // Opens the page and waits until it is drawn or says why it is not: "drawn", or the message.
  std::string open(Browser& browser, const std::string& html, const std::string& view = "", int width = 400,
                   int height = 300) const {
    browser.open(address_of(html) + view, width, height);
    return browser.evaluate(R"(opened.then(() => document.body.dataset.state === "failed"
        ? document.getElementById("message").innerText : document.body.dataset.state))");
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("emap_page_" + std::to_string(::getpid()));
};

// Red, green, blue of every pixel as numbers from 0 to 1, row by row from the top.
inline std::vector<Eigen::Vector3d> pixels_of(Browser& browser, const View& view) {
  const nlohmann::json drawn = browser.evaluate(fmt::format(R"((() => {{ {}
    page.draw();
    const gl = page.renderer.gl, width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return {{ width, height, pixels: pack(pixels) }};
  }})())",
                                                            kPack));
  EXPECT_EQ(drawn["width"], view.width);
  EXPECT_EQ(drawn["height"], view.height);
  const std::vector<std::uint8_t> bytes = bytes_of_base64(drawn["pixels"]);
  std::vector<Eigen::Vector3d> pixels;
  for (int row = view.height - 1; row >= 0; --row)
    for (int column = 0; column < view.width; ++column) {
      const std::size_t i = 4 * (static_cast<std::size_t>(row) * view.width + column);
      pixels.emplace_back(bytes[i] / 255.0, bytes[i + 1] / 255.0, bytes[i + 2] / 255.0);
    }
  return pixels;
}

}  // namespace emap::test
