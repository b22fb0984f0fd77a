#pragma once

#include <cstddef>

#include "libthin/thinning/thinning_method.h"

namespace thin {

// A recursive octree whose cells are split while a statistical test says that one observation does not stand well for
// all of a cell; of each leaf the observation nearest to its centre is retained (Ramachandran et al. 2005, as thesis
// 6.2 tells it; the thesis leaves the test open).
//
// The root is the cube of 12,800 km around the Earth, the same for all sets. The test is chi-squared for the variance:
// were the observations of a cell one value and noise of standard deviation value_tolerance, then the sum over
// observations and channels of ((f - mean) / value_tolerance)² would be distributed as chi-squared with
// (observations - 1) x channels degrees of freedom; where so large a sum has a probability below `significance`, the
// cell is split. Cells larger than maximum_cell_km are split without a test, halves smaller than minimum_cell_km are
// not made. Instruments that are thinned jointly have each a tree. O(n x depth x channels).
class Octree : public ThinningMethod {
 public:
  Traits traits() const override { return {.stops_at_count = false, .uses_places = false}; }
  void declare_options(OptionTable& table) override;
  std::optional<Conflict> conflict() const override;
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  struct Cell;
  bool is_to_be_split(const ThinningInput& input, const Cell& cell) const;

  double value_tolerance_k_ = 0.4;
  double significance_ = 0.05;
  double minimum_cell_km_ = 50;
  double maximum_cell_km_ = 800;
};

// The probability that chi-squared with so many degrees of freedom exceeds `sum`, by the approximation of Wilson and
// Hilferty 1931: within 0.01, and within 0.001 from 10 degrees of freedom on. REQUIRES: degrees_of_freedom >= 1, sum >=
// 0
double probability_of_more(double sum, double degrees_of_freedom);

}  // namespace thin
