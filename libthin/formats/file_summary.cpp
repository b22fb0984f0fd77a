#include "libthin/formats/file_summary.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>

#include "libthin/formats/bufr_file.h"
#include "libthin/formats/file_layout.h"
#include "libthin/foundation/file_bytes.h"
#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

void summarise_innovations(const ObservationSet& set, std::size_t place, ChannelSummary& channel) {
  double count = 0, sum_k = 0, squares_k2 = 0;
  for (std::size_t i = 0; i < set.first_guess_k.size() / set.channel_count(); ++i) {
    const double innovation_k = set.values_of(i)[place] - set.first_guess_k[i * set.channel_count() + place];
    if (std::isnan(innovation_k)) continue;
    ++count;
    sum_k += innovation_k;
    squares_k2 += innovation_k * innovation_k;
  }
  channel.innovation_mean_k = sum_k / count;  // NaN for none
  channel.innovation_deviation_k =
      std::sqrt(std::max(0.0, squares_k2 / count - channel.innovation_mean_k * channel.innovation_mean_k));
  if (count == 0) channel.innovation_deviation_k = std::numeric_limits<double>::quiet_NaN();
}

ChannelSummary summarise_channel(const ObservationSet& set, std::size_t place) {
  ChannelSummary channel;
  channel.channel = set.channels[place];
  if (!set.channel_instrument.empty()) channel.instrument = set.channel_instrument[place];
  std::uint64_t measured = 0;
  channel.minimum_k = std::numeric_limits<double>::infinity();
  channel.maximum_k = -channel.minimum_k;
  double sum_k = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    measured += set.measures(i, place) ? 1 : 0;
    const double value_k = set.values_of(i)[place];
    if (std::isnan(value_k)) continue;
    ++channel.present;
    sum_k += value_k;
    channel.minimum_k = std::min(channel.minimum_k, value_k);
    channel.maximum_k = std::max(channel.maximum_k, value_k);
  }
  channel.missing = measured - channel.present;
  channel.mean_k = sum_k / static_cast<double>(channel.present);
  if (channel.present == 0)
    channel.minimum_k = channel.mean_k = channel.maximum_k = std::numeric_limits<double>::quiet_NaN();
  summarise_innovations(set, place, channel);
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
  std::map<Instrument, std::uint64_t> instruments;
  std::set<std::pair<std::int32_t, std::int32_t>> scan_lines;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    ++platforms[observations.platform[i]];
    ++instruments[observations.instrument[i]];
    if (observations.scan_line[i] != kUnknownNumber)
      scan_lines.emplace(observations.platform[i], observations.scan_line[i]);
  }
  for (const auto& [platform, count] : platforms) summary.platforms.push_back({platform, count});
  for (const auto& [instrument, count] : instruments) summary.instruments.push_back({instrument, count});
  summary.scan_lines = scan_lines.size();
  const auto [first, last] = std::minmax_element(observations.time_ms.begin(), observations.time_ms.end());
  summary.first_time_ms = *first;
  summary.last_time_ms = *last;
  summary.area = smallest_area(observations);
  summary.has_first_guess = !observations.first_guess_k.empty();
  for (std::size_t place = 0; place < observations.channels.size(); ++place)
    summary.channels.push_back(summarise_channel(observations, place));
  return summary;
}

Result<FileSummary> summarise_file(const std::string& path, const InputOptions& options) {
  const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(path);
  if (!bytes) return bytes.error();
  Result<ReadObservations> contents = read_observations(*bytes, path, options);
  if (!contents) return contents.error();

  FileSummary summary = summarise_observations(contents->observations);
  summary.layout = contents->layout;
  summary.instrument = contents->instrument;
  summary.messages = contents->message_count;
  summary.skipped = std::move(contents->skipped);
  summary.notes = std::move(contents->notes);
  if (layout_of(*bytes) == FileLayout::bufr) summarise_messages(scan_bufr(*bytes), contents->observations, summary);
  return summary;
}

}  // namespace thin
