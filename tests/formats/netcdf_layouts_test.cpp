// Reading each of netCDF's layouts, from files that tests/support/netcdf_files.h makes by formulas.

#include <gtest/gtest.h>

#include <cmath>

#include "libthin/formats/observation_file.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/netcdf_files.h"

namespace thin {
namespace {

class NetcdfLayoutsTest : public testing::Test {
 protected:
  ReadObservations read(const std::string& path, const InputOptions& options = {}) {
    Result<ReadObservations> contents = read_observations(path, options);
    EXPECT_TRUE(contents.ok()) << contents.error().message;
    return contents ? std::move(*contents) : ReadObservations{};
  }
  std::string path(const char* name) { return scratch_.path(name); }

  // Values and first guesses are those of the formulas; rejected values are missing.
  static void expect_formulas(const ObservationSet& set, std::size_t channels, double tolerance_k = 1e-4) {
    ASSERT_EQ(set.channel_count(), channels);
    for (std::size_t row = 0; row < set.size(); ++row) {
      const std::size_t i = set.source[row].subset;
      EXPECT_FLOAT_EQ(static_cast<float>(set.latitude_deg[row]), static_cast<float>(test::latitude_of(i)));
      EXPECT_FLOAT_EQ(static_cast<float>(set.longitude_deg[row]), static_cast<float>(test::longitude_of(i)));
      for (std::size_t c = 0; c < channels; ++c) {
        SCOPED_TRACE("location " + std::to_string(i) + " channel " + std::to_string(c + 1));
        const double value_k = set.values_of(row)[c];
        ASSERT_EQ(std::isnan(value_k), test::is_rejected(i, c));
        if (std::isnan(value_k)) continue;
        EXPECT_NEAR(value_k, test::observed_of(i, c), tolerance_k);
        if (set.first_guess_k.empty()) continue;
        EXPECT_NEAR(value_k - set.first_guess_k[row * channels + c], test::innovation_of(i, c), tolerance_k);
      }
    }
  }

  test::ScratchFolder scratch_;
};

TEST_F(NetcdfLayoutsTest, Ioda) {
  const ReadObservations contents = read(test::write_ioda(path("a.nc4")));
  EXPECT_EQ(contents.layout, "ioda");
  EXPECT_EQ(contents.instrument, "AMSU-A");
  ASSERT_FALSE(contents.notes.empty());
  EXPECT_EQ(contents.notes.front(), "innovations: ObsValue - hofx where PreQC is 0");
  const ObservationSet& set = contents.observations;
  ASSERT_EQ(set.size(), 40U);
  expect_formulas(set, 15);
  EXPECT_EQ(set.platform[7], 223);
  EXPECT_EQ(set.time_ms[7], 1639256407000);
  EXPECT_EQ(set.field_of_view[31], 2);
  EXPECT_EQ(set.scan_line[0], kUnknownNumber);
  EXPECT_EQ(set.surface[0], Surface::land);
  EXPECT_EQ(set.surface[1], Surface::sea);
  EXPECT_TRUE(std::isnan(set.variables.at("satellite_zenith_angle_deg")[3]));
  EXPECT_EQ(set.variables.at("satellite_zenith_angle_deg")[4], 1);
  EXPECT_EQ(set.variables.at("MetaData/sensorScanPosition")[0], 1);
}

TEST_F(NetcdfLayoutsTest, IodaByOtherRules) {
  const std::string file = test::write_ioda(path("a.nc4"));
  InputOptions options;
  options.ioda_quality = {};
  options.ioda_first_guess = {"nothing", "PreQC"};
  const ReadObservations contents = read(file, options);
  EXPECT_EQ(contents.notes.front(), "innovations: ObsValue - PreQC");
  EXPECT_EQ(contents.observations.first_guess_k[10], 50);
  options.ioda_first_guess = {};
  EXPECT_TRUE(read(file, options).observations.first_guess_k.empty());
  options.ioda_observed = "DerivedObsValue";
  const auto refused = read_observations(file, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("ioda_observed"), std::string::npos) << refused.error().message;
}

TEST_F(NetcdfLayoutsTest, IodaBeforeGroups) {
  for (const bool per_channel : {false, true}) {
    SCOPED_TRACE(per_channel);
    const ReadObservations contents = read(test::write_old_ioda(path("a.nc4"), per_channel));
    EXPECT_EQ(contents.layout, "ioda");
    EXPECT_EQ(contents.notes.front(), "innovations: ObsValue - HofX where PreQC is 0");
    ASSERT_EQ(contents.observations.size(), 40U);
    expect_formulas(contents.observations, 15);
    EXPECT_EQ(contents.observations.time_ms[7], 1639256407000);
    EXPECT_EQ(contents.observations.platform[7], 223);
    EXPECT_EQ(contents.observations.field_of_view[31], 2);
  }
}

TEST_F(NetcdfLayoutsTest, GsiDiagnostics) {
  const std::string file = test::write_gsi(path("a.nc4"));
  const ReadObservations contents = read(file);
  EXPECT_EQ(contents.layout, "gsi_diagnostics");
  EXPECT_EQ(contents.instrument, "AMSU-A");
  EXPECT_EQ(contents.notes.front(), "innovations: Obs_Minus_Forecast_adjusted where QC_Flag is 0");
  const ObservationSet& set = contents.observations;
  ASSERT_EQ(set.size(), 40U);
  expect_formulas(set, 15);
  EXPECT_EQ(set.platform[0], 223);
  EXPECT_EQ(set.time_ms[0], 1639256400000) << "three hours before the analysis";
  EXPECT_EQ(set.time_ms[1], 1639256400000 + 450000);
  EXPECT_EQ(set.field_of_view[31], 2);
  EXPECT_EQ(set.surface[0], Surface::sea);
  EXPECT_EQ(set.surface[1], Surface::coast);
  EXPECT_EQ(set.surface[2], Surface::land);
  EXPECT_EQ(set.variables.at("satellite_zenith_angle_deg")[8], 2);
  InputOptions options;
  options.gsi_innovation = "Obs_Minus_Forecast_unadjusted";
  EXPECT_NEAR(read(file, options).observations.first_guess_k[0], set.first_guess_k[0] - 1.5, 1e-4);
}

TEST_F(NetcdfLayoutsTest, FeedbackFiles) {
  for (const bool reversed : {false, true})
    for (const char* kind : {"64-bit offset", "nc7"}) {
      SCOPED_TRACE(std::string(kind) + (reversed ? ", reversed" : ""));
      test::FeedbackShape shape;
      shape.mixed = false;
      shape.reversed_body = reversed;
      shape.kind = kind;
      const ReadObservations contents = read(test::write_feedback(path("fofRAD.nc"), shape));
      EXPECT_EQ(contents.layout, "feedback");
      EXPECT_EQ(contents.instrument, "AMSU-A");
      EXPECT_EQ(contents.notes.front(),
                "innovations: obs - veri_data of run 2 (veri_run_type 1, veri_ens_member -1) where state is 0 or 1");
      const ObservationSet& set = contents.observations;
      ASSERT_EQ(set.size(), 40U) << "n_hdr, not d_hdr";
      EXPECT_EQ(set.time_ms[5], 1639256400000 + (4 * 60 - 90 + 30 + 5 - 60) * 60000LL);
      EXPECT_EQ(set.platform[5], 223);
      EXPECT_EQ(set.scan_line[31], 2);
      EXPECT_EQ(set.field_of_view[31], 2);
      EXPECT_EQ(set.surface[0], Surface::sea);
      EXPECT_EQ(set.surface[1], Surface::land);
      EXPECT_EQ(set.surface[2], Surface::coast);
      for (std::size_t i = 0; i < set.size(); ++i)
        EXPECT_TRUE(std::isnan(set.values_of(i)[2])) << "a passive channel is not used unless asked for";
      InputOptions options;
      options.feedback_accepted = {0, 1, 5};
      expect_formulas(read(path("fofRAD.nc"), options).observations, 15);
    }
}

TEST_F(NetcdfLayoutsTest, FeedbackFilesOfSeveralInstruments) {
  const test::FeedbackShape shape;
  InputOptions options;
  options.feedback_accepted = {0, 1, 5};
  const ReadObservations contents = read(test::write_feedback(path("fofRAD.nc"), shape), options);
  EXPECT_EQ(contents.instrument, "AMSU-A, MHS");
  const ObservationSet& set = contents.observations;
  EXPECT_EQ(set.channel_count(), 20U);
  std::size_t of_mhs = 0, soundings = 0;
  for (std::size_t i = 0; i < shape.reports; ++i) soundings += test::report_kind(shape, i) != test::ReportKind::temp;
  EXPECT_EQ(set.size(), soundings);
  for (std::size_t row = 0; row < set.size(); ++row) {
    const std::size_t i = set.source[row].subset;
    const bool mhs = test::report_kind(shape, i) == test::ReportKind::mhs;
    of_mhs += mhs;
    EXPECT_EQ(set.instrument[row], mhs ? Instrument::mhs : Instrument::amsua);
    for (std::size_t place = 0; place < 20; ++place) {
      const std::size_t c = static_cast<std::size_t>(set.channels[place] - 1);
      const bool missing = !set.measures(row, place) || test::is_rejected(i, c);
      ASSERT_EQ(std::isnan(set.values_of(row)[place]), missing);
      if (!missing) {
        EXPECT_NEAR(set.values_of(row)[place], test::observed_of(i, c), 1e-4);
      }
    }
  }
  EXPECT_GT(of_mhs, 3U);
}

TEST_F(NetcdfLayoutsTest, SomebodyElsesCf) {
  const ReadObservations contents = read(test::write_foreign_cf(path("a.nc")));
  EXPECT_EQ(contents.layout, "cf");
  EXPECT_EQ(contents.instrument, "MHS");
  const ObservationSet& set = contents.observations;
  ASSERT_EQ(set.size(), 40U);
  expect_formulas(set, 5);
  EXPECT_EQ(set.platform[0], 3);
  EXPECT_EQ(set.time_ms[7], 1639256407000);
  EXPECT_EQ(set.variables.at("satellite_zenith_angle_deg")[8], 2);
  EXPECT_TRUE(set.first_guess_k.empty());
}

TEST_F(NetcdfLayoutsTest, ThePlatformOfTheConfigurationIsForFilesThatNameNone) {
  InputOptions options;
  options.platform = "Metop-C";
  EXPECT_EQ(read(test::write_ioda(path("a.nc4")), options).observations.platform[0], 223);
  test::Cdl cdl;
  cdl.dimension("Location", 1);
  cdl.dimension("Channel", 2);
  cdl.begin_group("MetaData");
  cdl.variable("double latitude(Location)", {}, {10});
  cdl.variable("double longitude(Location)", {}, {20});
  cdl.variable("double dateTime(Location)", {"units = \"seconds since 1970-01-01T00:00:00Z\""}, {1e9});
  cdl.end_group();
  cdl.begin_group("ObsValue");
  cdl.variable("double brightnessTemperature(Location, Channel)", {}, {200, 300});
  cdl.end_group();
  EXPECT_EQ(read(cdl.write(path("b.nc4")), options).observations.platform[0], 5);
  EXPECT_EQ(read(path("b.nc4")).observations.platform[0], kUnknownNumber);
}

TEST_F(NetcdfLayoutsTest, LocationsWithoutPlaceOrTimeAreLeftOutAndCounted) {
  test::Cdl cdl;
  cdl.dimension("Location", 5);
  cdl.dimension("Channel", 1);
  cdl.begin_group("MetaData");
  cdl.variable("double latitude(Location)", {}, {10, 91, test::kNoValue, 20, 30});
  cdl.variable("double longitude(Location)", {}, {20, 20, 20, 400, 20});
  cdl.variable("double dateTime(Location)", {"units = \"minutes since 2000-01-01 00:00:00\""}, {1, 1, 1, 1, 2});
  cdl.end_group();
  cdl.begin_group("ObsValue");
  cdl.variable("double brightnessTemperature(Location, Channel)", {}, {200, 201, 202, 203, 204});
  cdl.end_group();
  const ReadObservations contents = read(cdl.write(path("a.nc4")));
  ASSERT_EQ(contents.observations.size(), 2U);
  EXPECT_EQ(contents.observations.source[1].subset, 4U);
  EXPECT_EQ(contents.observations.values[1], 204);
  EXPECT_EQ(contents.observations.time_ms[1], 946684800000 + 120000);
  ASSERT_EQ(contents.skipped.size(), 1U);
  EXPECT_NE(contents.skipped[0].reason.find("3 of 5"), std::string::npos) << contents.skipped[0].reason;
}

}  // namespace
}  // namespace thin
