// The page's picture and `emap render`'s of the same file and view.

#include <fmt/format.h>

#include <cstdlib>

#include "libthin/foundation/file_bytes.h"
#include "tests/libemap/page/opened_page.h"
#include "tests/libemap/page/ring_model.h"

namespace emap {
namespace {

using nlohmann::json;

// How the page's pixels differ from those of a picture in PNG: mean and share of wide differences (more than 8 of 255)
// where the picture's pixel and its neighbours are not white; how many pixels that are; the mean over the other pixels
// that are not white in both.
constexpr const char* kCompare = R"((async () => {{
  const picture = await createImageBitmap(
    new Blob([Uint8Array.from(atob("{}"), (letter) => letter.charCodeAt(0))], {{ type: "image/png" }}));
  const canvas = new OffscreenCanvas(picture.width, picture.height), context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  const expected = context.getImageData(0, 0, picture.width, picture.height).data;
  page.draw();
  const gl = page.renderer.gl, width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
  const pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const sums = {{ size: [picture.width, picture.height], inside: 0, mean: 0, wide: 0, edge: 0, outline: 0 }};
  for (let y = 1; y + 1 < height; ++y)
    for (let x = 1; x + 1 < width; ++x) {{
      const at = (row, column) => expected[4 * (row * width + column)];
      const drawn = pixels[4 * ((height - 1 - y) * width + x)], apart = Math.abs(at(y, x) - drawn);
      let inside = true;
      for (let row = y - 1; row <= y + 1; ++row)
        for (let column = x - 1; column <= x + 1; ++column) inside = inside && at(row, column) !== 255;
      if (inside) {{
        ++sums.inside;
        sums.mean += apart;
        sums.wide += apart > 8 ? 1 : 0;
      }} else if (at(y, x) !== 255 || drawn !== 255) {{
        ++sums.edge;
        sums.outline += apart;
      }}
    }}
  return {{ ...sums, mean: sums.mean / sums.inside, wide: sums.wide / sums.inside, outline: sums.outline / sums.edge }};
}})())";

class RenderComparisonTest : public test::PageTest {};

// Tolerance: one averages outlines over a pixel and the other need not, and each closes seams between patches in its
// own way.
TEST_F(RenderComparisonTest, TheSameViewIsTheSamePicture) {
  const std::vector<std::uint8_t> stream = test::ring_stream("contexts");
  const std::string model = path("ring.emap"), picture = path("ring.png");
  ASSERT_TRUE(thin::write_file_bytes(model, stream).ok());
  test::Browser browser;
  for (const auto& [azimuth, elevation, distance] :
       {std::array{30.0, 15.0, 2.0}, std::array{-100.0, 60.0, 1.6}, std::array{200.0, -35.0, 2.5}}) {
    const std::string command =
        fmt::format("{} render {} {} --backend osmesa --mode mesh --shading lighting --size 500x400 --camera {},{},{}",
                    EMAP_PROGRAM, model, picture, azimuth, elevation, distance);
    ASSERT_EQ(std::system((command + " > /dev/null").c_str()), 0) << command;
    const std::string view = fmt::format("#azimuth={}&elevation={}&distance={}", azimuth, elevation, distance);
    ASSERT_EQ(open(browser, web_page("ring", stream), view, 500, 400), "drawn");
    const json difference =
        browser.evaluate(fmt::format(kCompare, test::base64_of(thin::read_file_bytes(picture).value())));
    SCOPED_TRACE(view + " " + difference.dump());
    EXPECT_EQ(difference["size"], json({500, 400}));
    EXPECT_GT(difference["inside"], 10000);
    EXPECT_LT(difference["mean"], 1.0);
    EXPECT_LT(difference["wide"], 0.01);
    EXPECT_LT(difference["outline"], 40);
    browser.open("about:blank", 10, 10);
  }
}

}  // namespace
}  // namespace emap
