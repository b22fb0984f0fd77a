#include "libthin/formats/bufr_soundings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "libthin/formats/bufr_kinds.h"
#include "libthin/formats/bufr_sounders.h"
#include "libthin/formats/sounding_table.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

template <std::size_t n>
bool is_one_of(int descriptor, const std::array<int, n>& elements) {
  return std::find(elements.begin(), elements.end(), descriptor) != elements.end();
}

bool is_channel(int descriptor) {
  return descriptor == kChannelCodeElement || descriptor == kChannelNumberElement;
}

bool is_temperature(int descriptor, BufrTemperature temperature) {
  return temperature == BufrTemperature::antenna ? descriptor == kAntennaTemperatureElement
                                                 : is_one_of(descriptor, kBrightnessTemperatureElements);
}

// A channel number, and the first temperature behind it and in front of the next channel number.
struct Slot {
  const BufrField* channel = nullptr;
  const BufrField* temperature = nullptr;
};

// The fields of a subset that describe soundings; what a quality block says about them comes behind.
std::span<const BufrField> described_fields(const AlikeSubsets& group) {
  const auto end = std::find_if(group.fields.begin(), group.fields.end(),
                                [](const BufrField& field) { return field.in_quality_block; });
  return {group.fields.begin(), end};
}

// Slots without temperature are none: HIRS' visible channel has a radiance.
std::vector<Slot> slots_of(const AlikeSubsets& group, BufrTemperature temperature) {
  std::vector<Slot> slots;
  for (const BufrField& field : described_fields(group)) {
    if (is_channel(field.descriptor))
      slots.push_back({&field, nullptr});
    else if (!slots.empty() && !slots.back().temperature && is_temperature(field.descriptor, temperature))
      slots.back().temperature = &field;
  }
  std::erase_if(slots, [](const Slot& slot) { return !slot.temperature; });
  return slots;
}

const BufrField* find_field(const AlikeSubsets& group, int descriptor) {
  for (const BufrField& field : described_fields(group))
    if (field.descriptor == descriptor && !field.text) return &field;
  return nullptr;
}

BufrColumn column_of(const BufrData& data, const AlikeSubsets& group, int descriptor) {
  const BufrField* field = find_field(group, descriptor);
  return field ? data.column(group, *field) : BufrColumn();
}

template <std::size_t n>
BufrColumn column_of(const BufrData& data, const AlikeSubsets& group, const std::array<int, n>& elements) {
  for (const int descriptor : elements)
    if (find_field(group, descriptor)) return column_of(data, group, descriptor);
  return {};
}

// "latitude (005001) stands twice in a subset": where there is a choice, none is made. Empty where there is none.
std::string ambiguous_place(const AlikeSubsets& group) {
  struct {
    const char* name;
    std::array<int, 2> elements;
  } const places[] = {{"latitude", kLatitudeElements},
                      {"longitude", kLongitudeElements},
                      {"year", {kFirstClockElement, kFirstClockElement}},
                      {"hour", {kFirstClockElement + 3, kFirstClockElement + 3}}};
  for (const auto& place : places) {
    int count = 0, descriptor = 0;
    for (const BufrField& field : described_fields(group))
      if (is_one_of(field.descriptor, place.elements)) {
        ++count;
        if (count <= 2) descriptor = field.descriptor;
      }
    if (count > 1)
      return fmt::format("{} (descriptor {}) stands {} times in a subset, and none says which is the sounding's",
                         place.name, descriptor, count);
    if (count == 0) return fmt::format("it holds no {}", place.name);
  }
  return "";
}

bool is_unused(double channel) {
  return std::isnan(channel) || channel == 0;
}

// Channel from 1, or 0 where it is another instrument's, unused, missing, or has no brightness temperature.
int channel_of(const BufrSounder& sounder, int descriptor, double number) {
  const double channel = descriptor == kChannelCodeElement ? number - (sounder.first_channel_code - 1) : number;
  const bool is_numbered = descriptor != kChannelCodeElement || sounder.first_channel_code > 0;
  return is_numbered && channel >= 1 && channel <= sounder.channel_count ? static_cast<int>(channel) : 0;
}

// The only sounder to which all channels in use, of which there must be some, can belong by their codes.
Instrument instrument_by_channels(const std::vector<Slot>& slots, const std::vector<BufrColumn>& channels,
                                  std::size_t subset) {
  Instrument only = Instrument::unknown;
  for (const BufrSounder& sounder : bufr_sounders()) {
    bool some = false, all = true;
    for (std::size_t slot = 0; slot < slots.size(); ++slot) {
      const double number = channels[slot][subset];
      if (is_unused(number)) continue;
      some = true;
      const int descriptor = slots[slot].channel->descriptor;
      all = all && descriptor == kChannelCodeElement && channel_of(sounder, descriptor, number) > 0;
    }
    if (!some || !all) continue;
    if (only != Instrument::unknown) return Instrument::unknown;
    only = sounder.instrument;
  }
  return only;
}

Instrument instrument_of(const BufrSounder* sounder) {
  return sounder ? sounder->instrument : Instrument::unknown;
}

// Appends the instrument of each subset of a group.
void find_instruments(const BufrData& data, const AlikeSubsets& group, bool is_atms, std::vector<Instrument>& into) {
  const BufrColumn sensor = column_of(data, group, kSensorElement);
  const BufrColumn satellite_instrument = column_of(data, group, kSatelliteInstrumentElement);
  const std::vector<Slot> slots = slots_of(group, BufrTemperature::brightness);
  std::vector<BufrColumn> channels;
  for (std::size_t subset = 0; subset < group.count; ++subset) {
    if (!std::isnan(sensor[subset])) {
      into.push_back(instrument_of(sounder_of_sensor(static_cast<int>(sensor[subset]))));
    } else if (!std::isnan(satellite_instrument[subset])) {
      into.push_back(instrument_of_number(satellite_instrument[subset]));
    } else if (is_atms) {
      into.push_back(Instrument::atms);
    } else {
      if (channels.empty())
        for (const Slot& slot : slots) channels.push_back(data.column(group, *slot.channel));
      into.push_back(instrument_by_channels(slots, channels, subset));
    }
  }
}

SoundingMessage failed(const std::string& reason, const std::string& remedy) {
  return {SoundingMessage::State::failed, reason, remedy, {}, {}};
}

SoundingMessage other_kind(const MessageKind& kind) {
  return {SoundingMessage::State::other_kind, kind.name, kind.remedy, {}, {}};
}

// Names what a decoded message without known instrument holds, by its first subset.
MessageKind other_instrument(const BufrData& data) {
  const AlikeSubsets& group = data.groups().front();
  const double sensor = column_of(data, group, kSensorElement)[0];
  const double number = column_of(data, group, kSatelliteInstrumentElement)[0];
  if (!std::isnan(sensor)) return {sensor_name(static_cast<int>(sensor)), other_sensor_remedy()};
  if (!std::isnan(number)) return {satellite_instrument_name(static_cast<int>(number)), other_sensor_remedy()};
  return {"soundings of an unnamed instrument", other_sensor_remedy()};
}

bool holds_channel_temperatures(const BufrHeader& header, const BufrTables& tables) {
  const std::set<int> elements = tables.elements_within(header.descriptors);
  return (elements.contains(kChannelCodeElement) || elements.contains(kChannelNumberElement)) &&
         std::any_of(kBrightnessTemperatureElements.begin(), kBrightnessTemperatureElements.end(),
                     [&](int element) { return elements.contains(element); });
}

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
  for (const BufrColumn& column : clock)
    if (std::isnan(column[subset])) return std::nullopt;
  const auto whole = [&](int part) { return static_cast<int>(clock[static_cast<std::size_t>(part)][subset]); };
  return to_time_ms({whole(0), whole(1), whole(2), whole(3), whole(4), clock[5][subset]});
}

std::int32_t number_or_unknown(double value) {
  constexpr double kLargest = std::numeric_limits<std::int32_t>::max();
  return value >= 0 && value <= kLargest ? static_cast<std::int32_t>(value) : kUnknownNumber;
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
  std::vector<Slot> slots = slots_of(group, temperature);
  if (slots.empty()) slots = slots_of(group, BufrTemperature::brightness);
  for (const Slot& slot : slots) {
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

SoundingMessage open_soundings(std::span<const std::uint8_t> bytes, const BufrHeader& header, BufrFileTables& tables) {
  constexpr const char* kDamaged = "It is damaged: ask the sender for it again.";
  if (header.data_category == kTablesCategory) {
    const Result<void> taken = tables.take(bytes, header);
    if (!taken) return failed("BUFR tables that can't be read: " + taken.error().message, kDamaged);
    return {SoundingMessage::State::tables, "", "", {}, {}};
  }
  tables.pass_data();
  const MessageKind kind = kind_of(header, tables.has_own());
  if (!may_hold_soundings(header, tables.has_own())) return other_kind(kind);
  const auto in_force = tables.for_data(header);
  if (!in_force)
    return failed(in_force.error().message,
                  "Install a newer ecCodes, or ask the sender for it again where it is damaged.");
  if (!holds_channel_temperatures(header, **in_force)) return other_kind(kind);

  Result<BufrData> data = BufrData::walk(bytes, header, **in_force);
  if (!data) return failed(data.error().message, kDamaged);
  SoundingMessage message{SoundingMessage::State::soundings, "", "", std::move(*data), {}};
  for (const AlikeSubsets& group : message.data.groups()) {
    if (const std::string problem = ambiguous_place(group); !problem.empty())
      return other_kind({kind.name + ": " + problem, kind.remedy});
    find_instruments(message.data, group, is_atms(header), message.instruments);
  }
  const auto is_known = [](Instrument instrument) { return instrument != Instrument::unknown; };
  if (std::none_of(message.instruments.begin(), message.instruments.end(), is_known))
    return other_kind(other_instrument(message.data));
  return message;
}

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
