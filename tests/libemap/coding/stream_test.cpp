#include "libemap/coding/stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {

std::vector<std::uint8_t> stream_of(const test::SyntheticMaps& synthetic, const ElevationCoder& coder, double step) {
  return StreamWriter(coder, synthetic.frame, synthetic.planes, synthetic.maps, false).write(step);
}

class StreamTest : public testing::TestWithParam<std::string> {
 protected:
  const ElevationCoder& coder() const { return *find_elevation_coder(GetParam()); }
};

TEST_P(StreamTest, PlanesAndMasksComeBackAsTheyWere) {
  const auto synthetic = test::synthetic_maps(1);
  const auto decoded = read_stream(stream_of(synthetic, coder(), 0.01));
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  ASSERT_EQ(decoded->maps.patches.size(), synthetic.maps.patches.size());
  for (std::size_t i = 0; i < synthetic.maps.patches.size(); ++i) {
    const ElevationPatch& before = synthetic.maps.patches[i];
    const ElevationPatch& after = decoded->maps.patches[i];
    EXPECT_EQ(after.plane.origin, before.plane.origin);
    EXPECT_EQ(after.plane.axis_u, before.plane.axis_u);
  }
  const StreamParts& parts = decoded->parts;
  EXPECT_EQ(parts.header + parts.planes + parts.masks + parts.elevations, stream_of(synthetic, coder(), 0.01).size());
}

TEST_P(StreamTest, FinerStepsCostMoreAndErrLess) {
  const auto synthetic = test::synthetic_maps(2, 2);
  std::size_t last_bytes = 0;
  for (const double step : {0.1, 0.03, 0.01, 0.001, 0.0001}) {
    const auto bytes = stream_of(synthetic, coder(), step);
    EXPECT_GE(bytes.size(), last_bytes);
    last_bytes = bytes.size();
  }
}

TEST_P(StreamTest, TheSameBytesEveryTime) {
  const auto synthetic = test::synthetic_maps(3);
  std::vector<std::vector<std::uint8_t>> streams;
  for (int time = 0; time < 2; ++time) {
    StreamWriter writer(coder(), synthetic.frame, synthetic.planes, synthetic.maps, true);
    for (const double step : {0.01, 0.5, 0.01}) streams.push_back(writer.write(step));
  }
  EXPECT_TRUE(std::equal(streams.begin(), streams.begin() + 3, streams.begin() + 3));
}

TEST_P(StreamTest, CutAnywhereIsAnError) {
  const auto bytes = stream_of(test::synthetic_maps(4), coder(), 0.01);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const auto decoded = read_stream(std::span(bytes).first(length));
    ASSERT_FALSE(decoded.ok()) << length;
    EXPECT_FALSE(decoded.error().message.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Coders, StreamTest, testing::Values("baseline", "contexts"));

TEST(Stream, BaselineErrsByTheStepAtMost) {
  const auto synthetic = test::synthetic_maps(5, 2);
  for (const double step : {0.01, 0.001, 0.00001}) {
    const auto decoded = read_stream(stream_of(synthetic, *find_elevation_coder("baseline"), step));
    ASSERT_TRUE(decoded.ok());
    double squared = 0, count = 0;
    for (std::size_t i = 0; i < synthetic.maps.patches.size(); ++i) {
      const ElevationPatch& before = synthetic.maps.patches[i];
      const ElevationPatch& after = decoded->maps.patches[i];
      ASSERT_EQ(after.mask, before.mask);
      for (std::size_t k = 0; k < before.mask.size(); ++k) {
        squared += std::pow(before.elevation[k] - after.elevation[k], 2);
        count += before.mask[k];
      }
    }
    EXPECT_LT(std::sqrt(squared / count), 0.6 * step) << step;
    EXPECT_GT(std::sqrt(squared / count), 0.02 * step) << step;
  }
}

TEST(Stream, StepCodesAreWithinAPercentOfTheStep) {
  for (const double step : {1.0, 0.37, 0.001, 1e-6}) {
    StreamHeader header;
    header.frame.box = {{0, 0, 0}, {1, 2, 2}};
    header.step_code = step_code_of(step, 3);
    EXPECT_NEAR(header.step() / step, 1, 0.01);
  }
}

TEST(Stream, OtherFilesAreRefusedWithASentence) {
  EXPECT_NE(read_stream({}).error().message.find("EMAP"), std::string::npos);
  auto bytes = stream_of(test::synthetic_maps(6), elevation_coders().front(), 0.1);
  bytes[4] = 9;
  EXPECT_NE(read_stream(bytes).error().message.find("version 9"), std::string::npos);
  bytes[4] = 1;
  EXPECT_NE(read_stream(bytes).error().message.find("encode the surface again"), std::string::npos);
  bytes[4] = kStreamVersion;
  bytes[5] = 77;
  set_stream_check(bytes);
  EXPECT_NE(read_stream(bytes).error().message.find("coder number 77"), std::string::npos);
}

}  // namespace
}  // namespace emap
