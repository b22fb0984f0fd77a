#include "libthin/foundation/principal_axes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace thin {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void orient(Eigen::Ref<Eigen::VectorXd> axis) {
  Eigen::Index largest = 0;
  // Components that differ by rounding only count as equal: the first of them decides.
  for (Eigen::Index i = 1; i < axis.size(); ++i)
    if (std::abs(axis[i]) > std::abs(axis[largest]) * (1 + 1e-9)) largest = i;
  if (axis[largest] < 0) axis = -axis;
}

}  // namespace

PrincipalAxes principal_axes(std::span<const double> coordinates, int dimension, std::span<const double> weights) {
  assert(dimension >= 1 && coordinates.size() % static_cast<std::size_t>(dimension) == 0);
  const auto rows = static_cast<Eigen::Index>(coordinates.size()) / dimension;
  assert(weights.empty() || static_cast<Eigen::Index>(weights.size()) == rows);
  const Eigen::Map<const RowMatrix> points(coordinates.data(), rows, dimension);
  const auto weight = [&](Eigen::Index row) { return weights.empty() ? 1.0 : weights[static_cast<std::size_t>(row)]; };

  // Plain loops: at three or four dimensions a temporary matrix for each point would take most of the time.
  double total_weight = 0;
  Eigen::VectorXd centroid = Eigen::VectorXd::Zero(dimension), deviation(dimension);
  for (Eigen::Index row = 0; row < rows; ++row) {
    total_weight += weight(row);
    for (Eigen::Index i = 0; i < dimension; ++i) centroid[i] += weight(row) * points(row, i);
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(dimension, dimension);  // its lower triangle
  if (total_weight > 0) {
    centroid /= total_weight;
    for (Eigen::Index row = 0; row < rows; ++row) {
      for (Eigen::Index i = 0; i < dimension; ++i) deviation[i] = points(row, i) - centroid[i];
      for (Eigen::Index i = 0; i < dimension; ++i)
        for (Eigen::Index j = 0; j <= i; ++j) covariance(i, j) += weight(row) * deviation[i] * deviation[j];
    }
    covariance /= total_weight;
  }

  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);  // ascending
  PrincipalAxes result{dimension, {centroid.begin(), centroid.end()}, {}, {}};
  for (Eigen::Index i = dimension; i-- > 0;) {
    Eigen::VectorXd axis = solver.eigenvectors().col(i);
    // The solver returns the coordinate axes of a zero matrix in ascending order too; here the first comes first.
    if (covariance.isZero(0)) axis = Eigen::VectorXd::Unit(dimension, dimension - 1 - i);
    orient(axis);
    result.variances.push_back(std::max(0.0, solver.eigenvalues()[i]));
    result.axes.insert(result.axes.end(), axis.begin(), axis.end());
  }
  return result;
}

}  // namespace thin
