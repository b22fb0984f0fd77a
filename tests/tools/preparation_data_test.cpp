#include "libthin/tools/preparation_data.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/bufr_messages.h"
#include "tests/support/synthetic_files.h"

namespace thin {
namespace {

using test::ScratchFolder;

class PreparationDataTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(scratch_.path(name)) << text;
    return scratch_.path(name);
  }
  Error problem() {
    const auto data = read_preparation_data(options_);
    EXPECT_FALSE(data);
    return data ? Error{} : data.error();
  }
  ScratchFolder scratch_;
  PreparationOptions options_;
};

TEST_F(PreparationDataTest, ReadsWhatTheOptionsNameBesideTheConfiguration) {
  write("b.csv", "satellite,instrument,channel,scan_position,bias_k\n206,amsua,5,*,0.5\n");
  write("p.csv", "satellite,instrument,channel,predictor,coefficient\n206,amsua,5,constant,0.5\n");
  options_.bias.table = "b.csv";
  options_.bias.predictors = scratch_.path("p.csv");
  options_.surface.land_sea_mask = "nowhere.nc";  // not read where no surface is asked for
  make_paths_absolute(options_, scratch_.path(""));
  const auto data = read_preparation_data(options_);
  ASSERT_TRUE(data) << data.error().message;
  EXPECT_TRUE(data->bias_table->find({{206, Instrument::amsua}, 5}));
  EXPECT_TRUE(data->bias_predictors->find({{206, Instrument::amsua}, 5}));
  EXPECT_FALSE(data->shoreline);
}

TEST_F(PreparationDataTest, NamesTheFileThatIsNotThere) {
  options_.bias.table = scratch_.path("b.csv");
  EXPECT_EQ(problem().kind, ErrorKind::configuration);
  EXPECT_NE(problem().message.find("[preparation] bias_table: "), std::string::npos) << problem().message;
  write("b.csv", "satellite,instrument,channel,scan_position,bias_k\n206,amsua,5,*,warm\n");
  EXPECT_EQ(problem().message, scratch_.path("b.csv") + ":2: bias_k \"warm\" must be a number");
  options_.bias.table.clear();
  options_.screening.surfaces = {Surface::sea};
  options_.surface.land_sea_mask = scratch_.path("mask.nc");
  EXPECT_NE(problem().message.find("install Debian's package gmt-gshhg-low"), std::string::npos) << problem().message;
}

TEST_F(PreparationDataTest, CompanionsMayStillCome) {
  EXPECT_FALSE(*read_companions(options_, {}));
  options_.first_guess.first_guess = FirstGuess::companion;
  options_.companions.files = {scratch_.path("guess-*.nc")};
  const auto none = read_companions(options_, {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::temporary);
  test::write_synthetic_file(scratch_.path("guess-1.nc"), "NOAA-15", test::kSyntheticBeginMs, 2);
  const auto without = read_companions(options_, {});
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().kind, ErrorKind::input);
  EXPECT_NE(without.error().message.find("guess-1.nc: it has no first guess"), std::string::npos);
}

}  // namespace
}  // namespace thin
