#include "libthin/formats/bufr_scanner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/bufr_messages.h"

namespace thin {
namespace {

using test::bulletin;
using test::bytes_of;
using test::ByteVector;
using test::joined;

// The smallest message of an edition, with `data` as its data section: what a scanner sees, no more.
ByteVector bare_message(int edition = 4, const ByteVector& data = {}, bool with_section2 = false) {
  ByteVector section1(edition == 4 ? 22 : 18, 0);
  section1[2] = static_cast<std::uint8_t>(section1.size());
  section1[edition == 4 ? 9 : 7] = with_section2 ? 0x80 : 0;
  section1[edition == 4 ? 10 : 8] = 3;
  const ByteVector section2 = with_section2 ? ByteVector{0, 0, 8, 0, 1, 2, 3, 4} : ByteVector{};
  const ByteVector section3 = {0, 0, 10, 0, 0, 5, 0xc0, 0xca, 0x09, 0};  // 5 subsets, compressed, 310009
  ByteVector section4 = joined({{0, 0, 0, 0}, data});
  put_big_endian(section4, 0, 3, static_cast<std::uint32_t>(section4.size()));
  ByteVector message = joined({bytes_of("BUFR"),
                               {0, 0, 0, static_cast<std::uint8_t>(edition)},
                               section1,
                               section2,
                               section3,
                               section4,
                               bytes_of("7777")});
  put_big_endian(message, 4, 3, static_cast<std::uint32_t>(message.size()));
  return message;
}

std::vector<std::size_t> offsets_of(const BufrScan& scan) {
  std::vector<std::size_t> offsets;
  for (const BufrMessage& message : scan.messages) offsets.push_back(message.offset);
  return offsets;
}

TEST(BufrScanner, FindsMessagesOfEveryEditionBackToBack) {
  const ByteVector two = bare_message(2), three = bare_message(3, {1, 2}, true), four = bare_message(4, {9});
  const BufrScan scan = scan_bufr(joined({two, three, four}));
  EXPECT_EQ(offsets_of(scan), (std::vector<std::size_t>{0, two.size(), two.size() + three.size()}));
  EXPECT_EQ(scan.messages[0].header.edition, 2);
  EXPECT_EQ(scan.messages[1].header.edition, 3);
  EXPECT_EQ(scan.messages[1].header.section2_length, 8U);
  EXPECT_EQ(scan.messages[2].length, four.size());
  for (const BufrMessage& message : scan.messages) {
    EXPECT_EQ(message.header.descriptors, std::vector<int>{310009});
    EXPECT_EQ(message.header.subset_count, 5);
    EXPECT_EQ(message.header.data_category, 3);
    EXPECT_TRUE(message.header.compressed);
  }
  EXPECT_TRUE(scan.unused.empty());
  EXPECT_FALSE(scan.cut_offset);
}

TEST(BufrScanner, SkipsStrayBytesAndPadding) {
  const ByteVector message = bare_message();
  const BufrScan scan = scan_bufr(joined({{0, 0, 0}, message, bytes_of("junk"), message, bytes_of("\r\n")}));
  EXPECT_EQ(offsets_of(scan), (std::vector<std::size_t>{3, 7 + message.size()}));
  ASSERT_EQ(scan.unused.size(), 3U);
  EXPECT_TRUE(scan.unused[0].padding);
  EXPECT_FALSE(scan.unused[1].padding);
  EXPECT_EQ(scan.unused[1].offset, 3 + message.size());
  EXPECT_EQ(scan.unused[1].size, 4U);
  EXPECT_EQ(scan.unused[1].message, 1U);
  EXPECT_TRUE(scan.unused[2].padding);
}

TEST(BufrScanner, IsNotFooledByBufrInText) {
  const ByteVector message = bare_message();
  const ByteVector text = bytes_of("BUFR files begin with BUFR and end with 7777, BUFR\x01");
  const BufrScan scan = scan_bufr(joined({text, message, bytes_of(" BUFR! BUFR is over")}));
  EXPECT_EQ(offsets_of(scan), std::vector<std::size_t>{text.size()});
  EXPECT_FALSE(scan.cut_offset);
}

TEST(BufrScanner, IsNotFooledByBufrInData) {
  const ByteVector inner = bare_message(3, bytes_of("inner"));
  const ByteVector outer = bare_message(4, joined({inner, bytes_of("7777BUFR")}));
  const BufrScan scan = scan_bufr(joined({outer, outer}));
  EXPECT_EQ(offsets_of(scan), (std::vector<std::size_t>{0, outer.size()}));
}

// A false header whose length ends at the 7777 of the next message: its sections give it away.
TEST(BufrScanner, IsNotFooledByALengthThatHappensToFit) {
  const ByteVector message = bare_message();
  ByteVector false_header = bytes_of(std::string("BUFR\0\0\0\4\0\0\x12", 11));
  put_big_endian(false_header, 4, 3, static_cast<std::uint32_t>(false_header.size() + message.size()));
  const BufrScan scan = scan_bufr(joined({false_header, message}));
  EXPECT_EQ(offsets_of(scan), std::vector<std::size_t>{false_header.size()});
  ASSERT_EQ(scan.unused.size(), 1U);
  EXPECT_FALSE(scan.unused[0].reason.empty());
}

TEST(BufrScanner, GoesOnAfterDamage) {
  const ByteVector message = bare_message(4, ByteVector(40, 0x55));
  ByteVector no_end = message, too_long = message, too_short = message, section_over = message;
  no_end.back() = '6';
  put_big_endian(too_long, 4, 3, 1'000'000);
  put_big_endian(too_short, 4, 3, 20);
  put_big_endian(section_over, 8 + 22 + 10, 3, 5000);
  for (const ByteVector& damaged : {no_end, too_long, too_short, section_over}) {
    const BufrScan scan = scan_bufr(joined({message, damaged, message, damaged, bytes_of("between"), message}));
    EXPECT_EQ(offsets_of(scan), (std::vector<std::size_t>{0, 2 * message.size(), 4 * message.size() + 7}));
    ASSERT_EQ(scan.unused.size(), 2U);
    EXPECT_EQ(scan.unused[0].offset, message.size());
    EXPECT_EQ(scan.unused[0].size, message.size());
    EXPECT_FALSE(scan.unused[0].reason.empty());
    EXPECT_EQ(scan.unused[1].size, message.size() + 7);
    EXPECT_FALSE(scan.cut_offset);
  }
}

TEST(BufrScanner, SeesBulletins) {
  const ByteVector message = bare_message();
  const ByteVector format_00 = bulletin(message), format_01 = bulletin(joined({message, message}), 1);
  const BufrScan scan = scan_bufr(joined({format_00, format_01, message, bytes_of("0000000000")}));
  ASSERT_EQ(scan.messages.size(), 4U);
  ASSERT_EQ(scan.bulletins.size(), 2U);
  EXPECT_EQ(scan.bulletins[0].heading_offset, 0U);
  EXPECT_EQ(scan.bulletins[0].heading_size, 41U);
  EXPECT_EQ(scan.bulletins[0].trailer_size, 4U);
  EXPECT_TRUE(scan.bulletins[0].has_length_prefix);
  EXPECT_EQ(scan.bulletins[1].heading_size, 34U);
  EXPECT_EQ(scan.bulletins[1].first_message, 1U);
  // Nothing tells the end of a bulletin of format 01 from a bare message behind it.
  EXPECT_EQ(scan.bulletins[1].message_count, 3U);
  EXPECT_TRUE(scan.has_end_marker);
  EXPECT_TRUE(scan.unused.empty());
}

// Cut anywhere, a file holds the messages before the cut, and says that it is cut unless the cut is between messages.
TEST(BufrScanner, NoticesACutAtEveryByte) {
  const ByteVector message = bare_message(4, bytes_of("some BUFR data"));
  for (const bool with_envelopes : {false, true}) {
    const ByteVector part = with_envelopes ? bulletin(message) : message;
    const ByteVector file = joined({part, part, part});
    const std::size_t begin = with_envelopes ? 41 : 0;
    for (std::size_t length = 1; length <= file.size(); ++length) {
      const BufrScan scan = scan_bufr(std::span(file).first(length));
      std::size_t whole = 0;
      while (whole < 3 && whole * part.size() + begin + message.size() <= length) ++whole;
      EXPECT_EQ(scan.messages.size(), whole) << length;
      const std::size_t end_of_last = whole ? (whole - 1) * part.size() + begin + message.size() : 0;
      const bool between = length >= end_of_last && length <= whole * part.size() && whole > 0;
      EXPECT_EQ(scan.cut_offset.has_value(), !between) << length;
    }
  }
}

// Whatever the bytes are: messages lie within the file, in order, apart, and all other bytes are accounted for.
TEST(BufrScanner, AccountsForEveryByteOfAnything) {
  std::mt19937 random(20040721);
  const ByteVector message = bare_message(3, bytes_of("BUFR"));
  const std::vector<ByteVector> pieces = {
      message,       bulletin(message),      bytes_of("BUFR"),       bytes_of("7777"),
      {0, 0, 30, 4}, bytes_of("\r\r\n\x03"), bytes_of("0000000000"), bytes_of("INAX01 EUMC 151230\r\r\n")};
  for (int round = 0; round < 3000; ++round) {
    ByteVector file;
    for (std::size_t count = random() % 12; count > 0; --count) {
      ByteVector piece = pieces[random() % pieces.size()];
      if (random() % 3 == 0) piece[random() % piece.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
      if (random() % 5 == 0) piece.resize(random() % piece.size() + 1);
      file = joined({file, piece});
    }
    const BufrScan scan = scan_bufr(file);
    std::vector<int> owners(file.size(), 0);
    const auto claim = [&](std::size_t offset, std::size_t size) {
      ASSERT_LE(offset + size, file.size());
      for (std::size_t i = offset; i < offset + size; ++i) ++owners[i];
    };
    std::size_t counted = 0;
    for (const Bulletin& b : scan.bulletins) {
      EXPECT_EQ(b.first_message, counted);
      counted += b.message_count;
      claim(b.heading_offset, b.heading_size);
      claim(b.trailer_offset, b.trailer_size);
    }
    EXPECT_EQ(counted, scan.messages.size());
    for (const BufrMessage& m : scan.messages) claim(m.offset, m.length);
    for (const UnusedBytes& u : scan.unused) claim(u.offset, u.size);
    const auto unowned = static_cast<std::size_t>(std::count(owners.begin(), owners.end(), 0));
    EXPECT_EQ(static_cast<std::size_t>(std::count(owners.begin(), owners.end(), 1)) + unowned, file.size());
    EXPECT_TRUE(unowned == 0 || (scan.has_end_marker && unowned >= 10)) << unowned;
  }
}

}  // namespace
}  // namespace thin
