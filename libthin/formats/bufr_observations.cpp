#include "libthin/formats/bufr_observations.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "libthin/formats/bufr_fields.h"
#include "libthin/formats/bufr_sounders.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Everything but the channels.
struct Places {
  BufrColumn platform, scan_line, field_of_view, latitude, longitude, surface;
  std::array<BufrColumn, 6> clock;  // year to second
};

Places read_places(const BufrData& data, const AlikeSubsets& group) {
  Places places;
  places.platform = column_of(data, group, kSatelliteElement);
  places.scan_line = column_of(data, group, kScanLineElement);
  places.field_of_view = column_of(data, group, kFieldOfViewElement);
  places.latitude = column_of(data, group, kLatitudeElements);
  places.longitude = column_of(data, group, kLongitudeElements);
  places.surface = column_of(data, group, kSurfaceElement);
  for (int part = 0; part < 6; ++part)
    places.clock[static_cast<std::size_t>(part)] = column_of(data, group, kFirstClockElement + part);
  return places;
}

std::optional<std::int64_t> time_of(const std::array<BufrColumn, 6>& clock, std::size_t subset) {
  constexpr int kLastYear = 9999;
  const double second = clock[5][subset];
  // Of the others what is missing is out of range.
  const auto whole = [&](int part) { return number_or_unknown(clock[static_cast<std::size_t>(part)][subset]); };
  if (std::isnan(second) || whole(0) == kUnknownNumber || whole(0) > kLastYear) return std::nullopt;
  return to_time_ms({whole(0), whole(1), whole(2), whole(3), whole(4), second});
}

// BUFR holds 90 degrees as 9,000,000 hundred-thousandths, which decode to 90.00000000000001: a value that is over the
// edge by a rounding is on the edge. Anything farther out is no value.
double within(double value, double lowest, double highest) {
  constexpr double kRounding = 1e-9;
  if (!(value >= lowest - kRounding && value <= highest + kRounding)) return kMissing;
  return std::clamp(value, lowest, highest);
}

// Code table 008012.
Surface surface_of(double code) {
  if (code == 0) return Surface::land;
  if (code == 1) return Surface::sea;
  if (code == 2) return Surface::coast;
  return Surface::unknown;
}

// Position and time, or nothing where one of them is missing or impossible.
std::optional<ObservationSet::Entry> entry_of(const Places& places, std::size_t subset) {
  const double latitude = within(places.latitude[subset], -90, 90);
  const double longitude = within(places.longitude[subset], -180, 360);
  const std::optional<std::int64_t> time_ms = time_of(places.clock, subset);
  if (std::isnan(latitude) || std::isnan(longitude) || !time_ms) return std::nullopt;
  return ObservationSet::Entry{.latitude_deg = latitude,
                               .longitude_deg = longitude,
                               .time_ms = *time_ms,
                               .platform = number_or_unknown(places.platform[subset]),
                               .instrument = Instrument::unknown,
                               .scan_line = number_or_unknown(places.scan_line[subset]),
                               .field_of_view = number_or_unknown(places.field_of_view[subset]),
                               .surface = surface_of(places.surface[subset]),
                               .source = {}};
}

// One row of kMostChannels for each subset of the group; `instruments` are theirs.
std::vector<double> temperatures_of(const BufrData& data, const AlikeSubsets& group, BufrTemperature temperature,
                                    std::span<const Instrument> instruments) {
  std::vector<double> rows(group.count * kMostChannels, kMissing);
  std::vector<BufrSlot> slots = slots_of(group, temperature);
  if (slots.empty()) slots = slots_of(group, BufrTemperature::brightness);
  for (const BufrSlot& slot : slots) {
    const BufrColumn channels = data.column(group, *slot.channel);
    const BufrColumn temperatures = data.column(group, *slot.temperature);
    if (temperatures.is_constant() && std::isnan(temperatures[0])) continue;
    int channel = 0;
    for (std::size_t subset = 0; subset < group.count; ++subset) {
      const bool as_before = subset > 0 && channels.is_constant() && instruments[subset] == instruments[subset - 1];
      if (!as_before) {
        const BufrSounder* sounder = sounder_of(instruments[subset]);
        channel = sounder ? channel_of(*sounder, slot.channel->descriptor, channels[subset]) : 0;
      }
      if (channel == 0) continue;
      double& value_k = rows[subset * kMostChannels + static_cast<std::size_t>(channel - 1)];
      if (std::isnan(value_k)) value_k = temperatures[subset];
    }
  }
  return rows;
}

// The variables of a group that are not missing all over.
std::vector<std::pair<const char*, BufrColumn>> read_variables(const BufrData& data, const AlikeSubsets& group) {
  std::vector<std::pair<const char*, BufrColumn>> variables;
  for (const BufrVariable& variable : bufr_variables()) {
    BufrColumn column = column_of(data, group, variable.descriptor);
    if (!column.is_constant() || !std::isnan(column[0])) variables.emplace_back(variable.name, std::move(column));
  }
  return variables;
}

// One instrument's set, ready to have observations and these variables appended.
class Target {
 public:
  Target(Instrument instrument, const std::vector<std::pair<const char*, BufrColumn>>& variables, SoundingSets& into)
      : set_(into[instrument]), variables_(variables) {
    const auto channel_count = static_cast<std::size_t>(sounder_of(instrument)->channel_count);
    for (std::size_t channel = set_.channels.size(); channel < channel_count; ++channel)
      set_.channels.push_back(static_cast<int>(channel) + 1);
    for (const auto& [name, column] : variables) {
      std::vector<double>& values = set_.variables[name];
      values.resize(set_.size(), kMissing);
      values_.push_back(&values);
    }
  }

  void append(const ObservationSet::Entry& entry, const double* row, std::size_t subset) {
    set_.push_back(entry, {row, set_.channels.size()});
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i]->back() = variables_[i].second[subset];
  }

 private:
  ObservationSet& set_;
  const std::vector<std::pair<const char*, BufrColumn>>& variables_;
  std::vector<std::vector<double>*> values_;
};

// Returns how many were left out.
std::uint32_t append_group(const BufrData& data, const AlikeSubsets& group, std::span<const Instrument> instruments,
                           std::uint32_t message_number, BufrTemperature temperature, SoundingSets& into) {
  const Places places = read_places(data, group);
  const auto variables = read_variables(data, group);
  const std::vector<double> rows = temperatures_of(data, group, temperature, instruments);
  std::map<Instrument, Target> targets;
  for (const Instrument instrument : std::set<Instrument>(instruments.begin(), instruments.end()))
    if (instrument != Instrument::unknown)
      targets.emplace(std::piecewise_construct, std::forward_as_tuple(instrument),
                      std::forward_as_tuple(instrument, variables, into));

  std::uint32_t left_out = 0;
  for (std::uint32_t subset = 0; subset < group.count; ++subset) {
    const auto target = targets.find(instruments[subset]);
    std::optional<ObservationSet::Entry> entry;
    if (target != targets.end()) entry = entry_of(places, subset);
    if (!entry) {
      ++left_out;
      continue;
    }
    entry->instrument = instruments[subset];
    entry->source = {0, message_number, group.first + subset};
    target->second.append(*entry, rows.data() + std::size_t{subset} * kMostChannels, subset);
  }
  return left_out;
}

}  // namespace

std::uint32_t append_soundings(const SoundingMessage& message, std::uint32_t message_number,
                               BufrTemperature temperature, SoundingSets& into) {
  assert(message.state == SoundingMessage::State::soundings);
  std::uint32_t left_out = 0;
  for (const AlikeSubsets& group : message.data.groups())
    left_out += append_group(message.data, group, std::span(message.instruments).subspan(group.first, group.count),
                             message_number, temperature, into);
  return left_out;
}

}  // namespace thin
