// What the page draws.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "tests/libemap/page/opened_page.h"
#include "tests/libemap/page/ring_model.h"
#include "tests/support/drawn_mesh.h"

namespace emap {
namespace {

using Bytes = std::vector<std::uint8_t>;
using test::Browser;
using test::pixels_of;
using test::ring_stream;

std::string link_of(const test::View& view, const std::string& shading) {
  return fmt::format("#azimuth={}&elevation={}&distance={}&shading={}", view.azimuth_degrees, view.elevation_degrees,
                     view.distance, shading);
}

struct Difference {
  double mean = 0;
  double wide = 0;     // share of pixels that differ by more than 0.03
  double outline = 0;  // mean over the pixels of the outline
};

// Inside: where the pixel and its neighbours are all covered. Outline: the other pixels that are not white in both.
Difference difference_of(const std::vector<Eigen::Vector3d>& pixels, const test::DrawnPicture& expected, int width) {
  Difference difference;
  double inside = 0, outline = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double apart = std::abs(pixels[i].x() - expected[i].grey);
    const auto stride = static_cast<std::size_t>(width);
    bool is_inside = true;
    for (const std::size_t row : {i - stride, i, i + stride})
      for (const std::size_t j : {row - 1, row, row + 1})
        is_inside = is_inside && j < expected.size() && expected[j].covered > 0.99;
    if (is_inside) {
      ++inside;
      difference.mean += apart;
      difference.wide += apart > 0.03 ? 1 : 0;
    } else if (pixels[i].x() != 1 || expected[i].covered > 0) {
      ++outline;
      difference.outline += apart;
    }
  }
  EXPECT_GT(inside, 0.05 * static_cast<double>(pixels.size()));
  difference.mean /= inside;
  difference.wide /= inside;
  difference.outline /= outline;
  return difference;
}

class ViewerTest : public test::PageTest, public testing::WithParamInterface<std::string> {};

// Means of the triangles around, weighted by the inverse of the squares of the two sides there (N. Max, 1999); where a
// sample has no triangle, as differences of elevations have it.
std::vector<Eigen::Vector3d> page_normals(const ElevationMaps& maps, const Mesh& closed) {
  std::vector<Eigen::Vector3d> sums(closed.positions.size(), Eigen::Vector3d::Zero());
  for (const auto& triangle : closed.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d& corner = closed.positions[triangle[i]];
      const Eigen::Vector3d to_next = closed.positions[triangle[(i + 1) % 3]] - corner;
      const Eigen::Vector3d to_last = closed.positions[triangle[(i + 2) % 3]] - corner;
      sums[triangle[i]] += to_next.cross(to_last) / (to_next.squaredNorm() * to_last.squaredNorm());
    }
  std::vector<Eigen::Vector3d> normals = sample_points(maps).normals;
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (sums[i].norm() > 0) normals[i] = sums[i].normalized();
  return normals;
}

// Tolerance: elevations and normals have 16 bits in the page, and it takes the light in the middle of a pixel, the test
// at sixteen places; outlines are averaged over other places.
TEST_P(ViewerTest, DrawsTheDecodedSurface) {
  const Bytes stream = ring_stream(GetParam());
  const DecodedStream decoded = std::move(read_stream(stream)).value();
  ASSERT_GT(decoded.maps.patches.size(), 1U);
  const Mesh mesh = closed_mesh(decoded.maps).mesh;
  const std::vector<Eigen::Vector3d> normals = page_normals(decoded.maps, mesh);
  Browser browser;
  for (const test::View& view :
       {test::View{30, 15, 2, 640, 480}, test::View{-100, 60, 1.6, 400, 520}, test::View{200, -35, 2.5, 480, 480}}) {
    ASSERT_EQ(open(browser, web_page("ring", stream), link_of(view, "lighting"), view.width, view.height), "drawn");
    const Difference difference = difference_of(
        pixels_of(browser, view), test::drawn_mesh(mesh, normals, decoded.header.frame.box, view), view.width);
    SCOPED_TRACE(link_of(view, "lighting"));
    EXPECT_LT(difference.mean, 0.004);
    EXPECT_LT(difference.wide, 0.01);
    EXPECT_LT(difference.outline, 0.06);
    // The next test's page is another document, not this one with another hash.
    browser.open("about:blank", 10, 10);
  }
}

// The same triangles, in the same order.
TEST_P(ViewerTest, ClosesGapsAsTheProgramDoes) {
  const Bytes stream = ring_stream(GetParam());
  Browser browser;
  ASSERT_EQ(open(browser, web_page("ring", stream)), "drawn");
  const nlohmann::json found = browser.evaluate(fmt::format(R"((() => {{
    const stream = decode_stream(Uint8Array.from(atob("{}"), (letter) => letter.charCodeAt(0)), () => {{}});
    const surface = surface_of(stream, build_model(stream, () => {{}}));
    return new GapFiller(surface, stream.header.spacing, stream.header.least).fill();
  }})())",
                                                            test::base64_of(stream)));
  const ClosedMesh closed = closed_mesh(read_stream(stream).value().maps);
  const auto& triangles = closed.mesh.triangles;
  ASSERT_GT(closed.filling.inserted, 100U);
  ASSERT_EQ(found.size(), closed.filling.inserted);
  const std::size_t first = triangles.size() - closed.filling.inserted;
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], nlohmann::json(triangles[first + i]));
}

TEST_P(ViewerTest, ShadesAsTheLinkAsks) {
  const Bytes stream = ring_stream(GetParam());
  const test::View view{30, 15, 2, 200, 200};
  Browser browser;
  std::vector<std::vector<Eigen::Vector3d>> pictures;
  for (const std::string shading : {"lighting", "reflection", "patches"}) {
    ASSERT_EQ(open(browser, web_page("ring", stream), link_of(view, shading), view.width, view.height), "drawn");
    EXPECT_EQ(browser.evaluate("document.querySelector('input[name=shading]:checked').value"), shading);
    pictures.push_back(pixels_of(browser, view));
    browser.open("about:blank", 10, 10);
  }
  const auto coloured = [](const std::vector<Eigen::Vector3d>& pixels) {
    return std::count_if(pixels.begin(), pixels.end(),
                         [](const Eigen::Vector3d& p) { return p.maxCoeff() - p.minCoeff() > 0.15; });
  };
  EXPECT_EQ(coloured(pictures[0]), 0);
  EXPECT_GT(coloured(pictures[2]), 1000);
  EXPECT_NE(pictures[0], pictures[1]);
}

INSTANTIATE_TEST_SUITE_P(Coders, ViewerTest, testing::Values("baseline", "contexts"));

}  // namespace
}  // namespace emap
