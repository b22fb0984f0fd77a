// The page's decoder against libemap/coding, in the browser: masks and elevations are the same to the last bit.

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>

#include "tests/libemap/page/opened_page.h"
#include "tests/support/random32.h"
#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {

using Bytes = std::vector<std::uint8_t>;
using nlohmann::json;

// For each of `streams`: the message of the error, or header, planes, masks and elevations.
constexpr const char* kDecodeAll = R"(
  streams.map((text) => {
    try {
      const { header, patches } = decode_stream(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)));
      return {
        header: pack(Float64Array.of(header.diagonal, header.spacing, header.step)),
        patches: patches.map((patch) => ({
          size: [patch.columns, patch.rows],
          plane: [...patch.origin, ...patch.axis_u, ...patch.axis_v, ...patch.normal],
          mask: pack(patch.mask),
          elevation: pack(patch.elevation),
        })),
      };
    } catch (error) {
      return { error: error.message, expected: error instanceof StreamError };
    }
  })
)";

// In a bounding box of sides of all lengths: those of a cube would hide in which order the diagonal's squares are
// added.
Bytes synthetic_stream(const std::string& coder, unsigned seed, std::uint32_t scale, double step) {
  auto synthetic = test::synthetic_maps(seed, scale);
  test::Random32 random(seed);
  std::uniform_real_distribution<double> octaves(-14, 2);
  for (double& side : synthetic.frame.box.maximum) side = std::exp2(octaves(random));
  synthetic.frame.box.minimum = -synthetic.frame.box.maximum;
  synthetic.frame = stream_frame(synthetic.frame.box, synthetic.frame.samples_per_diagonal);
  synthetic.maps.diagonal = synthetic.frame.box.diagonal();
  synthetic.maps.spacing = synthetic.frame.spacing();
  return StreamWriter(*find_elevation_coder(coder), synthetic.frame, synthetic.planes, synthetic.maps, false)
      .write(step);
}

std::uint32_t damaged_streams() {
  const char* wanted = std::getenv("EMAP_DAMAGED_STREAMS");
  return wanted ? static_cast<std::uint32_t>(std::atoi(wanted)) : 60;
}

template <class Number>
Bytes bytes_of(const std::vector<Number>& numbers) {
  Bytes bytes(numbers.size() * sizeof(Number));
  if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

class DecoderTest : public test::PageTest, public testing::WithParamInterface<std::string> {
 protected:
  json decode_in_browser(const std::vector<Bytes>& streams) {
    json texts = json::array();
    for (const Bytes& stream : streams) texts.push_back(test::base64_of(stream));
    test::Browser browser;
    EXPECT_EQ(open(browser, web_page("model", synthetic_stream("contexts", 1, 1, 0.01))), "drawn");
    return browser.evaluate("(() => {" + std::string(test::kPack) + "const streams = " + texts.dump() + "; return (" +
                            kDecodeAll + ");})()");
  }
};

void expect_same(const DecodedStream& expected, const json& found) {
  ASSERT_TRUE(found.contains("patches")) << found.dump();
  const StreamHeader& header = expected.header;
  EXPECT_EQ(test::bytes_of_base64(found["header"]),
            bytes_of(std::vector<double>{header.frame.box.diagonal(), header.frame.spacing(), header.step()}));
  ASSERT_EQ(found["patches"].size(), expected.maps.patches.size());
  for (std::size_t i = 0; i < expected.maps.patches.size(); ++i) {
    const ElevationPatch& patch = expected.maps.patches[i];
    const json& other = found["patches"][i];
    ASSERT_EQ(other["size"], json({patch.columns, patch.rows}));
    EXPECT_EQ(test::bytes_of_base64(other["mask"]), patch.mask) << "patch " << i;
    EXPECT_EQ(test::bytes_of_base64(other["elevation"]), bytes_of(patch.elevation)) << "patch " << i;
    // Sines and cosines of the axes may differ in their last bits.
    std::size_t number = 0;
    const BasePlane& plane = patch.plane;
    for (const auto& vector : {plane.origin, plane.axis_u, plane.axis_v, plane.normal})
      for (const double x : vector)
        EXPECT_NEAR(other["plane"][number++].get<double>(), x, 1e-14 * std::max(1.0, header.frame.box.diagonal()));
  }
}

TEST_P(DecoderTest, DecodesEveryBitAlike) {
  std::vector<Bytes> streams;
  for (unsigned seed = 1; seed <= 6; ++seed)
    for (const double step : {0.3, 0.01, 1e-6}) streams.push_back(synthetic_stream(GetParam(), seed, 1, step));
  streams.push_back(synthetic_stream(GetParam(), 7, 5, 0.002));
  const json found = decode_in_browser(streams);
  ASSERT_EQ(found.size(), streams.size());
  for (std::size_t i = 0; i < streams.size(); ++i) {
    SCOPED_TRACE("stream " + std::to_string(i));
    const auto expected = read_stream(streams[i]);
    ASSERT_TRUE(expected.ok());
    expect_same(*expected, found[i]);
  }
}

// Where the program refuses a damaged stream, so does the page; where it can't know, both decode the same.
// EMAP_DAMAGED_STREAMS says how many are tried (default 60).
TEST_P(DecoderTest, TakesDamagedStreamsAlike) {
  const Bytes whole = synthetic_stream(GetParam(), 1, 1, 0.003);
  test::Random32 random(5);
  std::vector<Bytes> streams;
  for (std::uint32_t i = 0; i < damaged_streams(); ++i) {
    Bytes changed = whole;
    changed[random() % (i % 2 ? changed.size() : 90)] ^= static_cast<std::uint8_t>(1U << random() % 8);
    if (i % 3 == 0) changed.resize(random() % changed.size());
    if (i % 4 == 0) {  // noise behind a good header
      changed.assign(whole.begin(), whole.begin() + 38);
      for (std::uint32_t count = random() % 3000; count > 0; --count)
        changed.push_back(static_cast<std::uint8_t>(random()));
    }
    if (i % 5 != 0 && changed.size() > 40) set_stream_check(changed);
    streams.push_back(changed);
  }
  const json found = decode_in_browser(streams);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    SCOPED_TRACE("stream " + std::to_string(i));
    const auto expected = read_stream(streams[i]);
    if (expected) {
      expect_same(*expected, found[i]);
      continue;
    }
    ++refused;
    ASSERT_TRUE(found[i].contains("error")) << expected.error().message;
    EXPECT_TRUE(found[i]["expected"].get<bool>()) << found[i]["error"];
  }
  EXPECT_GT(refused, streams.size() / 3);
  EXPECT_LT(refused, streams.size());
}

TEST_P(DecoderTest, AnotherVersionOrCoderIsRefusedByName) {
  Bytes newer = synthetic_stream(GetParam(), 1, 1, 0.01), older = newer, unknown = newer;
  newer[4] = kStreamVersion + 1;
  older[4] = kStreamVersion - 1;
  unknown[5] = 77;
  for (Bytes* stream : {&newer, &older, &unknown}) set_stream_check(*stream);
  const json found = decode_in_browser({newer, older, unknown});
  EXPECT_NE(found[0]["error"].get<std::string>().find("version 3"), std::string::npos);
  EXPECT_NE(found[1]["error"].get<std::string>().find("version 1"), std::string::npos);
  EXPECT_NE(found[2]["error"].get<std::string>().find("number 77"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Coders, DecoderTest, testing::Values("baseline", "contexts"));

}  // namespace
}  // namespace emap
