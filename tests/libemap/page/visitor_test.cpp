// The page as a visitor has it: how it is turned, what it says, what it does without what it wants.

#include <fmt/format.h>

#include <algorithm>

#include "tests/libemap/page/opened_page.h"
#include "tests/libemap/page/ring_model.h"

namespace emap {
namespace {

using Bytes = std::vector<std::uint8_t>;
using nlohmann::json;
using test::Browser;
using test::pixels_of;
using test::ring_stream;

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
