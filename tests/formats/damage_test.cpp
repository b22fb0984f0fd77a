// Damaged files: nothing crashes, everything that is returned is sound. Under the sanitizers these tests look deeper.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "libthin/formats/bufr_file.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/tank_writer.h"

namespace thin {
namespace {

using test::ByteVector;
using test::make_message;
using test::MessageShape;
using test::test_soundings;

// What holds of anything that was read, however bad the bytes.
void expect_sound(const Result<ReadObservations>& contents, const std::string& trace) {
  if (!contents) {
    EXPECT_FALSE(contents.error().message.empty()) << trace;
    EXPECT_TRUE(contents.error().kind == ErrorKind::input || contents.error().kind == ErrorKind::incomplete) << trace;
    return;
  }
  const ObservationSet& set = contents->observations;
  EXPECT_GT(set.size(), 0U) << trace;
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_TRUE(std::abs(set.latitude_deg[i]) <= 90 && set.longitude_deg[i] >= -180 && set.longitude_deg[i] <= 360);
    EXPECT_LT(set.source[i].message, contents->message_count) << trace;
    for (const double value_k : set.values_of(i))
      EXPECT_TRUE(std::isnan(value_k) || (value_k >= 0 && value_k < 1000)) << trace << " " << value_k;
  }
}

std::vector<ByteVector> files() {
  const ByteVector compressed = make_message(test_soundings(12));
  const ByteVector uncompressed = make_message(test_soundings(3), {.compressed = false});
  const ByteVector long_form =
      make_message(test_soundings(5), {.edition = 3, .descriptors = {310008}, .slots_per_subset = 19});
  const ByteVector local = make_message(test_soundings(6), {.ecmwf_section2 = true});
  const test::TankShape shape = {.channels = 3, .counted_channels = true};
  const ByteVector tank =
      test::joined({tank_table_message(tank_tables(shape)), tank_data_message(test::tank_soundings(9, shape), shape)});
  return {compressed, uncompressed,
          long_form,  local,
          tank,       test::joined({test::bulletin(compressed), test::bytes_of("junk"), test::bulletin(uncompressed)})};
}

TEST(Damage, CutAtEveryByte) {
  for (const ByteVector& file : files())
    for (std::size_t length = 1; length < file.size(); ++length) {
      const auto contents = read_bufr(std::span(file).first(length), "cut");
      expect_sound(contents, "cut at " + std::to_string(length));
    }
}

TEST(Damage, AFileOfOneMessageCutAnywhereIsIncomplete) {
  const ByteVector file = make_message(test_soundings(3));
  for (std::size_t length = 1; length < file.size(); ++length) {
    const auto contents = read_bufr(std::span(file).first(length), "cut");
    ASSERT_FALSE(contents.ok());
    EXPECT_EQ(contents.error().kind, ErrorKind::incomplete) << length;
  }
}

TEST(Damage, BitsTurned) {
  std::mt19937 random(1);
  for (const ByteVector& file : files())
    for (int round = 0; round < 400; ++round) {
      ByteVector changed = file;
      for (std::size_t count = 1 + random() % 4; count > 0; --count) {
        // The headers of sections are where a turned bit does most harm.
        const std::size_t place =
            random() % (random() % 2 ? changed.size() : std::min<std::size_t>(120, changed.size()));
        changed[place] ^= static_cast<std::uint8_t>(1U << random() % 8);
      }
      expect_sound(read_bufr(changed, "changed"), "round " + std::to_string(round));
    }
}

TEST(Damage, BytesRemovedOrRepeated) {
  std::mt19937 random(2);
  for (const ByteVector& file : files())
    for (int round = 0; round < 100; ++round) {
      ByteVector changed = file;
      const auto begin = changed.begin() + static_cast<std::ptrdiff_t>(random() % changed.size());
      const auto end = begin + static_cast<std::ptrdiff_t>(std::min<std::size_t>(
                                   random() % 20, static_cast<std::size_t>(changed.end() - begin)));
      if (round % 2) {
        const ByteVector piece(begin, end);
        changed.insert(begin, piece.begin(), piece.end());
      } else {
        changed.erase(begin, end);
      }
      expect_sound(read_bufr(changed, "changed"), "round " + std::to_string(round));
    }
}

TEST(Damage, AnyBytes) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    ByteVector bytes(random() % 400);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    expect_sound(read_bufr(test::joined({test::bytes_of("BUFR"), bytes}), "anything"),
                 "round " + std::to_string(round));
  }
}

}  // namespace
}  // namespace thin
