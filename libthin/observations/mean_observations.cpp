#include "libthin/observations/mean_observations.h"

#include <cmath>
#include <limits>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

using Members = std::span<const std::uint32_t>;

template <class T>
T shared_by(Members members, const std::vector<T>& column, T unknown) {
  for (const std::uint32_t i : members)
    if (column[i] != column[members.front()]) return unknown;
  return column[members.front()];
}

// Of one row each of rows x width, column by column, over what is there.
void mean_row(Members members, const std::vector<double>& rows, std::size_t width, std::vector<double>& mean) {
  mean.assign(width, 0.0);
  for (std::size_t c = 0; c < width; ++c) {
    std::size_t count = 0;
    for (const std::uint32_t i : members) {
      const double value = rows[i * width + c];
      if (std::isnan(value)) continue;
      mean[c] += value;
      ++count;
    }
    mean[c] = count ? mean[c] / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
  }
}

ObservationSet::Entry mean_entry(Members members, const ObservationSet& set) {
  const auto count = static_cast<double>(members.size());
  const std::int64_t first_ms = set.time_ms[members.front()];
  Vector3 sum;
  double time_ms = 0;  // after the first, so that no digit is lost
  for (const std::uint32_t i : members) {
    sum.x += set.position_km[i].x, sum.y += set.position_km[i].y, sum.z += set.position_km[i].z;
    time_ms += static_cast<double>(set.time_ms[i] - first_ms);
  }
  const GeodeticPosition place = geodetic({sum.x / count, sum.y / count, sum.z / count});
  return {.latitude_deg = place.latitude_deg,
          .longitude_deg = place.longitude_deg,
          .time_ms = first_ms + std::llround(time_ms / count),
          .platform = shared_by(members, set.platform, kUnknownNumber),
          .instrument = shared_by(members, set.instrument, Instrument::unknown),
          .scan_line = kUnknownNumber,
          .field_of_view = kUnknownNumber,
          .surface = shared_by(members, set.surface, Surface::unknown),
          .source = set.source[members.front()]};
}

}  // namespace

ObservationSet mean_observations(const ObservationSet& set, std::span<const std::vector<std::uint32_t>> groups) {
  ObservationSet means;
  means.channels = set.channels;
  means.channel_instrument = set.channel_instrument;
  means.value_kind = set.value_kind;
  std::vector<double> row, count;
  for (const auto& members : groups) {
    mean_row(members, set.values, set.channel_count(), row);
    means.push_back(mean_entry(members, set), row);
    count.push_back(static_cast<double>(members.size()));
    if (set.first_guess_k.empty()) continue;
    mean_row(members, set.first_guess_k, set.channel_count(), row);
    means.first_guess_k.resize(means.values.size() - row.size());
    means.first_guess_k.insert(means.first_guess_k.end(), row.begin(), row.end());
  }
  means.variables[kMeanOf] = count;
  return means;
}

}  // namespace thin
