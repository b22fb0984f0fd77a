#include "libthin/analysis/confidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace thin {
namespace {

TEST(Confidence, StudentsQuantiles) {
  // Tables of the t distribution.
  EXPECT_NEAR(student_t_975(1), 12.7062, 1e-4);
  EXPECT_NEAR(student_t_975(10), 2.2281, 1e-4);
  EXPECT_NEAR(student_t_975(11), 2.2010, 2e-4);
  EXPECT_NEAR(student_t_975(30), 2.0423, 1e-4);
  EXPECT_NEAR(student_t_975(100000), 1.9600, 1e-4);
}

TEST(Confidence, MeanWithInterval) {
  const std::vector<double> numbers = {1, 2, 3, 4, 5};
  const MeanWithInterval mean = mean_with_interval(numbers);
  EXPECT_DOUBLE_EQ(mean.mean, 3);
  EXPECT_NEAR(mean.half_width, 2.77645 * std::sqrt(2.5 / 5), 1e-9);
  EXPECT_EQ(mean_with_interval(std::vector<double>{7}).half_width, 0);
}

TEST(Confidence, HoldsTheTruthInNineteenOfTwenty) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(10, 2);
  int holds = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<double> numbers;
    for (int i = 0; i < 4; ++i) numbers.push_back(normal(random));
    const MeanWithInterval mean = mean_with_interval(numbers);
    if (std::abs(mean.mean - 10) <= mean.half_width) ++holds;
  }
  EXPECT_NEAR(holds / 4000.0, 0.95, 0.015);
}

}  // namespace
}  // namespace thin
