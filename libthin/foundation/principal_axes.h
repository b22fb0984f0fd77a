#pragma once

// Principal axes of a point set: centroid, and the eigenvectors of its covariance by descending eigenvalue.
//
// O(n d² + d³). Each axis is oriented so that its largest component (the first of them where several are equal) is
// positive, so that equal input gives equal axes.

#include <span>
#include <vector>

namespace thin {

struct PrincipalAxes {
  int dimension = 0;
  std::vector<double> centroid;   // dimension
  std::vector<double> variances;  // dimension, descending, >= 0: mean squared deviation along each axis
  std::vector<double> axes;       // dimension x dimension, one unit axis a row

  std::span<const double> axis(int i) const {
    return std::span<const double>(axes).subspan(static_cast<std::size_t>(i) * dimension, dimension);
  }
};

// coordinates: n x dimension, row by row. weights: n, or empty for all 1.
// Without points, or without weight, the centroid is the origin, the variances 0 and the axes the coordinate axes.
// REQUIRES: dimension >= 1, weights >= 0
PrincipalAxes principal_axes(std::span<const double> coordinates, int dimension, std::span<const double> weights = {});

}  // namespace thin
