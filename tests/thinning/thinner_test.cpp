#include "libthin/thinning/thinner.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "libthin/observations/geodesy.h"
#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

TEST(Shares, AreInProportionAndAddUp) {
  EXPECT_EQ(shares_of(10, {50, 30, 20}), (std::vector<std::size_t>{5, 3, 2}));
  EXPECT_EQ(shares_of(2, {1, 1, 1}), (std::vector<std::size_t>{1, 1, 0}));
  EXPECT_EQ(shares_of(6, {1, 2, 3}), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(shares_of(0, {5, 0}), (std::vector<std::size_t>{0, 0}));
  EXPECT_EQ(shares_of(7, {10, 1, 1}), (std::vector<std::size_t>{6, 1, 0}));
}

std::size_t retained_of(std::size_t n, const OptionValue& value, const char* option) {
  const Thinner thinner = test::thinner("grid_eea", {{option, value}});
  return test::retained(thinner, test::random_observations(n, 1, 1)).size();
}

TEST(Thinner, RetainsTheNumberOrTheShareAskedFor) {
  EXPECT_EQ(retained_of(7, std::int64_t{10}, "retain_count"), 7U);
  EXPECT_EQ(retained_of(100, std::int64_t{10}, "retain_count"), 10U);
  EXPECT_EQ(retained_of(100, std::int64_t{0}, "retain_count"), 0U);
  EXPECT_EQ(retained_of(0, 0.1, "retain_fraction"), 0U);
  EXPECT_EQ(retained_of(1, 0.1, "retain_fraction"), 1U);
  EXPECT_EQ(retained_of(26, 0.1, "retain_fraction"), 3U);
  EXPECT_EQ(retained_of(300, 1.0, "retain_fraction"), 300U);
  EXPECT_EQ(retained_of(5, 0.0, "retain_fraction"), 0U);
}

TEST(Thinner, WantsExactlyOneNumber) {
  EXPECT_TRUE(test::thinner("eea", {}).conflict());
  EXPECT_FALSE(test::thinner("eea", {{"retain_count", std::int64_t{5}}}).conflict());
  EXPECT_TRUE(test::thinner("eea", {{"retain_count", std::int64_t{5}}, {"retain_fraction", 0.5}}).conflict());
  EXPECT_FALSE(test::thinner("eea", {{"max_estimation_error", 0.5}}).conflict());
  EXPECT_FALSE(test::thinner("stepwise", {}).conflict());
}

TEST(Thinner, RefusesNotANumberByObservationAndChannel) {
  ObservationSet set = test::random_observations(10, 2, 11);
  set.values[7] = std::numeric_limits<double>::quiet_NaN();
  for (const MethodEntry& entry : thinning_methods()) {
    const Result<Choice> choice = test::thinner(entry.name, {}).thin(set);
    ASSERT_FALSE(choice) << entry.name;
    EXPECT_EQ(choice.error().kind, ErrorKind::input);
    EXPECT_NE(choice.error().message.find("observation 3 has no usable value in channel 2"), std::string::npos)
        << choice.error().message;
  }
}

TEST(Thinner, ThinsCategoriesApart) {
  ObservationSet set = test::random_observations(200, 1, 2);
  std::vector<double>& category = set.variables["flag"];
  for (std::size_t i = 0; i < 200; ++i) category.push_back(i % 4 == 0 ? 7.0 : 3.0);
  const Thinner thinner =
      test::thinner("grid_eea", {{"retain_count", std::int64_t{20}}, {"category_variable", std::string("flag")}});
  const Retained retained = test::retained(thinner, set);
  ASSERT_EQ(retained.size(), 20U);
  // Each category as if it were alone.
  for (const bool rare : {true, false}) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 200; ++i)
      if ((i % 4 == 0) == rare) indices.push_back(i);
    const Retained alone =
        test::retained(test::thinner("grid_eea", {{"retain_count", std::int64_t{rare ? 5 : 15}}}), set.select(indices));
    for (const std::uint32_t i : alone) EXPECT_TRUE(std::binary_search(retained.begin(), retained.end(), indices[i]));
  }
}

TEST(Thinner, NamesTheVariablesThatThereAre) {
  ObservationSet set = test::random_observations(20, 1, 3);
  set.variables["quality"].assign(20, 1.0);
  const Result<Choice> choice =
      test::thinner("grid_eea", {{"retain_count", std::int64_t{2}}, {"priority_variable", std::string("qualty")}})
          .thin(set);
  ASSERT_FALSE(choice);
  EXPECT_EQ(choice.error().kind, ErrorKind::configuration);
  EXPECT_NE(choice.error().message.find("did you mean \"quality\"?"), std::string::npos) << choice.error().message;
}

TEST(Thinner, RetainsByPriority) {
  ObservationSet set = test::random_observations(300, 1, 4);
  std::vector<double>& priority = set.variables["priority"];
  for (std::size_t i = 0; i < 300; ++i)
    priority.push_back(i % 10 == 0 ? 1.0 : i == 1 ? std::numeric_limits<double>::quiet_NaN() : 0.0);
  for (const char* method : {"eea", "grid_eea", "top_down_eea", "grid_top_down_eea"}) {
    const Retained retained = test::retained(
        test::thinner(method, {{"retain_count", std::int64_t{30}}, {"priority_variable", std::string("priority")}}),
        set);
    ASSERT_EQ(retained.size(), 30U);
    for (const std::uint32_t i : retained) EXPECT_EQ(priority[i], 1.0) << method;
  }
}

TEST(Thinner, KeepsEveryMethodsChoiceApart) {
  const ObservationSet set = test::random_observations(800, 2, 5);
  for (const MethodEntry& entry : thinning_methods()) {
    Thinner thinner = test::thinner(entry.name, {{"retain_fraction", 0.3}, {"value_tolerance", 0.3}});
    OptionTable table;
    thinner.declare_options(table);
    const Option* option = table.find("min_separation_km");
    if (!option) continue;
    ASSERT_FALSE(option->assign(100.0));
    const Retained retained = test::retained(thinner, set);
    EXPECT_GT(retained.size(), 50U) << entry.name;
    for (std::size_t i = 0; i < retained.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_GE(chord_km(set.position_km[retained[i]], set.position_km[retained[j]]), 100) << entry.name;
  }
}

// Two instruments, of which the one measures a flat field and the other a rough one.
ObservationSet two_instruments() {
  ObservationSet amsua = test::random_observations(200, 2, 6), mhs = test::random_observations(200, 1, 7);
  amsua.instrument.assign(200, Instrument::amsua);
  mhs.instrument.assign(200, Instrument::mhs);
  for (double& value : amsua.values) value *= 0.1;
  amsua.append(mhs);
  return amsua.select(canonical_order(amsua));
}

std::size_t count_of(const Retained& retained, const ObservationSet& set, Instrument whose) {
  return static_cast<std::size_t>(
      std::count_if(retained.begin(), retained.end(), [&](std::uint32_t i) { return set.instrument[i] == whose; }));
}

TEST(Thinner, ThinsInstrumentsApartOrJointly) {
  const ObservationSet set = two_instruments();
  for (const char* method : {"eea", "grid_eea", "top_down_eea", "grid_top_down_eea"}) {
    SCOPED_TRACE(method);
    const Retained apart = test::retained(test::thinner(method, {{"retain_count", std::int64_t{60}}}), set);
    EXPECT_EQ(count_of(apart, set, Instrument::amsua), 30U);
    const std::vector<std::pair<std::string, OptionValue>> joint = {{"retain_count", std::int64_t{60}},
                                                                    {"instruments", std::string("joint")}};
    const Retained jointly = test::retained(test::thinner(method, joint), set);
    ASSERT_EQ(jointly.size(), 60U);
    EXPECT_LT(count_of(jointly, set, Instrument::amsua), 15U);
    // In units of its error the flat one counts as much as the other.
    auto weighted = joint;
    weighted.emplace_back("observation_errors", std::vector<double>{0.1, 0.1, 1.0});
    EXPECT_GT(count_of(test::retained(test::thinner(method, weighted), set), set, Instrument::amsua), 20U);
  }
}

TEST(Thinner, WantsAnErrorForEachChannel) {
  const Result<Choice> choice =
      test::thinner("eea", {{"retain_count", std::int64_t{2}}, {"observation_errors", std::vector<double>{1.0}}})
          .thin(two_instruments());
  ASSERT_FALSE(choice);
  EXPECT_NE(choice.error().message.find("1 numbers, but 3 channels are in use (1 2 1)"), std::string::npos)
      << choice.error().message;
}

TEST(Thinner, TimeKeepsApartWhatIsNearInSpace) {
  // The same places, six hours later, with other values: in 3D they average, in 4D both are needed.
  ObservationSet set = test::random_observations(100, 1, 8);
  ObservationSet later = set;
  for (std::size_t i = 0; i < later.size(); ++i) {
    later.time_ms[i] += 6 * 3'600'000;
    later.values[i] = -later.values[i];
  }
  set.append(later);
  const auto error_left = [&](double time_scale) {
    const Retained retained = test::retained(
        test::thinner("eea", {{"retain_count", std::int64_t{100}}, {"time_scale_km_per_hour", time_scale}}), set);
    std::size_t early = 0;
    for (const std::uint32_t i : retained) early += i < 100;
    return early;
  };
  EXPECT_NEAR(static_cast<double>(error_left(500)), 50, 10);
}

}  // namespace
}  // namespace thin
