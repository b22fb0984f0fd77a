#include "libthin/preparation/first_guess.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_observations.h"

namespace thin {
namespace {

FirstGuessCounts subtract(ObservationSet& set, const FirstGuessOptions& options, std::vector<std::string>& notes) {
  return subtract_first_guess(set, first_guess_sources(set, options.first_guess), options, notes);
}

// The mean of a scan position from its definition.
double scan_position_mean(const ObservationSet& set, std::size_t of, std::size_t channel) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set.platform[i] != set.platform[of] || set.field_of_view[i] != set.field_of_view[of]) continue;
    sum += set.values_of(i)[channel];
    ++count;
  }
  return sum / count;
}

TEST(FirstGuess, IsTheMeanOfTheScanPosition) {
  ObservationSet set = test::random_observations(900, 2, 1);
  set.value_kind = ValueKind::brightness_temperature;
  const ObservationSet before = set;
  std::vector<std::string> notes;
  subtract(set, {}, notes);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(set.value_kind, ValueKind::innovation);
  for (std::size_t i = 0; i < set.size(); i += 17)
    for (std::size_t c = 0; c < 2; ++c)
      EXPECT_NEAR(set.values_of(i)[c], before.values_of(i)[c] - scan_position_mean(before, i, c), 1e-12);
}

TEST(FirstGuess, OfAFewLinesIsTheMeanOfTheSatelliteAndSaysSo) {
  ObservationSet set = test::random_observations(60, 1, 2);
  set.value_kind = ValueKind::brightness_temperature;
  std::vector<std::string> notes;
  subtract(set, {}, notes);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_NE(notes[0].find("NOAA-15: 2.0 observations of each scan position are fewer than 10"), std::string::npos)
      << notes[0];
  double sum = 0;
  for (std::size_t i = 0; i < set.size(); i += 2) sum += set.values[i];
  EXPECT_NEAR(sum, 0, 1e-9);
  EXPECT_NE(set.values[0], 0);
}

TEST(FirstGuess, NoneIsNeverSilent) {
  ObservationSet set = test::random_observations(100, 1, 3);
  set.value_kind = ValueKind::brightness_temperature;
  for (double& value : set.values) value += 250;
  std::vector<std::string> notes;
  subtract(set, {.first_guess = FirstGuess::none}, notes);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_NE(notes[0].find("not innovations"), std::string::npos);
  EXPECT_NE(notes[1].find("taken off"), std::string::npos);
  double sum = 0;
  for (const double value : set.values) sum += value;
  EXPECT_NEAR(sum, 0, 1e-8);
}

TEST(FirstGuess, LeavesGoodInnovationsAsTheyAre) {
  ObservationSet set = test::random_observations(500, 2, 4);
  const ObservationSet before = set;
  std::vector<std::string> notes;
  subtract(set, {}, notes);
  EXPECT_EQ(set.values, before.values);
  EXPECT_TRUE(notes.empty());
}

TEST(FirstGuess, TakesTheMeanOffBiasedInnovations) {
  ObservationSet set = test::random_observations(500, 2, 5);
  for (std::size_t i = 0; i < set.size(); ++i) set.values[2 * i + 1] += 3;
  std::vector<std::string> notes;
  subtract(set, {}, notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].substr(0, 10), "channel 2:");
}

TEST(FirstGuess, OfEqualValuesAndOfNothingIsQuiet) {
  ObservationSet equal = test::random_observations(600, 1, 6), none = test::random_observations(0, 1, 6);
  equal.value_kind = none.value_kind = ValueKind::brightness_temperature;
  std::fill(equal.values.begin(), equal.values.end(), 251.37);
  std::vector<std::string> notes;
  subtract(equal, {}, notes);
  subtract(none, {}, notes);
  EXPECT_TRUE(notes.empty());
}

// Half from a file with model equivalents, one of them missing; half from one without.
TEST(FirstGuess, OfTheFileIsTakenWhereTheFileHasIt) {
  ObservationSet set = test::random_observations(600, 2, 7);
  set.value_kind = ValueKind::brightness_temperature;
  set.first_guess_k.assign(set.values.size(), std::nan(""));
  for (std::size_t i = 0; i < set.size(); ++i) {
    set.source[i].file = i % 2;
    if (i % 2 && i != 7) set.first_guess_k[2 * i] = 0.5, set.first_guess_k[2 * i + 1] = -0.25;
  }
  const std::vector<GuessSource> sources = first_guess_sources(set, FirstGuess::automatic);
  EXPECT_EQ(sources[0], GuessSource::scan_position_mean);
  EXPECT_EQ(sources[1], GuessSource::given);
  EXPECT_EQ(sources[7], GuessSource::missing);
  EXPECT_EQ(first_guess_sources(set, FirstGuess::file)[0], GuessSource::missing);
  EXPECT_EQ(first_guess_sources(set, FirstGuess::scan_position_mean)[1], GuessSource::scan_position_mean);

  std::vector<GuessSource> used = sources;
  used[7] = GuessSource::none;
  const ObservationSet before = set;
  std::vector<std::string> notes;
  const FirstGuessCounts counts = subtract_first_guess(set, used, {}, notes);
  EXPECT_EQ(counts.given, 299U);
  EXPECT_EQ(counts.scan_position_mean, 300U);
  EXPECT_EQ(set.values[2], before.values[2] - 0.5);
  EXPECT_EQ(set.values[3], before.values[3] + 0.25);
  EXPECT_TRUE(set.first_guess_k.empty());
  EXPECT_NE(notes[0].find("299 observations have the first guess of their file, 300 the mean"), std::string::npos);
}

// AMSU-A and MHS in one set: each has means of its own, and what an instrument does not measure stays missing.
TEST(FirstGuess, KeepsInstrumentsApart) {
  ObservationSet set = test::random_observations(600, 2, 8), other = test::random_observations(600, 1, 9);
  set.instrument.assign(600, Instrument::amsua);
  other.instrument.assign(600, Instrument::mhs);
  set.value_kind = other.value_kind = ValueKind::brightness_temperature;
  for (double& value : other.values) value += 30;
  ObservationSet both = set;
  both.append(other);
  std::vector<std::string> notes;
  subtract(both, {}, notes);
  subtract(set, {}, notes);
  subtract(other, {}, notes);
  EXPECT_TRUE(notes.empty());
  for (std::size_t i = 0; i < 600; ++i) {
    EXPECT_EQ(both.values_of(i)[1], set.values_of(i)[1]);
    EXPECT_TRUE(std::isnan(both.values_of(i)[2]));
    EXPECT_EQ(both.values_of(600 + i)[2], other.values[i]);
  }
}

}  // namespace
}  // namespace thin
