#include "libthin/thinning/top_down_clustering.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "libthin/foundation/lloyd_clustering.h"

namespace thin {
namespace {

// Places and scaled values in one row each: distances between rows are those of eq. 6.8.
std::vector<double> rows_of(const ThinningInput& input, double alpha_km_per_k) {
  std::vector<double> rows;
  rows.reserve(input.places.coordinates.size() + input.values.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    const auto place = input.places.of(i);
    rows.insert(rows.end(), place.begin(), place.end());
    for (const double value : input.values_of(i)) rows.push_back(alpha_km_per_k * value);
  }
  return rows;
}

double squared_distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t c = 0; c < a.size(); ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

// Of each cluster the observation of highest priority, then the nearest to the centroid.
std::vector<std::uint32_t> by_priority(const ThinningInput& input, const ClusterPoints& points,
                                       const Clustering& clustering) {
  const auto width = static_cast<std::size_t>(points.dimension);
  const auto row = [&](std::size_t i) { return points.coordinates.subspan(i * width, width); };
  std::vector<double> centroids(clustering.size() * width), counts(clustering.size());
  const auto centroid = [&](std::size_t cluster) { return std::span(centroids).subspan(cluster * width, width); };
  for (std::size_t i = 0; i < input.size(); ++i) {
    const std::uint32_t cluster = clustering.cluster_of[i];
    ++counts[cluster];
    for (std::size_t c = 0; c < width; ++c) centroid(cluster)[c] += row(i)[c];
  }
  for (std::size_t cluster = 0; cluster < clustering.size(); ++cluster)
    for (double& component : centroid(cluster)) component /= counts[cluster];

  std::vector<std::uint32_t> chosen = clustering.representative;
  for (std::uint32_t i = 0; i < input.size(); ++i) {
    const std::uint32_t cluster = clustering.cluster_of[i], other = chosen[cluster];
    if (input.has_priority(other, i)) continue;
    if (input.has_priority(i, other) ||
        squared_distance(row(i), centroid(cluster)) < squared_distance(row(other), centroid(cluster)))
      chosen[cluster] = i;
  }
  return chosen;
}

// The places of the largest clusters in `clustering`, where instruments alone make more clusters than may be retained.
std::vector<std::uint32_t> largest_clusters(const Clustering& clustering, std::size_t count) {
  std::vector<std::uint32_t> sizes(clustering.size()), order(clustering.size());
  for (const std::uint32_t cluster : clustering.cluster_of) ++sizes[cluster];
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return sizes[a] > sizes[b]; });
  order.resize(std::min(order.size(), count));
  return order;
}

}  // namespace

void TopDownClustering::declare_options(OptionTable& table) {
  table.add("alpha_km_per_k", alpha_km_per_k_,
            {.unit = "km/K",
             .minimum = 0,
             .maximum = 1e6,
             .explanation = "how many km apart count as much as 1 K (1 observation error, where these are given); 0: "
                            "values do not count"});
  table.add("cluster_error", cluster_error_km2_,
            {.unit = "km^2",
             .minimum = 0,
             .explanation = "split no cluster whose sum of squared distances to its mean is at most this; alone, or "
                            "together with a number to retain"});
  table.add("lloyd_iterations", lloyd_iterations_,
            {.minimum = 0,
             .maximum = 100000,
             .explanation = "at most, after the splitting; they end by themselves where nothing changes any more"});
}

Result<Choice> TopDownClustering::choose(const ThinningInput& input) const {
  const std::vector<double> rows = rows_of(input, alpha_km_per_k_);
  const ClusterPoints points{.coordinates = rows,
                             .dimension = input.places.dimension + static_cast<int>(input.channel_count()),
                             .place_dimension = input.places.dimension,
                             .group = input.places.group};
  const std::size_t count = input.retain_count.value_or(input.size());
  Clustering clustering = split_clusters(points, {.cluster_count = count, .cluster_error = cluster_error_km2_});
  const int rounds = relax_clusters(points, clustering, lloyd_iterations_);

  Choice choice;
  if (lloyd_iterations_ > 0 && rounds == lloyd_iterations_)
    choice.notes.push_back(fmt::format("the clusters were still changing after {} lloyd_iterations", rounds));
  const std::vector<std::uint32_t> chosen =
      input.priority.empty() ? clustering.representative : by_priority(input, points, clustering);
  for (const std::uint32_t cluster : largest_clusters(clustering, count)) choice.retained.push_back(chosen[cluster]);
  std::sort(choice.retained.begin(), choice.retained.end());
  return choice;
}

}  // namespace thin
