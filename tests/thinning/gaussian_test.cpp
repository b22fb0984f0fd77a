#include "libthin/thinning/gaussian.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

using Options = std::vector<std::pair<std::string, OptionValue>>;

// The filter by its documentation: cells by their edges, of each the best by comparing all.
struct Oracle {
  double mesh_km = 500;
  bool reduced = true, nearest = false, by_mesh = false, round_meridian = false, maximum = false, latest = false;
  std::int64_t time_min_ms = 0, time_mesh_ms = 0, time_bins = 1;

  Options options() const {
    Options all = {{"horizontal_mesh", mesh_km},
                   {"use_reduced_horizontal_grid", reduced},
                   {"round_horizontal_bin_count_to_nearest", nearest},
                   {"partition_longitude_bins_using_mesh", by_mesh},
                   {"define_meridian_20000_km", round_meridian},
                   {"distance_norm", std::string(maximum ? "maximum" : "geodesic")},
                   {"tiebreaker_pick_latest", latest},
                   {"priority_variable", std::string("rank")}};
    if (time_mesh_ms > 0) {
      all.emplace_back("time_mesh", std::string("PT1M"));
      all.emplace_back("time_min", std::string("1970-01-01T00:00:30Z"));
      all.emplace_back("time_max", std::string("1970-01-01T00:03:20Z"));
    }
    return all;
  }

  static int edge_below(double value, double first, double width, int count) {
    int place = 0;
    while (place < count - 1 && value >= first + (place + 1) * width) ++place;
    return place;
  }

  int counted(double count) const {
    return std::max(1, static_cast<int>(nearest ? std::round(count) : std::floor(count)));
  }

  struct Cell {
    std::array<int, 3> place;
    double distance;
  };
  Cell cell_of(const ObservationSet& set, std::size_t i) const {
    const double meridian_km = std::numbers::pi * 6371.0, rad = std::numbers::pi / 180;
    const int bands = counted((round_meridian ? 20000 : meridian_km) / mesh_km);
    const double latitude = set.latitude_deg[i], longitude = std::fmod(set.longitude_deg[i] + 360, 360);
    const int band = edge_below(latitude, -90, 180.0 / bands, bands);
    const double middle = -90 + (band + 0.5) * 180.0 / bands;
    const int boxes =
        !reduced ? 2 * bands : counted((by_mesh ? 2 * meridian_km / mesh_km : 2 * bands) * std::cos(middle * rad));
    const int box = edge_below(longitude, 0, 360.0 / boxes, boxes);
    const double centre = (box + 0.5) * 360.0 / boxes;
    const double seconds = static_cast<double>(set.time_ms[i] - time_min_ms), mesh = static_cast<double>(time_mesh_ms);
    const int time = time_mesh_ms ? edge_below(seconds, 0, mesh, static_cast<int>(time_bins)) : 0;
    double distance = std::acos(
        std::min(1.0, std::sin(latitude * rad) * std::sin(middle * rad) +
                          std::cos(latitude * rad) * std::cos(middle * rad) * std::cos((longitude - centre) * rad)));
    if (maximum)
      distance = std::max(std::abs(latitude - middle) * bands / 180, std::abs(longitude - centre) * boxes / 360);
    if (maximum && time_mesh_ms) distance = std::max(distance, std::abs(seconds / mesh - (time + 0.5)));
    return {{band, box, time}, distance};
  }

  Retained retained(const ObservationSet& set) const {
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < set.size(); ++i) cells.push_back(cell_of(set, i));
    const std::vector<double>& rank = set.variables.at("rank");
    Retained result;
    for (std::uint32_t i = 0; i < set.size(); ++i) {
      bool is_best = true;
      for (std::uint32_t j = 0; j < set.size(); ++j)
        if (i != j && cells[i].place == cells[j].place)
          is_best = is_best && (rank[i] > rank[j] || (rank[i] == rank[j] && cells[i].distance < cells[j].distance));
      if (is_best) result.push_back(i);
    }
    return result;
  }
};

ObservationSet ranked_observations(std::size_t count, unsigned seed, test::Region region) {
  ObservationSet set = test::random_observations(count, 1, seed, region);
  for (std::size_t i = 0; i < count; ++i) set.variables["rank"].push_back(static_cast<double>(i % 17 == 0));
  return set;
}

TEST(Gaussian, IsWhatItsDocumentationSays) {
  for (const test::Region region : {test::Region{-90, 90, -180, 180}, test::Region{-20, 20, 170, 190}}) {
    const ObservationSet set = ranked_observations(600, 1, region);
    for (int bits = 0; bits < 64; ++bits) {
      Oracle oracle{.mesh_km = bits % 2 ? 700.0 : 433.0,
                    .reduced = (bits & 2) != 0,
                    .nearest = (bits & 4) != 0,
                    .by_mesh = (bits & 8) != 0,
                    .round_meridian = (bits & 16) != 0,
                    .maximum = (bits & 32) != 0};
      EXPECT_EQ(test::retained(test::thinner("gaussian", oracle.options()), set), oracle.retained(set)) << bits;
    }
  }
}

TEST(Gaussian, CutsTimeIntoCells) {
  const ObservationSet set = ranked_observations(1200, 2, {-20, 20, 0, 60});  // four minutes
  for (const bool maximum : {false, true}) {
    Oracle oracle{.mesh_km = 1500, .maximum = maximum, .time_min_ms = 30000, .time_mesh_ms = 60000, .time_bins = 3};
    EXPECT_EQ(test::retained(test::thinner("gaussian", oracle.options()), set), oracle.retained(set));
  }
  // By time alone: one of each of the three cells.
  Oracle only_time{.mesh_km = -1, .time_mesh_ms = 60000};
  EXPECT_EQ(test::retained(test::thinner("gaussian", only_time.options()), set).size(), 3U);
}

TEST(Gaussian, DefaultsAreDegrees) {
  ObservationSet set = test::random_observations(0, 1, 3);
  for (const double latitude : {0.1, 0.6, 1.4, 1.5})
    set.push_back({.latitude_deg = latitude, .longitude_deg = 0.5, .source = {}}, std::vector<double>{0});
  EXPECT_EQ(test::retained(test::thinner("gaussian", {}), set), (Retained{1, 3}));
}

TEST(Gaussian, BreaksTiesByIndexOrByTime) {
  ObservationSet set = test::random_observations(0, 1, 4);
  for (const std::int64_t time_ms : {5, 9, 9, 7})
    set.push_back({.latitude_deg = 0.3, .longitude_deg = 0.3, .time_ms = time_ms, .source = {}},
                  std::vector<double>{0});
  EXPECT_EQ(test::retained(test::thinner("gaussian", {}), set), Retained{0});
  EXPECT_EQ(test::retained(test::thinner("gaussian", {{"tiebreaker_pick_latest", true}}), set), Retained{1});
}

TEST(Gaussian, NamesTheWrongOption) {
  const auto problem_key = [](const Options& options) {
    const auto conflict = test::thinner("gaussian", options).conflict();
    return conflict ? conflict->key : "";
  };
  EXPECT_EQ(problem_key({}), "");
  EXPECT_EQ(problem_key({{"horizontal_mesh", 0.01}}), "horizontal_mesh");
  EXPECT_EQ(problem_key({{"horizontal_mesh", -1.0}}), "");
  EXPECT_EQ(problem_key({{"time_mesh", std::string("1 hour")}}), "time_mesh");
  EXPECT_EQ(problem_key({{"time_min", std::string("noon")}}), "time_min");
  EXPECT_EQ(problem_key({{"time_max", std::string("noon")}}), "time_max");
  EXPECT_EQ(problem_key({{"time_mesh", std::string("PT1S")},
                         {"time_min", std::string("1970-01-01")},
                         {"time_max", std::string("2020-01-01")}}),
            "time_mesh");
}

TEST(Gaussian, SaysThatTimeDoesNotCount) {
  const ObservationSet set = test::random_observations(10, 1, 5);
  const Result<Choice> choice = test::thinner("gaussian", {{"time_mesh", std::string("PT1H")}}).thin(set);
  ASSERT_TRUE(choice);
  ASSERT_EQ(choice->notes.size(), 1U);
  EXPECT_NE(choice->notes[0].find("time_min"), std::string::npos);
}

}  // namespace
}  // namespace thin
