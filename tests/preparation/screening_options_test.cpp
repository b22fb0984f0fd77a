#include "libthin/preparation/screening_options.h"

#include <gtest/gtest.h>

namespace thin {
namespace {

using Phrases = std::vector<std::string>;

class ScreeningOptionsTest : public testing::Test {
 protected:
  ScreeningOptionsTest() { options_.declare(table_); }
  std::string problem(const char* option, const OptionValue& value) {
    return table_.find(option)->assign(value).value_or("");
  }
  ScreeningOptions options_;
  OptionTable table_;
};

TEST_F(ScreeningOptionsTest, ReadChannelsOfOneAndOfSeveralInstruments) {
  EXPECT_EQ(problem("channels", std::vector<std::int64_t>{5, 6}), "");
  EXPECT_EQ(options_.channels, (std::vector<int>{5, 6}));
  EXPECT_EQ(table_.find("channels")->current_value(), "[5, 6]");
  EXPECT_EQ(problem("channels", Phrases{"amsua 5-7 9", "MHS 3, 4"}), "");
  EXPECT_TRUE(options_.channels.empty());
  EXPECT_EQ(options_.channels_of[Instrument::amsua], (std::vector<int>{5, 6, 7, 9}));
  EXPECT_EQ(options_.channels_of[Instrument::mhs], (std::vector<int>{3, 4}));
  EXPECT_EQ(table_.find("channels")->current_value(), "[\"amsua 5-7 9\", \"MHS 3, 4\"]");
}

TEST_F(ScreeningOptionsTest, ReadEverythingElse) {
  EXPECT_EQ(problem("platforms", Phrases{"noaa-19", "3"}), "");
  EXPECT_EQ(options_.platforms, (std::set<std::int32_t>{3, 223}));
  EXPECT_EQ(problem("instruments", Phrases{"AMSU-A", "hirs"}), "");
  EXPECT_EQ(options_.instruments, (std::set{Instrument::amsua, Instrument::hirs}));
  EXPECT_EQ(problem("surface", std::string("sea")), "");
  EXPECT_EQ(options_.surfaces, std::set{Surface::sea});
  EXPECT_EQ(problem("skip_edge_positions", std::int64_t{3}), "");
  EXPECT_EQ(options_.skipped_edge_of(Instrument::mhs), 3);
  EXPECT_EQ(problem("skip_edge_positions", Phrases{"2", "mhs 9"}), "");
  EXPECT_EQ(options_.skipped_edge_of(Instrument::mhs), 9);
  EXPECT_EQ(options_.skipped_edge_of(Instrument::amsua), 2);
  EXPECT_EQ(problem("gross_limits", Phrases{"mhs 100 300.5"}), "");
  EXPECT_EQ(options_.limits_of(Instrument::mhs).maximum_k, 300.5);
  EXPECT_EQ(options_.limits_of(Instrument::hirs).minimum_k, 150);
  EXPECT_EQ(problem("minimum_k", 90.0), "");
  EXPECT_EQ(options_.limits_of(Instrument::hirs).minimum_k, 90);
  EXPECT_EQ(options_.limits_of(Instrument::mhs).minimum_k, 100);
  EXPECT_EQ(problem("reject_flagged", Phrases{"a", "b 0x12", "c 3"}), "");
  EXPECT_EQ(options_.flags[0].mask, std::nullopt);
  EXPECT_EQ(options_.flags[1].mask, 18U);
  EXPECT_EQ(options_.flags[2].mask, 3U);
  EXPECT_EQ(problem("variable_limits", Phrases{"MetaData/angle -5 55"}), "");
  EXPECT_EQ(options_.variables[0].variable, "MetaData/angle");
  EXPECT_EQ(options_.variables[0].minimum, -5);
}

TEST_F(ScreeningOptionsTest, SayWhatIsWrongAndLeaveTheRest) {
  EXPECT_EQ(problem("channels", Phrases{"amsux 5"}),
            "has the unknown instrument \"amsux\"; known are amsua, amsub, mhs, hirs, atms");
  EXPECT_EQ(problem("channels", Phrases{"amsua"}), "names no channel behind \"amsua\"");
  EXPECT_NE(problem("channels", Phrases{"amsua 7-5"}).find("has \"7-5\", which is no channel"), std::string::npos);
  EXPECT_NE(problem("channels", std::vector<std::int64_t>{0}).find("has \"0\", which is no channel"),
            std::string::npos);
  EXPECT_EQ(problem("channels", 1.5), "must be a list of texts or integers, not a number");
  EXPECT_NE(problem("platforms", Phrases{"NOAA 19"}).find("has the unknown satellite \"NOAA 19\""), std::string::npos);
  EXPECT_NE(problem("surface", Phrases{"see"}).find("known are sea, land, coast, ice, unknown"), std::string::npos);
  EXPECT_NE(problem("skip_edge_positions", Phrases{"amsua 15"}).find("at most 14"), std::string::npos);
  EXPECT_NE(problem("gross_limits", Phrases{"mhs 300 100"}).find("write instrument, lower and upper limit"),
            std::string::npos);
  EXPECT_NE(problem("reject_flagged", Phrases{"a 0"}).find("a mask of the bits"), std::string::npos);
  EXPECT_NE(problem("variable_limits", Phrases{"a 0"}).find("its limits"), std::string::npos);
  EXPECT_TRUE(options_.channels.empty());
  EXPECT_TRUE(options_.flags.empty());
}

}  // namespace
}  // namespace thin
