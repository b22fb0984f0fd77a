#include "libthin/preparation/bias.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_observations.h"

namespace thin {
namespace {

const char* const kTable =
    "# biases\n\nsatellite,instrument,channel,scan_position,bias_k\n"
    "NOAA-15, amsua, 1, *, 0.5\nNOAA-15,amsua,1,3,-1.25\n207,AMSU-A,1,*,2\nNOAA-15,amsua,2,*,0.25\n";

ObservationSet temperatures() {
  ObservationSet set = test::random_observations(60, 2, 1);
  set.value_kind = ValueKind::brightness_temperature;
  set.instrument.assign(set.size(), Instrument::amsua);
  std::fill(set.values.begin(), set.values.end(), 250.0);
  return set;
}

std::string problem_of(const std::string& lines) {
  const auto table = BiasTable::parse("satellite,instrument,channel,scan_position,bias_k\n" + lines, "b.csv");
  return table ? "" : table.error().message;
}

TEST(Bias, ComesFromTheTableByScanPosition) {
  const auto table = BiasTable::parse(kTable, "b.csv");
  ASSERT_TRUE(table) << table.error().message;
  ObservationSet set = temperatures();
  std::vector<bool> uncorrected;
  const BiasCounts counts = correct_bias(set, &*table, nullptr, {}, uncorrected);
  EXPECT_EQ(counts.corrected, 30U);
  EXPECT_EQ(counts.uncorrected, 30U);  // NOAA-16 lacks channel 2
  for (std::size_t i = 0; i < set.size(); ++i) {
    const bool noaa15 = set.platform[i] == 206;
    EXPECT_EQ(uncorrected[i], !noaa15);
    EXPECT_EQ(set.values[2 * i], !noaa15 ? 250 : set.field_of_view[i] == 3 ? 251.25 : 249.5);
    EXPECT_EQ(set.values[2 * i + 1], noaa15 ? 249.75 : 250);
  }
}

TEST(Bias, AddsPredictorsTimesCoefficients) {
  const auto predictors = BiasPredictors::parse(
      "satellite,instrument,channel,predictor,coefficient\n"
      "206,amsua,1,constant,1\n206,amsua,1,satellite_zenith_angle_deg,0.01\n"
      "206,amsua,1,satellite_zenith_angle_deg^2,-0.001\n206,amsua,2,constant,0\n"
      "207,amsua,1,constant,0\n207,amsua,2,thickness_1000_300_m,1\n",
      "p.csv");
  ASSERT_TRUE(predictors) << predictors.error().message;
  ObservationSet set = temperatures();
  for (std::size_t i = 0; i < set.size(); ++i)
    set.variables["satellite_zenith_angle_deg"].push_back(static_cast<double>(i));
  std::vector<bool> uncorrected;
  const BiasCounts counts = correct_bias(set, nullptr, &*predictors, {}, uncorrected);
  EXPECT_EQ(counts.corrected, 30U);
  for (std::size_t i = 0; i < set.size(); i += 2) {
    const double angle = static_cast<double>(i);
    EXPECT_NEAR(set.values[2 * i], 250 - (1 + 0.01 * angle - 0.001 * angle * angle), 1e-12);
    EXPECT_EQ(set.values[2 * i + 1], 250);
  }
  for (std::size_t i = 1; i < set.size(); i += 2) EXPECT_TRUE(uncorrected[i]) << "no thickness";
}

TEST(Bias, LeavesInnovationsMissingValuesAndTheSkippedAlone) {
  const auto table = BiasTable::parse(kTable, "b.csv");
  ObservationSet innovations = temperatures(), set = temperatures();
  innovations.value_kind = ValueKind::innovation;
  std::vector<bool> uncorrected;
  EXPECT_EQ(correct_bias(innovations, &*table, nullptr, {}, uncorrected).corrected, 0U);
  EXPECT_EQ(innovations.values, temperatures().values);
  set.values[3] = std::nan("");  // NOAA-16's channel 2
  std::vector<bool> skip(set.size());
  skip[0] = true;
  correct_bias(set, &*table, nullptr, skip, uncorrected);
  EXPECT_EQ(set.values[0], 250);
  EXPECT_FALSE(uncorrected[0]);
  EXPECT_EQ(set.values[2], 248);
  EXPECT_FALSE(uncorrected[1]);
}

TEST(Bias, FilesNameLineValueAndRemedy) {
  EXPECT_EQ(problem_of("NOAA-99,amsua,1,1,0"),
            "b.csv:2: satellite \"NOAA-99\" is not known: write a name like \"NOAA-19\" or its WMO number");
  EXPECT_EQ(problem_of("4,amsux,1,1,0"),
            "b.csv:2: instrument \"amsux\" is not known: write amsua, amsub, mhs, hirs or atms");
  EXPECT_EQ(problem_of("4,amsua,0,1,0"), "b.csv:2: channel \"0\" must be a number from 1 on");
  EXPECT_EQ(problem_of("4,amsua,1,x,0"), "b.csv:2: scan_position \"x\" must be a number from 1 on, or *");
  EXPECT_EQ(problem_of("\n4,amsua,1,1,0.1K"), "b.csv:3: bias_k \"0.1K\" must be a number");
  EXPECT_EQ(problem_of("4,amsua,1,1"),
            "b.csv:2: 4 fields instead of 5 (satellite,instrument,channel,scan_position,bias_k)");
  EXPECT_EQ(problem_of("4,amsua,1,1,0\n4,amsua,1,1,0"),
            "b.csv:3: scan_position 1 of this channel stands here for the second time");
  EXPECT_NE(BiasTable::parse("4,amsua,1,1,0\n", "b.csv").error().message.find("must name the columns"),
            std::string::npos);
  EXPECT_NE(BiasTable::parse("# nothing\n", "b.csv").error().message.find("is missing"), std::string::npos);
  const auto predictors =
      BiasPredictors::parse("satellite,instrument,channel,predictor,coefficient\n4,amsua,1,zenith^x,0\n", "p.csv");
  EXPECT_EQ(predictors.error().message, "p.csv:2: the power of predictor \"zenith^x\" must be a number from 1 to 9");
  EXPECT_EQ(predictors.error().kind, ErrorKind::configuration);
}

}  // namespace
}  // namespace thin
