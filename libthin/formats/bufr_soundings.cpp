#include "libthin/formats/bufr_soundings.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "libthin/formats/bufr_fields.h"
#include "libthin/formats/bufr_kinds.h"
#include "libthin/formats/bufr_sounders.h"
#include "libthin/formats/sounding_table.h"

namespace thin {
namespace {

bool is_unused(double channel) {
  return std::isnan(channel) || channel == 0;
}

// The only sounder to which all channels in use, of which there must be some, can belong by their codes.
Instrument instrument_by_channels(const std::vector<BufrSlot>& slots, const std::vector<BufrColumn>& channels,
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
  const std::vector<BufrSlot> slots = slots_of(group, BufrTemperature::brightness);
  std::vector<BufrColumn> channels;
  for (std::size_t subset = 0; subset < group.count; ++subset) {
    if (!std::isnan(sensor[subset])) {
      into.push_back(instrument_of(sounder_of_sensor(number_or_unknown(sensor[subset]))));
    } else if (!std::isnan(satellite_instrument[subset])) {
      into.push_back(instrument_of_number(satellite_instrument[subset]));
    } else if (is_atms) {
      into.push_back(Instrument::atms);
    } else {
      if (channels.empty())
        for (const BufrSlot& slot : slots) channels.push_back(data.column(group, *slot.channel));
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
  if (!std::isnan(sensor)) return {sensor_name(number_or_unknown(sensor)), other_sensor_remedy()};
  if (!std::isnan(number)) return {satellite_instrument_name(number_or_unknown(number)), other_sensor_remedy()};
  return {"soundings of an unnamed instrument", other_sensor_remedy()};
}

bool holds_channel_temperatures(const BufrHeader& header, const BufrTables& tables) {
  const std::set<int> elements = tables.elements_within(header.descriptors);
  return (elements.contains(kChannelCodeElement) || elements.contains(kChannelNumberElement)) &&
         std::any_of(kBrightnessTemperatureElements.begin(), kBrightnessTemperatureElements.end(),
                     [&](int element) { return elements.contains(element); });
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

}  // namespace thin
