#include "libemap/elevation/least_squares.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "libemap/elevation/grid_triangles.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

// A row of the matrix: a sample's barycentric weights at the corners of its triangle, and its height.
struct Equation {
  std::array<std::uint32_t, 3> unknowns;  // places in the map
  std::array<float, 3> weights;
  double height;
};

// Places are relative to the square's first corner; the diagonal is that of the canonical triangulation. Nothing where
// there is no triangle.
bool set_weights(const ElevationPatch& patch, std::uint32_t row, std::uint32_t column, double x, double y,
                 Equation& equation) {
  const std::uint32_t a = row * patch.columns + column, b = a + 1, d = a + patch.columns, c = d + 1;
  bool found = false;
  const auto try_triangle = [&](std::uint32_t corner, std::uint32_t along_x, std::uint32_t along_y, double u,
                                double v) {
    // corner at the right angle; u and v are the distances from it along its two legs.
    if (found || u + v > 1 || !patch.mask[corner] || !patch.mask[along_x] || !patch.mask[along_y]) return;
    found = true;
    equation.unknowns = {corner, along_x, along_y};
    equation.weights = {static_cast<float>(1 - u - v), static_cast<float>(u), static_cast<float>(v)};
  };
  const int supported = patch.mask[a] + patch.mask[b] + patch.mask[c] + patch.mask[d];
  if (supported < 3) return false;
  const bool rising = supported == 4 ? !falls(patch, a) : patch.mask[a] && patch.mask[c];
  if (rising) {  // triangles abc and acd, whose right angles are at b and d
    try_triangle(b, a, c, 1 - x, y);
    try_triangle(d, c, a, x, 1 - y);
  } else {  // abd and bcd
    try_triangle(a, b, d, x, y);
    try_triangle(c, d, b, 1 - x, 1 - y);
  }
  return found;
}

std::vector<Equation> equations_of(const ElevationPatch& fine, double fine_spacing, const ElevationPatch& patch,
                                   double spacing) {
  std::vector<Equation> equations;
  for (std::uint32_t row = 0; row < fine.rows; ++row)
    for (std::uint32_t column = 0; column < fine.columns; ++column) {
      const std::size_t place = std::size_t{row} * fine.columns + column;
      if (!fine.mask[place]) continue;
      const double x = column * fine_spacing / spacing, y = row * fine_spacing / spacing;
      const auto square_column = static_cast<std::uint32_t>(x), square_row = static_cast<std::uint32_t>(y);
      if (square_column + 1 >= patch.columns || square_row + 1 >= patch.rows) continue;
      Equation equation{{}, {}, fine.elevation[place]};
      if (set_weights(patch, square_row, square_column, x - square_column, y - square_row, equation))
        equations.push_back(equation);
    }
  return equations;
}

double interpolated(const Equation& equation, const std::vector<double>& x) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += double{equation.weights[i]} * x[equation.unknowns[i]];
  return sum;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Conjugate gradients on A'A x = A'b.
void minimise(const std::vector<Equation>& equations, const FittingOptions& options, std::vector<double>& x) {
  std::vector<double> residual(x.size(), 0), product(x.size());
  for (const Equation& equation : equations) {
    const double missing = equation.height - interpolated(equation, x);
    for (std::size_t i = 0; i < 3; ++i) residual[equation.unknowns[i]] += double{equation.weights[i]} * missing;
  }
  std::vector<double> direction = residual;
  double norm = dot(residual, residual);
  const double enough = options.tolerance * options.tolerance * norm;
  for (int iteration = 0; iteration < options.iterations && norm > enough; ++iteration) {
    product.assign(x.size(), 0);
    for (const Equation& equation : equations) {
      const double value = interpolated(equation, direction);
      for (std::size_t i = 0; i < 3; ++i) product[equation.unknowns[i]] += double{equation.weights[i]} * value;
    }
    const double curvature = dot(direction, product);
    if (!(curvature > 0)) break;
    const double step = norm / curvature;
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] += step * direction[i];
      residual[i] -= step * product[i];
    }
    const double next = dot(residual, residual);
    for (std::size_t i = 0; i < x.size(); ++i) direction[i] = residual[i] + next / norm * direction[i];
    norm = next;
  }
}

}  // namespace

double fitting_spacing(double spacing, double samples_per_unknown) {
  return spacing / std::sqrt(samples_per_unknown);
}

void fit_elevations(const ElevationMaps& fine, ElevationMaps& maps, const FittingOptions& options) {
  assert(fine.patches.size() == maps.patches.size());
  thin::parallel_ranges(maps.patches.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      minimise(equations_of(fine.patches[i], fine.spacing, maps.patches[i], maps.spacing), options,
               maps.patches[i].elevation);
  });
}

}  // namespace emap
