// Damaged streams: nothing crashes, whatever is decoded is sound. The check of the bytes is put right after each
// change, so that the decoder behind it is what is tested. EMAP_DAMAGED_STREAMS says how many of each kind (default 60;
// 1000 for a release, under the sanitizers: scripts/fuzz-emap).

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "libemap/coding/stream.h"
#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "tests/support/random32.h"
#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::uint32_t streams_of_each_kind() {
  const char* wanted = std::getenv("EMAP_DAMAGED_STREAMS");
  return wanted ? static_cast<std::uint32_t>(std::atoi(wanted)) : 60;
}

void expect_sound(const Bytes& bytes, const std::string& trace) {
  const auto decoded = read_stream(bytes);
  if (!decoded) {
    EXPECT_FALSE(decoded.error().message.empty()) << trace;
    EXPECT_TRUE(decoded.error().kind == thin::ErrorKind::input || decoded.error().kind == thin::ErrorKind::incomplete);
    return;
  }
  std::uint64_t spanned = 0;
  for (const ElevationPatch& patch : decoded->maps.patches) {
    ASSERT_EQ(patch.mask.size(), std::size_t{patch.columns} * patch.rows) << trace;
    ASSERT_EQ(patch.elevation.size(), patch.mask.size()) << trace;
    spanned += patch.mask.size();
    for (std::size_t i = 0; i < patch.mask.size(); ++i)
      ASSERT_TRUE(std::isfinite(patch.elevation[i]) && (patch.mask[i] || patch.elevation[i] == 0)) << trace;
  }
  EXPECT_LE(spanned, most_samples_spanned(bytes.size()));
  const PointSet points = sample_points(decoded->maps);
  // Closing the gaps of noise is slow: one in ten.
  static std::uint32_t decoded_streams = 0;
  if (decoded_streams++ % 10 == 0 && spanned < 20000) closed_mesh(decoded->maps);
}

class DamageTest : public testing::TestWithParam<std::string> {
 protected:
  static Bytes stream() {
    const auto synthetic = test::synthetic_maps(1);
    return StreamWriter(*find_elevation_coder(GetParam()), synthetic.frame, synthetic.planes, synthetic.maps, false)
        .write(0.003);
  }
};

TEST_P(DamageTest, Cut) {
  const Bytes whole = stream();
  test::Random32 random(1);
  for (std::uint32_t i = 0; i < streams_of_each_kind(); ++i) {
    Bytes cut(whole.begin(), whole.begin() + random() % whole.size());
    expect_sound(cut, "cut at " + std::to_string(cut.size()));
    if (cut.size() < 40) continue;
    set_stream_check(cut);
    expect_sound(cut, "cut at " + std::to_string(cut.size()) + ", check put right");
  }
}

TEST_P(DamageTest, BitsTurned) {
  const Bytes whole = stream();
  test::Random32 random(2);
  for (std::uint32_t i = 0; i < streams_of_each_kind(); ++i) {
    Bytes changed = whole;
    // The header and the planes behind it are where a turned bit does most harm.
    for (std::uint32_t count = 1 + random() % 3; count > 0; --count)
      changed[random() % (random() % 2 ? changed.size() : 90)] ^= static_cast<std::uint8_t>(1U << random() % 8);
    expect_sound(changed, "turned, round " + std::to_string(i));
    set_stream_check(changed);
    expect_sound(changed, "turned, check put right, round " + std::to_string(i));
  }
}

TEST_P(DamageTest, NoiseBehindAGoodHeader) {
  const Bytes whole = stream();
  test::Random32 random(3);
  for (std::uint32_t i = 0; i < streams_of_each_kind(); ++i) {
    Bytes noise(whole.begin(), whole.begin() + 38);
    for (std::uint32_t count = random() % 3000; count > 0; --count)
      noise.push_back(static_cast<std::uint8_t>(random()));
    set_stream_check(noise);
    expect_sound(noise, "noise, round " + std::to_string(i));
  }
}

INSTANTIATE_TEST_SUITE_P(Coders, DamageTest, testing::Values("baseline", "contexts"));

}  // namespace
}  // namespace emap
