#pragma once

// Optimal interpolation from its definition: the whole matrix, solved by Cholesky's method.

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "libthin/observations/geodesy.h"

namespace thin::test {

// Gaspari and Cohn 1999, eq. 4.10, with c = sqrt(10/3) L: two half-widths c of support.
inline double gaspari_cohn(double distance_km, double length_km) {
  const double z = distance_km / (std::sqrt(10.0 / 3.0) * length_km);
  if (z >= 2) return 0;
  if (z <= 1) return -0.25 * std::pow(z, 5) + 0.5 * std::pow(z, 4) + 0.625 * std::pow(z, 3) - 5.0 / 3 * z * z + 1;
  return std::pow(z, 5) / 12 - 0.5 * std::pow(z, 4) + 0.625 * std::pow(z, 3) + 5.0 / 3 * z * z - 5 * z + 4 -
         2 / (3 * z);
}

// Lower triangle with G Gᵀ = A, row by row; nothing where A is not positive definite.
inline std::optional<std::vector<double>> cholesky(std::vector<double> a, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i == j && sum <= 0) return std::nullopt;
      a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
    }
  return a;
}

inline std::vector<double> solved(const std::vector<double>& g, std::vector<double> x) {
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= g[i * n + k] * x[k];
    x[i] /= g[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= g[k * n + i] * x[k];
    x[i] /= g[i * n + i];
  }
  return x;
}

class DenseInterpolation {
 public:
  DenseInterpolation(std::span<const Vector3> observations, std::span<const Vector3> targets, double length_km,
                     double error_ratio)
      : n_(observations.size()) {
    std::vector<double> matrix;
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j)
        matrix.push_back(gaspari_cohn(chord_km(observations[i], observations[j]), length_km) +
                         (i == j ? error_ratio * error_ratio : 0));
    factor_ = cholesky(std::move(matrix), n_);
    for (const Vector3& target : targets) {
      rows_.emplace_back();
      for (const Vector3& observation : observations)
        rows_.back().push_back(gaspari_cohn(chord_km(target, observation), length_km));
    }
  }

  bool is_positive_definite() const { return factor_.has_value(); }

  // Of one channel, at each target.
  std::vector<double> estimate(const std::vector<double>& values) const {
    const std::vector<double> weights = solved(*factor_, values);
    std::vector<double> estimates;
    for (const auto& row : rows_) {
      estimates.push_back(0);
      for (std::size_t i = 0; i < n_; ++i) estimates.back() += row[i] * weights[i];
    }
    return estimates;
  }

  // Of the analysis error, in units of the background's variance, at each target.
  std::vector<double> error_variances() const {
    std::vector<double> variances;
    for (const auto& row : rows_) {
      const std::vector<double> weights = solved(*factor_, row);
      variances.push_back(1);
      for (std::size_t i = 0; i < n_; ++i) variances.back() -= row[i] * weights[i];
    }
    return variances;
  }

 private:
  std::size_t n_;
  std::optional<std::vector<double>> factor_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace thin::test
