#include "libemap/partition/coarsening.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

namespace emap {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint32_t group_elements(const ElementGraph& fine, std::size_t group_size, double spread_cosine,
                             std::vector<std::uint32_t>& group_of) {
  std::uint32_t groups = 0;
  std::vector<std::uint32_t> members;
  for (std::uint32_t seed = 0; seed < fine.size(); ++seed) {
    if (group_of[seed] != kNone) continue;
    group_of[seed] = groups;
    members.assign(1, seed);
    for (std::size_t next = 0; next < members.size() && members.size() < group_size; ++next)
      for (const Adjacency& neighbour : fine.neighbours(members[next])) {
        if (members.size() >= group_size || group_of[neighbour.element] != kNone) continue;
        if (fine.normals[seed].dot(fine.normals[neighbour.element]) < spread_cosine) continue;
        group_of[neighbour.element] = groups;
        members.push_back(neighbour.element);
      }
    ++groups;
  }
  return groups;
}

// Area-weighted means; where a group has no area, plain means.
void set_means(const ElementGraph& fine, const std::vector<std::uint32_t>& group_of, ElementGraph& coarse) {
  std::vector<double> weights(coarse.size(), 0);
  const double least_weight = 1e-12 * fine.total_area() / static_cast<double>(std::max<std::size_t>(fine.size(), 1)) +
                              std::numeric_limits<double>::min();
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const std::uint32_t group = group_of[i];
    const double weight = fine.areas[i] + least_weight;
    weights[group] += weight;
    coarse.areas[group] += fine.areas[i];
    coarse.centres[group] += weight * fine.centres[i];
    coarse.normals[group] += weight * fine.normals[i];
  }
  for (std::size_t group = 0; group < coarse.size(); ++group) {
    coarse.centres[group] /= weights[group];
    if (const double length = coarse.normals[group].norm(); length > 0) coarse.normals[group] /= length;
  }
}

void set_spreads(const ElementGraph& fine, const std::vector<std::uint32_t>& group_of, ElementGraph& coarse) {
  coarse.spread_cosines.assign(coarse.size(), 1);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    double& least = coarse.spread_cosines[group_of[i]];
    if (!fine.normals[i].isZero(0)) least = std::min(least, fine.normals[i].dot(coarse.normals[group_of[i]]));
  }
}

std::vector<AdjacentPair> adjacent_groups(const ElementGraph& fine, const std::vector<std::uint32_t>& group_of) {
  std::vector<AdjacentPair> sides;
  for (std::uint32_t i = 0; i < fine.size(); ++i)
    for (const Adjacency& neighbour : fine.neighbours(i))
      if (group_of[i] < group_of[neighbour.element])
        sides.push_back({group_of[i], group_of[neighbour.element], neighbour.boundary_length});
  std::sort(sides.begin(), sides.end(), [](const AdjacentPair& a, const AdjacentPair& b) {
    if (a.first != b.first) return a.first < b.first;
    return a.second != b.second ? a.second < b.second : a.boundary_length < b.boundary_length;
  });
  std::vector<AdjacentPair> pairs;
  for (const AdjacentPair& side : sides)
    if (!pairs.empty() && pairs.back().first == side.first && pairs.back().second == side.second)
      pairs.back().boundary_length += side.boundary_length;
    else
      pairs.push_back(side);
  return pairs;
}

}  // namespace

Coarsening coarsen(const ElementGraph& fine, std::size_t group_size, double spread_degrees) {
  Coarsening result;
  result.group_of.assign(fine.size(), kNone);
  const std::uint32_t groups =
      group_elements(fine, group_size, std::cos(spread_degrees * std::numbers::pi / 180), result.group_of);
  ElementGraph& coarse = result.graph;
  coarse.centres.assign(groups, Eigen::Vector3d::Zero());
  coarse.normals.assign(groups, Eigen::Vector3d::Zero());
  coarse.areas.assign(groups, 0);
  set_means(fine, result.group_of, coarse);
  set_spreads(fine, result.group_of, coarse);
  set_adjacency(adjacent_groups(fine, result.group_of), coarse);
  return result;
}

}  // namespace emap
