#include "libthin/formats/staged_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "libthin/formats/bufr_file.h"
#include "tests/support/bufr_messages.h"

namespace thin {
namespace {

using test::ScratchFolder;

// Values that are easily lost: NaN, infinities, the smallest and largest numbers, texts with zeros and without letters.
ReadObservations awkward_contents(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  ReadObservations contents;
  contents.layout = "bufr";
  contents.instrument = "AMSU-A";
  contents.message_count = 4'000'000'000U;
  ObservationSet& set = contents.observations;
  set.channels = {1, 2, 15};
  set.value_kind = ValueKind::innovation;
  for (std::size_t i = 0; i < count; ++i) {
    const ObservationSet::Entry entry = {
        .latitude_deg = -90 + 180 * static_cast<double>(random()) / 18446744073709551615.0,
        .longitude_deg = 359.99,
        .time_ms = static_cast<std::int64_t>(random()),
        .platform = static_cast<std::int32_t>(i) - 1,
        .instrument = i % 2 ? Instrument::mhs : Instrument::atms,
        .scan_line = kUnknownNumber,
        .field_of_view = std::numeric_limits<std::int32_t>::max(),
        .surface = static_cast<Surface>(i % 5),
        .source = {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random()), 0xffffffffU}};
    const double values[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::denorm_min(), -0.0};
    set.push_back(entry, values);
  }
  set.channel_instrument = {Instrument::mhs, Instrument::mhs, Instrument::atms};
  set.first_guess_k = set.values;
  set.variables["MetaData/sensorScanAngle"] = std::vector<double>(count, -0.0);
  set.variables["zenith angle, degrees"] = std::vector<double>(count, std::numeric_limits<double>::quiet_NaN());
  contents.skipped = {{0, 0, ""}, {3, 0xffffffffffULL, "a reason, in two\nlines"}, {4, 5, std::string("a\0b", 3)}};
  return contents;
}

template <class T>
void expect_same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_equal(const ReadObservations& a, const ReadObservations& b) {
  EXPECT_EQ(a.layout, b.layout);
  EXPECT_EQ(a.instrument, b.instrument);
  EXPECT_EQ(a.message_count, b.message_count);
  EXPECT_EQ(a.observations.channels, b.observations.channels);
  EXPECT_EQ(a.observations.value_kind, b.observations.value_kind);
  expect_same_bits(a.observations.latitude_deg, b.observations.latitude_deg);
  expect_same_bits(a.observations.longitude_deg, b.observations.longitude_deg);
  expect_same_bits(a.observations.position_km, b.observations.position_km);
  EXPECT_EQ(a.observations.time_ms, b.observations.time_ms);
  EXPECT_EQ(a.observations.platform, b.observations.platform);
  EXPECT_EQ(a.observations.scan_line, b.observations.scan_line);
  EXPECT_EQ(a.observations.field_of_view, b.observations.field_of_view);
  EXPECT_EQ(a.observations.surface, b.observations.surface);
  expect_same_bits(a.observations.values, b.observations.values);
  expect_same_bits(a.observations.first_guess_k, b.observations.first_guess_k);
  EXPECT_EQ(a.observations.instrument, b.observations.instrument);
  EXPECT_EQ(a.observations.channel_instrument, b.observations.channel_instrument);
  ASSERT_EQ(a.observations.variables.size(), b.observations.variables.size());
  for (const auto& [name, column] : a.observations.variables) {
    ASSERT_TRUE(b.observations.variables.contains(name)) << name;
    expect_same_bits(column, b.observations.variables.at(name));
  }
  EXPECT_EQ(a.observations.source, b.observations.source);
  ASSERT_EQ(a.skipped.size(), b.skipped.size());
  for (std::size_t i = 0; i < a.skipped.size(); ++i) {
    EXPECT_EQ(a.skipped[i].message, b.skipped[i].message);
    EXPECT_EQ(a.skipped[i].offset, b.skipped[i].offset);
    EXPECT_EQ(a.skipped[i].reason, b.skipped[i].reason);
  }
}

TEST(StagedFile, ReadsBackEveryFieldToTheLastBit) {
  const ScratchFolder folder;
  for (const std::size_t count : {0U, 1U, 7U, 3000U}) {
    ReadObservations contents = awkward_contents(count, 3);
    if (count == 1) contents.skipped.clear();
    if (count == 7) contents.skipped = {{1, 2, ""}};
    const std::string path = folder.path("staged.nc");
    const Result<void> written = write_staged(path, contents);
    ASSERT_TRUE(written.ok()) << written.error().message;
    const Result<ReadObservations> read = read_staged(path);
    ASSERT_TRUE(read.ok()) << read.error().message;
    expect_equal(contents, *read);
  }
}

TEST(StagedFile, EqualContentsHaveEqualBytes) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_staged(folder.path("a"), awkward_contents(500, 3)).ok());
  ASSERT_TRUE(write_staged(folder.path("other"), awkward_contents(900, 4)).ok());
  ASSERT_TRUE(write_staged(folder.path("b"), awkward_contents(500, 3)).ok());
  EXPECT_EQ(test::read_bytes(folder.path("a")), test::read_bytes(folder.path("b")));
  EXPECT_NE(test::read_bytes(folder.path("a")), test::read_bytes(folder.path("other")));
}

TEST(StagedFile, RefusesWhatItDidNotWrite) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_staged(folder.path("whole"), awkward_contents(50, 3)).ok());
  test::ByteVector cut = test::read_bytes(folder.path("whole"));
  cut.resize(cut.size() / 3);
  for (const test::ByteVector& bytes : {test::ByteVector{}, test::bytes_of("BUFR"),
                                        test::bytes_of("\x89HDF\r\n\x1a\nxxxx"), test::ByteVector(5000, 0xa5), cut}) {
    const Result<ReadObservations> read = read_staged(folder.write("garbage", bytes));
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().kind, ErrorKind::input);
    EXPECT_NE(read.error().message.find("garbage"), std::string::npos);
  }
}

TEST(StagedFile, ADiskThatIsFullIsTemporary) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const Result<void> written = write_staged("/dev/full", awkward_contents(5, 3));
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().kind, ErrorKind::temporary);
}

}  // namespace
}  // namespace thin
