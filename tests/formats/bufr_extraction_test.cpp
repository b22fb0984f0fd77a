#include "libthin/formats/bufr_extraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "libthin/formats/bufr_scanner.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/extraction_checks.h"
#include "tests/support/soundings_equal.h"

namespace thin {
namespace {

using test::bulletin;
using test::bytes_of;
using test::ByteVector;
using test::joined;
using test::make_message;
using test::MessageShape;
using test::ScratchFolder;
using test::test_soundings;
using test::TestSounding;

std::vector<SourceReference> references(std::uint32_t message, const std::vector<std::uint32_t>& subsets) {
  std::vector<SourceReference> list;
  for (const std::uint32_t subset : subsets) list.push_back({0, message, subset});
  return list;
}

ByteVector avhrr_message() {
  std::vector<TestSounding> soundings = test_soundings(3);
  for (TestSounding& sounding : soundings) sounding.sensor = 5;
  return make_message(soundings);
}

// What extraction makes of `file`; empty where it makes none.
ByteVector extracted(const ByteVector& file, const std::vector<SourceReference>& retained,
                     const OutputOptions& options = {}) {
  const ScratchFolder folder;
  const auto summary = extract_observations(folder.write("in", file), retained, folder.path("out"), options);
  EXPECT_TRUE(summary.ok()) << summary.error().message;
  const ByteVector written = test::read_bytes(folder.path("out"));
  EXPECT_EQ(summary->bytes, written.size());
  EXPECT_EQ(summary->subsets, retained.size());
  EXPECT_EQ(std::filesystem::exists(folder.path("out")), summary->messages > 0);
  return written;
}

class ExtractionShapes : public testing::TestWithParam<MessageShape> {};

TEST_P(ExtractionShapes, KeepEveryKeyOfEveryRetainedSubset) {
  const ScratchFolder folder;
  std::vector<TestSounding> soundings = test_soundings(40);
  soundings[3].slots[2].second = soundings[9].latitude_deg = test::kMissingValue;
  for (TestSounding& s : soundings) s.slots[7].second = test::kMissingValue;
  const ByteVector message = make_message(soundings, GetParam());
  const std::string path = folder.write("in", joined({message, message, message}));
  test::expect_extractions_keep_everything(path, 1);
}

INSTANTIATE_TEST_SUITE_P(Bufr, ExtractionShapes,
                         testing::Values(MessageShape{}, MessageShape{.compressed = false}, MessageShape{.edition = 3},
                                         MessageShape{.edition = 3, .compressed = false},
                                         MessageShape{.descriptors = {310008}, .slots_per_subset = 19},
                                         MessageShape{.descriptors = {310009, 33007, 12063}, .temperatures_behind = 1},
                                         MessageShape{.ecmwf_section2 = true}));

// Operators of table C in front of the sequence: where one of them is taken wrongly, nothing behind it is right.
class Operators : public testing::TestWithParam<std::vector<long>> {};

TEST_P(Operators, ChangeNothingBehindThem) {
  MessageShape shape;
  shape.descriptors = GetParam();
  shape.descriptors.push_back(310009);
  for (const bool compressed : {true, false}) {
    shape.compressed = compressed;
    if (compressed && GetParam().front() / 1000 == 203) continue;  // ecCodes can't
    const ScratchFolder folder;
    const std::string path = folder.write("in", make_message(test_soundings(12), shape));
    const auto contents = read_observations(path);
    ASSERT_TRUE(contents.ok()) << contents.error().message;
    test::expect_equal_to_oracle(contents->observations, test::decode_file_slowly(path));
    test::expect_extractions_keep_everything(path, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Bufr, Operators,
                         testing::Values(std::vector<long>{201135, 202130, 12101, 202000, 201000},  // width, scale
                                         std::vector<long>{203012, 10004, 203255, 10004, 203000},   // references
                                         std::vector<long>{204007, 31021, 12101, 204000},           // associated fields
                                         std::vector<long>{205004},                      // characters in line
                                         std::vector<long>{206009, 63250},               // unknown local element
                                         std::vector<long>{207002, 12101, 207000},       // all of scale
                                         std::vector<long>{208003, 1015, 208000, 1015},  // characters
                                         std::vector<long>{102002, 12101, 10004},        // repeated
                                         std::vector<long>{101000, 31001, 12101}));      // as often as data say

TEST(BufrExtraction, AllRetainedIsByteForByte) {
  const ByteVector message = make_message(test_soundings(5));
  EXPECT_EQ(extracted(joined({message, bytes_of("stray"), message}), references(1, {4, 2, 0, 1, 3})), message);
}

TEST(BufrExtraction, NothingRetainedMakesNoFile) {
  EXPECT_TRUE(extracted(make_message(test_soundings(5)), {}).empty());
  EXPECT_TRUE(extracted(bulletin(make_message(test_soundings(5))), {}).empty());
}

TEST(BufrExtraction, OrderOfReferencesDoesNotMatter) {
  const ByteVector file = make_message(test_soundings(9));
  EXPECT_EQ(extracted(file, references(0, {7, 1, 4})), extracted(file, references(0, {1, 4, 7})));
}

TEST(BufrExtraction, EnvelopesStayWithTheirLengthMadeRight) {
  const ByteVector message = make_message(test_soundings(9));
  const std::vector<SourceReference> retained = references(0, {1, 4, 7});
  const ByteVector bare = extracted(message, retained);
  ASSERT_LT(bare.size(), message.size());
  for (const int format : {0, 1}) {
    EXPECT_EQ(extracted(bulletin(message, format), retained), bulletin(bare, format));
    EXPECT_EQ(extracted(bulletin(message, format), retained, {.gts_headers = OutputOptions::GtsHeaders::drop}), bare);
  }
}

TEST(BufrExtraction, ABulletinOfSeveralMessagesStaysOne) {
  const ByteVector message = make_message(test_soundings(9));
  const ByteVector bare = extracted(message, references(0, {2}));
  const ByteVector file = joined({bulletin(joined({message, message, message})), bytes_of("0000000000")});
  EXPECT_EQ(extracted(file, references(1, {2})), joined({bulletin(bare), bytes_of("0000000000")}));
  EXPECT_TRUE(extracted(file, {}).empty());
}

TEST(BufrExtraction, OtherKindsStayOrLeave) {
  const ByteVector amsua = make_message(test_soundings(4)), other = avhrr_message();
  const ByteVector file = joined({other, bytes_of("junk"), amsua, bulletin(other)});
  const std::vector<SourceReference> all = references(1, {0, 1, 2, 3});
  EXPECT_EQ(extracted(file, all), joined({other, amsua, bulletin(other)}));
  EXPECT_EQ(extracted(file, all, {.other_messages = OutputOptions::OtherMessages::drop}), amsua);
  EXPECT_EQ(extracted(file, {}), joined({other, bulletin(other)}));
}

// A message that says it is AMSU-A, in which ecCodes finds too few bits.
TEST(BufrExtraction, WhatCannotBeDecodedLeaves) {
  const ByteVector amsua = make_message(test_soundings(4), {.compressed = false});
  ByteVector short_of_bits = amsua;
  short_of_bits[8 + 22 + 4] = 0x40;  // 16,388 subsets
  const ScratchFolder folder;
  const auto contents = read_observations(folder.write("file", joined({short_of_bits, amsua})));
  ASSERT_TRUE(contents.ok());
  EXPECT_EQ(contents->observations.size(), 4U);
  ASSERT_EQ(contents->skipped.size(), 1U);
  EXPECT_EQ(extracted(joined({short_of_bits, amsua}), references(1, {0, 1, 2, 3})), amsua);
}

TEST(BufrExtraction, SectionTwoOfEcmwfCountsAnew) {
  const MessageShape shape = {.ecmwf_section2 = true};
  for (const int count : {9, 300}) {
    const ByteVector message = make_message(test_soundings(count), shape);
    const ScratchFolder folder;
    folder.write("out", extracted(message, references(0, {1, 4})));
    const auto decoded = test::decode_file_slowly(folder.path("out"));
    ASSERT_EQ(decoded.size(), 1U);
    EXPECT_EQ(std::stod(decoded[0].header.at("localNumberOfObservations")), 2) << count;
    const auto before = test::decode_file_slowly(folder.write("in", message));
    EXPECT_EQ(decoded[0].header.at("satelliteID"), before[0].header.at("satelliteID")) << count;
  }
}

TEST(BufrExtraction, AReferenceThatIsNotThereIsAnError) {
  const ScratchFolder folder;
  const std::string path = folder.write("in", make_message(test_soundings(4)));
  for (const SourceReference& wrong : {SourceReference{0, 0, 4}, SourceReference{0, 1, 0}}) {
    const auto summary = extract_observations(path, std::vector{wrong}, folder.path("out"), {});
    ASSERT_FALSE(summary.ok());
    EXPECT_EQ(summary.error().kind, ErrorKind::input);
    EXPECT_FALSE(std::filesystem::exists(folder.path("out")));
  }
}

TEST(BufrExtraction, ADiskThatIsFullIsTemporary) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const ScratchFolder folder;
  const std::string path = folder.write("in", make_message(test_soundings(4)));
  const auto summary = extract_observations(path, references(0, {1}), "/dev/full", {});
  ASSERT_FALSE(summary.ok());
  EXPECT_EQ(summary.error().kind, ErrorKind::temporary);
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

TEST(BufrExtraction, OptionsAreDeclared) {
  OutputOptions options;
  OptionTable table;
  options.declare(table);
  ASSERT_TRUE(table.find("gts_headers"));
  ASSERT_TRUE(table.find("other_messages"));
  EXPECT_FALSE(table.find("gts_headers")->assign(std::string("drop")));
  EXPECT_EQ(options.gts_headers, OutputOptions::GtsHeaders::drop);
}

}  // namespace
}  // namespace thin
