#include "libthin/formats/gts_bulletin.h"

#include <gtest/gtest.h>

#include "tests/support/bufr_messages.h"

namespace thin {
namespace {

using test::bytes_of;

const std::string kLine = "INAX01 EUMC 151230\r\r\n";

GtsHeading heading_in(const std::string& text) {
  return find_gts_heading(bytes_of(text));
}

TEST(GtsHeading, FindsEveryForm) {
  const std::string full = "0000123400\x01\r\r\n042\r\r\n" + kLine;
  EXPECT_EQ(heading_in(full).size, full.size());
  EXPECT_TRUE(heading_in(full).has_length_prefix);

  const std::string format_01 = "0000123401\r\r\n" + kLine;
  EXPECT_EQ(heading_in(format_01).size, format_01.size());
  EXPECT_TRUE(heading_in(format_01).has_length_prefix);

  const std::string no_prefix = "\x01\r\r\n04217\r\r\n" + kLine;
  EXPECT_EQ(heading_in(no_prefix).size, no_prefix.size());
  EXPECT_FALSE(heading_in(no_prefix).has_length_prefix);

  EXPECT_EQ(heading_in(kLine).size, kLine.size());
  EXPECT_EQ(heading_in("ISAA41 CYTR 071700 RRA\n").size, 23U);
}

TEST(GtsHeading, LeavesWhatStandsBefore) {
  const std::string full = "0000123400\x01\r\r\n042\r\r\n" + kLine;
  EXPECT_EQ(heading_in("7777 rest of something\r\r\n\x03" + full).size, full.size());
  EXPECT_EQ(heading_in("a note.\n" + kLine).size, kLine.size());
  EXPECT_EQ(heading_in(std::string(500, 'x') + "\n" + kLine).size, kLine.size());
}

TEST(GtsHeading, NothingElseIsOne) {
  for (const std::string text : {"", "\n", "INAX01 EUMC 151230", "INAX01 EUMC 1512\r\r\n", "hello world\n",
                                 "INAX01 EUMC 151230\r\r\n ", "0000123400\x01\r\r\n"})
    EXPECT_EQ(heading_in(text).size, 0U) << text;
}

TEST(GtsTrailer, IsTheEndOfText) {
  EXPECT_EQ(gts_trailer_size(bytes_of("\r\r\n\x03"
                                      "0000")),
            4U);
  EXPECT_EQ(gts_trailer_size(bytes_of("\r\n\x03")), 3U);
  EXPECT_EQ(gts_trailer_size(bytes_of("\x03")), 1U);
  for (const std::string text : {"", "\r", "\r\r\n", "\r\r\nBUFR", "BUFR"})
    EXPECT_EQ(gts_trailer_size(bytes_of(text)), 0U) << text;
}

TEST(GtsEndMarker, IsAPrefixOfLengthNought) {
  EXPECT_TRUE(is_gts_end_marker(bytes_of("0000000000")));
  EXPECT_TRUE(is_gts_end_marker(bytes_of("0000000001 and more")));
  for (const std::string text : {"", "00000000", "0000000002", "0000100000"})
    EXPECT_FALSE(is_gts_end_marker(bytes_of(text))) << text;
}

TEST(CutGtsHeading, IsAnyBeginningOfAHeading) {
  const std::string full = "0000123400\x01\r\r\n042\r\r\n" + kLine;
  for (std::size_t length = 1; length <= full.size(); ++length)
    EXPECT_TRUE(is_cut_gts_heading(bytes_of(full.substr(0, length)))) << length;
  for (const std::string text : {"B", "\r\r\nBU",
                                 "\x01\x01"
                                 "BUF"})
    EXPECT_TRUE(is_cut_gts_heading(bytes_of(text)));
  for (const std::string text : {"", "0000000000", "\r\n", "xyz", "AB"})
    EXPECT_FALSE(is_cut_gts_heading(bytes_of(text))) << text;
}

TEST(GtsLength, CountsWhatFollowsThePrefix) {
  auto bulletin = bytes_of("9999999900\x01\r\r\n");
  put_gts_length(bulletin);
  EXPECT_EQ(bulletin, bytes_of("0000000400\x01\r\r\n"));
}

}  // namespace
}  // namespace thin
