#include "libthin/formats/file_summary.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>

#include "libthin/formats/bufr_file.h"
#include "libthin/foundation/file_bytes.h"
#include "libthin/formats/file_layout.h"
#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

ChannelSummary summarise_channel(const ObservationSet& set, std::size_t place) {
  ChannelSummary channel;
  channel.channel = set.channels[place];
  channel.minimum_k = std::numeric_limits<double>::infinity();
  channel.maximum_k = -channel.minimum_k;
  double sum_k = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double value_k = set.values_of(i)[place];
    if (std::isnan(value_k)) continue;
    ++channel.present;
    sum_k += value_k;
    channel.minimum_k = std::min(channel.minimum_k, value_k);
    channel.maximum_k = std::max(channel.maximum_k, value_k);
  }
  channel.missing = set.size() - channel.present;
  channel.mean_k = sum_k / static_cast<double>(channel.present);
  if (channel.present == 0)
    channel.minimum_k = channel.mean_k = channel.maximum_k = std::numeric_limits<double>::quiet_NaN();
  return channel;
}

// East and west of the widest gap between neighbouring longitudes.
Area smallest_area(const ObservationSet& set) {
  const auto [south, north] = std::minmax_element(set.latitude_deg.begin(), set.latitude_deg.end());
  std::vector<double> longitudes;
  for (const double longitude : set.longitude_deg) longitudes.push_back(normalised_longitude_deg(longitude));
  std::sort(longitudes.begin(), longitudes.end());
  Area area{*south, *north, longitudes.front(), longitudes.back()};
  double widest_gap = longitudes.front() + 360 - longitudes.back();
  for (std::size_t i = 1; i < longitudes.size(); ++i) {
    if (longitudes[i] - longitudes[i - 1] <= widest_gap) continue;
    widest_gap = longitudes[i] - longitudes[i - 1];
    area.west_deg = longitudes[i];
    area.east_deg = longitudes[i - 1];
  }
  return area;
}

// The messages that observations came from: their number, subsets and descriptors.
void summarise_messages(const BufrScan& scan, const ObservationSet& observations, FileSummary& summary) {
  std::set<int> editions;
  for (const BufrMessage& message : scan.messages) editions.insert(message.header.edition);
  summary.editions.assign(editions.begin(), editions.end());
  std::set<std::uint32_t> in_use;
  for (const SourceReference& source : observations.source) in_use.insert(source.message);
  summary.messages_in_use = static_cast<std::uint32_t>(in_use.size());
  for (const std::uint32_t number : in_use) {
    const BufrHeader& header = scan.messages[number].header;
    summary.subsets_in_use += static_cast<std::uint64_t>(header.subset_count);
    for (const int descriptor : header.descriptors)
      if (std::find(summary.descriptors.begin(), summary.descriptors.end(), descriptor) == summary.descriptors.end())
        summary.descriptors.push_back(descriptor);
  }
}

}  // namespace

FileSummary summarise_observations(const ObservationSet& observations) {
  assert(observations.size() > 0);
  FileSummary summary;
  summary.observations = observations.size();
  std::map<std::int32_t, std::uint64_t> platforms;
  std::set<std::pair<std::int32_t, std::int32_t>> scan_lines;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    ++platforms[observations.platform[i]];
    scan_lines.emplace(observations.platform[i], observations.scan_line[i]);
  }
  for (const auto& [platform, count] : platforms) summary.platforms.push_back({platform, count});
  summary.scan_lines = scan_lines.size();
  const auto [first, last] = std::minmax_element(observations.time_ms.begin(), observations.time_ms.end());
  summary.first_time_ms = *first;
  summary.last_time_ms = *last;
  summary.area = smallest_area(observations);
  for (std::size_t place = 0; place < observations.channels.size(); ++place)
    summary.channels.push_back(summarise_channel(observations, place));
  return summary;
}

Result<FileSummary> summarise_file(const std::string& path) {
  const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(path);
  if (!bytes) return bytes.error();
  const FileLayout layout = layout_of(*bytes);
  if (layout != FileLayout::bufr) return refusal(layout, *bytes, path);
  Result<ReadObservations> contents = read_bufr(*bytes, path);
  if (!contents) return contents.error();

  FileSummary summary = summarise_observations(contents->observations);
  summary.layout = contents->layout;
  summary.instrument = contents->instrument;
  summary.messages = contents->message_count;
  summary.skipped = std::move(contents->skipped);
  summarise_messages(scan_bufr(*bytes), contents->observations, summary);
  return summary;
}

}  // namespace thin
