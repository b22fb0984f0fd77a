#include "libthin/preparation/duplicates.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/support/preparation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Clusters of observations of few fields of view around the limits of distance and time, from three files.
ObservationSet crowded(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  ObservationSet set;
  set.channels = {1, 2};
  for (std::size_t i = 0; i < count; ++i) {
    ObservationSet::Entry entry;
    entry.latitude_deg = 80 + 0.4 * unit(random);
    entry.longitude_deg = 179.5 + 3 * unit(random);
    entry.time_ms = static_cast<std::int64_t>(unit(random) * 1'000'000);
    entry.platform = 206 + static_cast<int>(unit(random) * 2);
    entry.instrument = unit(random) < 0.8 ? Instrument::amsua : Instrument::mhs;
    entry.field_of_view = 1 + static_cast<int>(unit(random) * 3);
    entry.source = {static_cast<std::uint32_t>(unit(random) * 3), 0, static_cast<std::uint32_t>(i)};
    const double values[] = {unit(random) < 0.3 ? kMissing : 200 + unit(random), 250};
    set.push_back(entry, values);
  }
  return set.select(canonical_order(set));
}

std::vector<bool> kept(const ObservationSet& set, const DuplicateOptions& options,
                       std::span<const std::string> names = {}) {
  std::vector<bool> result;
  for (const Duplicate duplicate : find_duplicates(set, names, options)) result.push_back(duplicate == Duplicate::none);
  return result;
}

TEST(Duplicates, AreThoseOfEveryPairLookedAt) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const ObservationSet set = crowded(250, seed);
    DuplicateOptions options;
    options.preference = {};
    const auto earlier = [](std::size_t a, std::size_t b) { return a < b; };
    const std::vector<bool> expected = test::kept_by_brute_force(set, 10, 6, earlier);
    EXPECT_EQ(kept(set, options), expected);
    EXPECT_GT(std::count(expected.begin(), expected.end(), false), 10);
  }
}

TEST(Duplicates, GoByTheRulesInTheirOrder) {
  const std::vector<std::string> names = {"station.bufr", "global_b.bufr", "global_a.bufr"};
  for (unsigned seed = 11; seed <= 14; ++seed) {
    const ObservationSet set = crowded(250, seed);
    DuplicateOptions options;
    options.file_order = {"global*"};
    const auto missing = [&](std::size_t i) { return std::isnan(set.values_of(i)[0]); };
    const auto is_global = [&](std::size_t i) { return set.source[i].file != 0; };
    const auto better = [&](std::size_t a, std::size_t b) {
      return std::tuple(!is_global(a), missing(a), set.time_ms[a], a) <
             std::tuple(!is_global(b), missing(b), set.time_ms[b], b);
    };
    EXPECT_EQ(kept(set, options, names), test::kept_by_brute_force(set, 10, 6, better));

    options.preference = {DuplicatePreference::latest};
    const auto later = [&](std::size_t a, std::size_t b) {
      return std::tuple(-set.time_ms[a], a) < std::tuple(-set.time_ms[b], b);
    };
    EXPECT_EQ(kept(set, options, names), test::kept_by_brute_force(set, 10, 6, later));
  }
}

TEST(Duplicates, OfTheSameMessageTwiceAreExact) {
  ObservationSet set = test::random_observations(30, 2, 1);
  ObservationSet again = set;
  for (SourceReference& source : again.source) source.file = 1;
  again.values[6] += 0.01;  // one differs
  set.append(again);
  set = set.select(canonical_order(set));
  std::size_t exact = 0, near = 0;
  for (const Duplicate duplicate : find_duplicates(set, {}, {})) {
    exact += duplicate == Duplicate::exact;
    near += duplicate == Duplicate::near;
  }
  EXPECT_EQ(exact, 29U);
  EXPECT_EQ(near, 1U);
}

// Consecutive fields of view and lines of real swaths are no duplicates, whatever the instrument.
TEST(Duplicates, TheLimitsBelongToThem) {
  ObservationSet set;
  set.channels = {1};
  const double value[] = {250};
  const auto add = [&](double latitude, std::int64_t time_ms) {
    set.push_back({.latitude_deg = latitude, .time_ms = time_ms, .platform = 4, .field_of_view = 7, .source = {}},
                  value);
  };
  add(0, 0);
  add(0, 360'000);
  EXPECT_EQ(find_duplicates(set, {}, {})[1], Duplicate::near);
  set = {};
  set.channels = {1};
  add(0, 0);
  add(0, 360'001);
  add(0.0905, 0);  // 10.007 km
  for (const Duplicate duplicate : find_duplicates(set, {}, {})) EXPECT_EQ(duplicate, Duplicate::none);
}

TEST(Duplicates, StayWhereTheyShould) {
  ObservationSet set = test::random_observations(30, 2, 1);
  set.append(set);
  DuplicateOptions options;
  options.remove = false;
  for (const Duplicate duplicate : find_duplicates(set, {}, options)) EXPECT_EQ(duplicate, Duplicate::none);
  EXPECT_TRUE(find_duplicates({}, {}, {}).empty());
}

TEST(Duplicates, KnowTheirRulesByName) {
  DuplicateOptions options;
  OptionTable table;
  options.declare(table);
  const auto problem = table.find("duplicate_preference")->assign(std::vector<std::string>{"latest", "newest"});
  EXPECT_EQ(problem, "has the unknown rule \"newest\"; known are file_order, fewest_missing, earliest, latest");
  EXPECT_FALSE(table.find("duplicate_preference")->assign(std::vector<std::string>{"latest"}));
  EXPECT_EQ(options.preference, std::vector{DuplicatePreference::latest});
  EXPECT_EQ(table.find("duplicate_preference")->current_value(), "[\"latest\"]");
}

}  // namespace
}  // namespace thin
