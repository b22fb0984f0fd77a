// The page as a visitor has it: what it draws, how it is turned, what it says when it can't.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/mesh_normals.h"
#include "tests/libemap/page/opened_page.h"
#include "tests/libemap/page/ring_model.h"
#include "tests/support/drawn_mesh.h"

namespace emap {
namespace {

using Bytes = std::vector<std::uint8_t>;
using nlohmann::json;
using test::Browser;
using test::ring_stream;

std::string link_of(const test::View& view, const std::string& shading) {
  return fmt::format("#azimuth={}&elevation={}&distance={}&shading={}", view.azimuth_degrees, view.elevation_degrees,
                     view.distance, shading);
}

// Red, green, blue of every pixel as numbers from 0 to 1, row by row from the top.
std::vector<Eigen::Vector3d> pixels_of(Browser& browser, const test::View& view) {
  const json drawn = browser.evaluate(fmt::format(R"((() => {{ {}
    page.draw();
    const gl = page.renderer.gl, width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return {{ width, height, pixels: pack(pixels) }};
  }})())",
                                                  test::kPack));
  EXPECT_EQ(drawn["width"], view.width);
  EXPECT_EQ(drawn["height"], view.height);
  const Bytes bytes = test::bytes_of_base64(drawn["pixels"]);
  std::vector<Eigen::Vector3d> pixels;
  for (int row = view.height - 1; row >= 0; --row)
    for (int column = 0; column < view.width; ++column) {
      const std::size_t i = 4 * (static_cast<std::size_t>(row) * view.width + column);
      pixels.emplace_back(bytes[i] / 255.0, bytes[i + 1] / 255.0, bytes[i + 2] / 255.0);
    }
  return pixels;
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

// The page's normals: differences of elevations, and at the rims of patches the mean of the triangles around, gaps
// closed.
std::vector<Eigen::Vector3d> page_normals(const ElevationMaps& maps, const Mesh& closed) {
  std::vector<Eigen::Vector3d> normals = sample_points(maps).normals;
  const std::vector<Eigen::Vector3d> of_triangles = vertex_normals(closed);
  for (const BoundaryEdge& edge : boundary_edges(canonical_mesh(maps)))
    for (const std::uint32_t vertex : {edge.from, edge.to}) normals[vertex] = of_triangles[vertex];
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

class VisitorTest : public test::PageTest {
 protected:
  static std::string page() {
    static const std::string html = web_page("A <ring>", ring_stream("contexts"));
    return html;
  }
  static json camera(Browser& browser) {
    return browser.evaluate("[page.camera.azimuth, page.camera.elevation, page.camera.distance]");
  }
  // The same page with a script before its own.
  static std::string with_script(const std::string& script) {
    const std::string head = "<head>";
    std::string html = page();
    return html.replace(html.find(head), head.size(), head + "<script>" + script + "</script>");
  }
  // The same page with other bytes for its model.
  static std::string with_stream(const std::string& base64) {
    const std::string start = "octet-stream;base64\">";
    std::string html = page();
    const std::size_t begin = html.find(start) + start.size(), end = html.find("</script>", begin);
    return html.replace(begin, end - begin, base64);
  }
};

TEST_F(VisitorTest, SaysWhatItShowsAndAsksTheNetworkForNothing) {
  const Bytes stream = ring_stream("contexts");
  const DecodedStream decoded = std::move(read_stream(stream)).value();
  std::size_t samples = 0;
  for (const ElevationPatch& patch : decoded.maps.patches)
    samples += static_cast<std::size_t>(std::count(patch.mask.begin(), patch.mask.end(), 1));
  Browser browser;
  ASSERT_EQ(open(browser, web_page("A <ring>", stream)), "drawn");
  EXPECT_EQ(browser.evaluate("document.title"), "A <ring>");
  EXPECT_EQ(browser.evaluate("document.querySelector('h1').textContent"), "A <ring>");
  const std::string facts = browser.evaluate("document.getElementById('facts').textContent.replaceAll(',', '')");
  EXPECT_EQ(facts.find(fmt::format("{} samples in {} bytes", samples, stream.size())), 0U) << facts;
  EXPECT_EQ(browser.evaluate("page.model.samples"), samples);
  for (const std::string& address : browser.addresses_asked_for())
    EXPECT_TRUE(address.starts_with("file:") || address.starts_with("blob:")) << address;
  EXPECT_THROW(browser.evaluate("fetch('http://127.0.0.1:9/')"), std::runtime_error);
}

TEST_F(VisitorTest, IsTurnedByMouseKeysAndFingers) {
  Browser browser;
  ASSERT_EQ(open(browser, page(), "#azimuth=10&elevation=20&distance=2"), "drawn");
  EXPECT_EQ(camera(browser), json({10, 20, 2}));
  const auto mouse = [&](const char* type, int x, int y) {
    browser.call("Input.dispatchMouseEvent",
                 {{"type", type}, {"x", x}, {"y", y}, {"button", "left"}, {"buttons", 1}, {"clickCount", 1}});
  };
  mouse("mousePressed", 200, 150);
  mouse("mouseMoved", 240, 130);
  mouse("mouseReleased", 240, 130);
  // The surface follows the hand: to the right the eye goes left, upwards it goes down.
  EXPECT_NEAR(camera(browser)[0].get<double>(), 10 - 14, 1e-9);
  EXPECT_NEAR(camera(browser)[1].get<double>(), 20 - 7, 1e-9);

  browser.call("Input.dispatchMouseEvent",
               {{"type", "mouseWheel"}, {"x", 200}, {"y", 150}, {"deltaX", 0}, {"deltaY", -100}});
  const double nearer = camera(browser)[2];
  EXPECT_LT(nearer, 2);

  const auto touch = [&](const char* type, const json& points) {
    browser.call("Input.dispatchTouchEvent", {{"type", type}, {"touchPoints", points}});
  };
  const auto fingers = [](int from, int to) {
    return json{{{"x", from}, {"y", 150}, {"id", 1}}, {{"x", to}, {"y", 150}, {"id", 2}}};
  };
  browser.call("Emulation.setTouchEmulationEnabled", {{"enabled", true}, {"maxTouchPoints", 2}});
  touch("touchStart", fingers(180, 220));
  touch("touchMove", fingers(160, 240));
  touch("touchEnd", json::array());
  EXPECT_NEAR(camera(browser)[2].get<double>(), nearer / 2, 0.02);

  const auto key = [&](const char* name) {
    browser.call("Input.dispatchKeyEvent", {{"type", "keyDown"}, {"key", name}});
  };
  browser.evaluate("page.canvas.focus()");
  const double azimuth = camera(browser)[0];
  key("ArrowRight");
  EXPECT_NEAR(camera(browser)[0].get<double>(), azimuth + 5, 1e-9);
  for (int i = 0; i < 40; ++i) key("ArrowUp");
  EXPECT_EQ(camera(browser)[1], 89);
  key("0");
  EXPECT_EQ(camera(browser), json({10, 20, 2}));
}

TEST_F(VisitorTest, StartsFartherOffInANarrowView) {
  Browser browser;
  ASSERT_EQ(open(browser, page(), "", 600, 400), "drawn");
  EXPECT_EQ(camera(browser), json({30, 15, 2}));
  ASSERT_EQ(open(browser, page(), "", 300, 600), "drawn");
  EXPECT_NEAR(camera(browser)[2].get<double>(), 3.2, 1e-9);
  browser.open("about:blank", 10, 10);
  ASSERT_EQ(open(browser, page(), "#distance=2.5", 300, 600), "drawn");
  EXPECT_EQ(camera(browser), json({30, 15, 2.5}));
}

TEST_F(VisitorTest, DamagedModelsAreNamedAsSuch) {
  const std::string whole = test::base64_of(ring_stream("contexts"));
  std::string changed = whole;
  changed[changed.size() / 2] = changed[changed.size() / 2] == 'A' ? 'B' : 'A';
  Browser browser;
  for (const std::string& stream :
       {std::string(), std::string("no base64, surely"), changed, whole.substr(0, whole.size() / 8 * 4)}) {
    const std::string message = open(browser, with_stream(stream));
    EXPECT_EQ(message.find("The model is damaged"), 0U) << message;
    browser.open("about:blank", 10, 10);
  }
  // A page that was cut on its way.
  const std::string html = page();
  EXPECT_EQ(open(browser, html.substr(0, html.size() - 500)).find("The model is damaged"), 0U);
}

TEST_F(VisitorTest, WithoutWebGlItSaysSo) {
  Browser browser({"--disable-3d-apis"});
  const std::string message = open(browser, page());
  EXPECT_NE(message.find("WebGL 2"), std::string::npos) << message;
}

TEST_F(VisitorTest, DecodesInAWorkerAndSaysHowFarItIs) {
  Browser browser;
  ASSERT_EQ(open(browser, with_script(R"(
    window.Worker = class extends Worker {
      constructor(address) {
        super(address);
        window.messages = [];
        this.addEventListener("message", ({ data }) => window.messages.push(data));
      }
    };)")),
            "drawn");
  const json names = browser.evaluate("messages.map((message) => Object.keys(message)[0])");
  ASSERT_GE(names.size(), 5U);
  EXPECT_EQ(names[names.size() - 2], "model");
  EXPECT_EQ(names[names.size() - 1], "gaps");
  const json progress = browser.evaluate("messages.map((message) => message.progress).filter((done) => done >= 0)");
  EXPECT_EQ(progress.size(), names.size() - 2);
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_EQ(progress.back(), 1);
}

TEST_F(VisitorTest, WithoutWorkersItDecodesByItself) {
  Browser browser;
  EXPECT_EQ(open(browser, with_script("delete window.Worker;")), "drawn");
}

TEST_F(VisitorTest, DrawsAgainWhenTheGraphicsCardWasLost) {
  const test::View view{30, 15, 2, 200, 200};
  Browser browser;
  ASSERT_EQ(open(browser, page(), "", view.width, view.height), "drawn");
  const auto before = pixels_of(browser, view);
  browser.evaluate(R"((async () => {
    const gl = page.renderer.gl, loss = gl.getExtension("WEBGL_lose_context");
    const happens = (name) => new Promise((resolve) => page.canvas.addEventListener(name, () => setTimeout(resolve)));
    const lost = happens("webglcontextlost");
    loss.loseContext();
    await lost;
    const restored = happens("webglcontextrestored");
    loss.restoreContext();
    await restored;
  })())");
  EXPECT_EQ(pixels_of(browser, view), before);
}

}  // namespace
}  // namespace emap
