#include "libthin/estimation/estimation_error.h"

#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

// est(q), and from it the squared difference of the two estimates, per channel.
class PointError {
 public:
  explicit PointError(std::size_t channels) : full_(channels), thinned_(channels) {}

  void evaluate(const NeighbourhoodTable& table, std::size_t q, std::span<const double> values,
                std::span<const std::uint8_t> retained, std::span<const std::uint8_t> full, double* squared,
                double* full_squared) {
    const std::size_t channels = full_.size();
    std::fill(full_.begin(), full_.end(), 0.0);
    std::fill(thinned_.begin(), thinned_.end(), 0.0);
    double full_weight = 0;
    double thinned_weight = 0;
    for (std::uint64_t entry = table.row_begin[q]; entry < table.row_begin[q + 1]; ++entry) {
      const std::uint32_t p = table.observation[entry];
      const double weight = table.weight[entry];
      if (full.empty() || full[p]) {
        full_weight += weight;
        for (std::size_t c = 0; c < channels; ++c) full_[c] += weight * values[p * channels + c];
      }
      if (!retained[p]) continue;
      thinned_weight += weight;
      for (std::size_t c = 0; c < channels; ++c) thinned_[c] += weight * values[p * channels + c];
    }
    for (std::size_t c = 0; c < channels; ++c) {
      const double whole = full_weight > 0 ? full_[c] / full_weight : 0.0;
      const double thinned = thinned_weight > 0 ? thinned_[c] / thinned_weight : 0.0;
      squared[c] = (whole - thinned) * (whole - thinned);
      full_squared[c] = whole * whole;
    }
  }

 private:
  std::vector<double> full_, thinned_;
};

}  // namespace

EstimationError estimation_error(const NeighbourhoodTable& table, std::span<const double> values, std::size_t channels,
                                 std::span<const std::uint8_t> retained, std::span<const std::uint8_t> counted,
                                 std::span<const std::uint8_t> full_set) {
  std::vector<std::size_t> rows;
  for (std::size_t q = 0; q < table.evaluation_point_count(); ++q)
    if (counted.empty() || counted[q]) rows.push_back(q);
  const std::size_t points = rows.size();
  std::vector<double> squared(points * channels), full_squared(points * channels);
  parallel_ranges(points, 1024, [&](std::size_t begin, std::size_t end) {
    PointError point_error(channels);
    for (std::size_t i = begin; i < end; ++i)
      point_error.evaluate(table, rows[i], values, retained, full_set, &squared[i * channels],
                           &full_squared[i * channels]);
  });

  // One thread sums, in the order of the points: the bits must not depend on the cores.
  EstimationError error;
  error.evaluation_point_count = points;
  error.per_channel_k2.assign(channels, 0.0);
  for (std::size_t i = 0; i < squared.size(); ++i) {
    error.per_channel_k2[i % channels] += squared[i];
    error.empty_mean_squared_k2 += full_squared[i];
  }
  for (double& part : error.per_channel_k2) {
    if (points > 0) part /= static_cast<double>(points);
    error.mean_squared_k2 += part;
  }
  if (points > 0) error.empty_mean_squared_k2 /= static_cast<double>(points);
  return error;
}

}  // namespace thin
