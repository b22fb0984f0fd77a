// Every file of tests/cases: a configuration of [thinning], observations, and which of them must be retained.

#include <gtest/gtest.h>

#include <filesystem>

#include "libthin/foundation/configuration.h"
#include "libthin/thinning/thinner.h"

namespace thin {
namespace {

struct Case {
  std::vector<double> latitude_deg, longitude_deg, value_k;
  std::vector<int> scan_line, field_of_view, platform, retained;
  std::string why;

  void declare(OptionTable& table) {
    table.add("latitude_deg", latitude_deg, {});
    table.add("longitude_deg", longitude_deg, {});
    table.add("value_k", value_k, {});
    table.add("scan_line", scan_line, {});
    table.add("field_of_view", field_of_view, {});
    table.add("platform", platform, {});
    table.add("retained", retained, {});
    table.add("why", why, {});
  }

  ObservationSet observations() const {
    ObservationSet set;
    set.channels = {1};
    set.value_kind = ValueKind::innovation;
    const auto number = [](const std::vector<int>& numbers, std::size_t i) {
      return i < numbers.size() ? numbers[i] : kUnknownNumber;
    };
    for (std::size_t i = 0; i < latitude_deg.size(); ++i)
      set.push_back({.latitude_deg = latitude_deg[i],
                     .longitude_deg = longitude_deg[i],
                     .time_ms = static_cast<std::int64_t>(i),
                     .platform = number(platform, i),
                     .scan_line = number(scan_line, i),
                     .field_of_view = number(field_of_view, i),
                     .source = {}},
                    std::span(&value_k[i], 1));
    return set;
  }
};

TEST(Cases, RetainWhatTheySay) {
  std::size_t count = 0;
  for (const auto& file : std::filesystem::directory_iterator(PROJECT_FOLDER "/tests/cases")) {
    SCOPED_TRACE(file.path().filename().string());
    ++count;
    Result<Configuration> configuration = Configuration::read(file.path());
    ASSERT_TRUE(configuration) << configuration.error().message;
    const auto method_name = configuration->peek_text("thinning", "method");
    ASSERT_TRUE(method_name);
    const MethodEntry* entry = find_thinning_method(*method_name);
    ASSERT_TRUE(entry) << *method_name;
    Thinner thinner(*entry);
    OptionTable thinning_table, case_table;
    std::string name;
    thinning_table.add("method", name, {});
    thinner.declare_options(thinning_table);
    Case expected;
    expected.declare(case_table);
    configuration->read_section("thinning", thinning_table);
    configuration->read_section("case", case_table);
    const Result<void> read = configuration->finish();
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_FALSE(thinner.conflict());

    const Result<Choice> choice = thinner.thin(expected.observations());
    ASSERT_TRUE(choice) << choice.error().message;
    EXPECT_EQ(std::vector<int>(choice->retained.begin(), choice->retained.end()), expected.retained) << expected.why;
  }
  EXPECT_GE(count, thinning_methods().size());
}

}  // namespace
}  // namespace thin
