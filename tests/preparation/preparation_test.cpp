#include "libthin/preparation/preparation.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random_observations.h"

namespace thin {
namespace {

TEST(Preparation, CountsEveryObservationOnce) {
  ObservationSet set = test::random_observations(1000, 2, 1);  // 200 ms apart
  for (std::size_t i = 0; i < set.size(); i += 50) set.values[i * 2] = std::numeric_limits<double>::quiet_NaN();
  const Result<Prepared> prepared = prepare(set, {20'000, 100'000}, {});
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->outside_window, 600U);
  std::size_t in_window = 0, screened = 0;
  for (const auto& [sounder, tally] : prepared->sounders) {
    in_window += tally.observations;
    for (const auto& [reason, count] : tally.screened) screened += count;
  }
  EXPECT_EQ(in_window, 400U);
  EXPECT_EQ(screened, 8U);
  EXPECT_EQ(prepared->observations.size(), 392U);
  EXPECT_EQ(prepared->origin.size(), 392U);
  for (std::size_t i = 0; i < prepared->origin.size(); ++i)
    EXPECT_EQ(prepared->observations.source[i], set.source[prepared->origin[i]]);
}

TEST(Preparation, WindowIsHalfOpen) {
  const ObservationSet set = test::random_observations(10, 1, 2);
  const Result<Prepared> prepared = prepare(set, {200, 400}, {});
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->origin, (std::vector<std::uint32_t>{1}));
}

TEST(Preparation, IsTheSameForShuffledInput) {
  const ObservationSet set = test::random_observations(500, 3, 3);
  std::vector<std::uint32_t> backwards;
  for (std::uint32_t i = 500; i-- > 0;) backwards.push_back(i);
  const Result<Prepared> a = prepare(set, {}, {}), b = prepare(set.select(backwards), {}, {});
  EXPECT_EQ(a->observations.values, b->observations.values);
  EXPECT_EQ(a->observations.source, b->observations.source);
}

// Every reason once; every observation in one count alone.
TEST(Preparation, CountsEachStepOfTheWay) {
  ObservationSet set = test::random_observations(1000, 2, 4);
  set.value_kind = ValueKind::brightness_temperature;
  for (double& value : set.values) value += 250;
  set.instrument.assign(set.size(), Instrument::amsua);
  for (std::size_t i = 0; i < set.size(); ++i) {
    set.surface[i] = i % 5 == 0 ? Surface::land : Surface::sea;
    set.variables["flags"].push_back(i % 7 == 0 ? 4 : 0);
  }
  ObservationSet twice = set;
  for (SourceReference& source : twice.source) source.file = 1;
  ObservationSet all = set;
  all.append(twice);
  PreparationOptions options;
  options.screening.surfaces = {Surface::sea};
  options.screening.flags = {{"flags", 4U}};
  options.screening.skip_edge = 2;
  const Result<Prepared> prepared = prepare(all, {}, options, {.file_names = {"a", "b"}});
  ASSERT_TRUE(prepared);
  std::size_t duplicates = 0, total = 0, prepared_count = 0;
  std::map<ScreeningReason, std::size_t> screened;
  for (const auto& [sounder, tally] : prepared->sounders) {
    EXPECT_EQ(sounder.second, Instrument::amsua);
    total += tally.observations;
    duplicates += tally.exact_duplicates;
    prepared_count += tally.prepared;
    std::size_t reasons = 0;
    for (const auto& [reason, count] : tally.screened) screened[reason] += count, reasons += count;
    EXPECT_EQ(reasons, tally.screened_count());
  }
  EXPECT_EQ(total, 2000U);
  EXPECT_EQ(duplicates, 1000U);
  EXPECT_GT(screened[ScreeningReason::surface], 100U);
  EXPECT_GT(screened[ScreeningReason::scan_position], 100U);
  EXPECT_GT(screened[ScreeningReason::first_rule], 50U);
  EXPECT_EQ(screened.size(), 3U);
  EXPECT_EQ(prepared_count, prepared->observations.size());
  for (std::size_t i = 0; i < prepared->observations.size(); ++i) {
    EXPECT_EQ(prepared->observations.surface[i], Surface::sea);
    EXPECT_EQ(prepared->observations.source[i], all.source[prepared->origin[i]]);
  }
}

TEST(Preparation, CorrectsBiasBeforeTheCompanionsFirstGuess) {
  ObservationSet set = test::random_observations(400, 1, 5);
  set.value_kind = ValueKind::brightness_temperature;
  set.instrument.assign(set.size(), Instrument::amsua);
  for (double& value : set.values) value += 250;
  ObservationSet companions = set;
  companions.first_guess_k.assign(companions.values.size(), 250.25);
  companions.first_guess_k[10] = std::numeric_limits<double>::quiet_NaN();
  const auto table = BiasTable::parse("satellite,instrument,channel,scan_position,bias_k\n206,amsua,1,*,0.5\n", "b");
  PreparationOptions options;
  options.first_guess.first_guess = FirstGuess::companion;
  options.companions.files = {"c.nc"};
  PreparationData data;
  data.bias_table = *table;
  data.companions = companions;
  const Result<Prepared> prepared = prepare(set, {}, options, data);
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->bias.corrected, 200U);
  EXPECT_EQ(prepared->sounders.at({206, Instrument::amsua}).screened.at(ScreeningReason::no_companion), 1U);
  EXPECT_EQ(prepared->sounders.at({207, Instrument::amsua}).screened.at(ScreeningReason::no_bias_correction), 200U);
  EXPECT_EQ(prepared->first_guess.given, 199U);
  EXPECT_EQ(prepared->observations.value_kind, ValueKind::innovation);
}

TEST(Preparation, OptionsThatDoNotFitTogetherAreNamed) {
  PreparationOptions options;
  EXPECT_FALSE(options.conflict());
  options.first_guess.first_guess = FirstGuess::companion;
  EXPECT_EQ(options.conflict()->key, "first_guess");
  options.first_guess.first_guess = FirstGuess::none;
  options.companions.files = {"x"};
  EXPECT_EQ(options.conflict()->key, "companion_files");
  options.companions.files.clear();
  options.screening.minimum_latitude_deg = 20;
  options.screening.maximum_latitude_deg = -20;
  EXPECT_EQ(options.conflict()->key, "minimum_latitude_deg");
}

}  // namespace
}  // namespace thin
