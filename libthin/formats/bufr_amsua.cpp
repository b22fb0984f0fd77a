#include "libthin/formats/bufr_amsua.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "libthin/formats/bufr_column.h"
#include "libthin/formats/bufr_kinds.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr int kHirsSlots = 19;
constexpr const char* kChannelKey = "tovsOrAtovsOrAvhrrInstrumentationChannelNumber";
constexpr const char* kTemperatureKey = "brightnessTemperature";

// The channels of a message, slot by slot.
struct Slots {
  std::vector<BufrColumn> codes;
  std::vector<BufrColumn> temperatures;
};

int slot_count(const BufrHeader& header) {
  const bool long_form = std::count(header.descriptors.begin(), header.descriptors.end(), kHirsSequence) > 0;
  return long_form ? kHirsSlots : kAmsuAChannelCount;
}

Result<void> read_columns(const EccodesMessage& message, const BufrHeader& header, const char* key,
                          std::vector<BufrColumn>& columns) {
  for (int rank = 1; rank <= slot_count(header); ++rank) {
    Result<BufrColumn> column = BufrColumn::read(message, header, key, rank);
    if (!column) return column.error();
    columns.push_back(std::move(*column));
  }
  return {};
}

// The slot's channel, 1..15, or 0 where it is another instrument's, unused or missing.
int channel_of(double code) {
  const double channel = code - (kFirstAmsuACode - 1);
  return channel >= 1 && channel <= kAmsuAChannelCount ? static_cast<int>(channel) : 0;
}

bool is_unused(double code) {
  return std::isnan(code) || code == 0;
}

// Whether the slots in use, of which there must be some, all hold AMSU-A channels.
bool codes_say_amsua(const std::vector<BufrColumn>& codes, std::size_t subset) {
  bool any = false;
  for (const BufrColumn& code : codes) {
    if (is_unused(code[subset])) continue;
    if (channel_of(code[subset]) == 0) return false;
    any = true;
  }
  return any;
}

bool is_amsua(const BufrColumn& sensor, const std::vector<BufrColumn>& codes, std::size_t subset) {
  return std::isnan(sensor[subset]) ? codes_say_amsua(codes, subset) : sensor[subset] == kSensorAmsuA;
}

// Everything but the channels.
struct Places {
  BufrColumn sensor, platform, scan_line, field_of_view, latitude, longitude;
  std::array<BufrColumn, 6> clock;  // year to second
};

Result<Places> read_places(const EccodesMessage& message, const BufrHeader& header) {
  Places places;
  const std::pair<const char*, BufrColumn*> columns[] = {
      {"satelliteSensorIndicator", &places.sensor},
      {"satelliteIdentifier", &places.platform},
      {"scanLineNumber", &places.scan_line},
      {"fieldOfViewNumber", &places.field_of_view},
      {"latitude", &places.latitude},
      {"longitude", &places.longitude},
      {"year", &places.clock[0]},
      {"month", &places.clock[1]},
      {"day", &places.clock[2]},
      {"hour", &places.clock[3]},
      {"minute", &places.clock[4]},
      {"second", &places.clock[5]},
  };
  for (const auto& [key, column] : columns) {
    Result<BufrColumn> read = BufrColumn::read(message, header, key, 1);
    if (!read) return read.error();
    *column = std::move(*read);
  }
  return places;
}

std::optional<std::int64_t> time_of(const std::array<BufrColumn, 6>& clock, std::size_t subset) {
  for (const BufrColumn& column : clock)
    if (std::isnan(column[subset])) return std::nullopt;
  const auto whole = [&](int part) { return static_cast<int>(clock[static_cast<std::size_t>(part)][subset]); };
  return to_time_ms({whole(0), whole(1), whole(2), whole(3), whole(4), clock[5][subset]});
}

std::int32_t number_or_unknown(double value) {
  return std::isnan(value) ? kUnknownNumber : static_cast<std::int32_t>(value);
}

// BUFR holds 90 degrees as 9,000,000 hundred-thousandths, which decode to 90.00000000000001: a value that is over the
// edge by a rounding is on the edge. Anything farther out is no value.
double within(double value, double lowest, double highest) {
  constexpr double kRounding = 1e-9;
  if (!(value >= lowest - kRounding && value <= highest + kRounding)) return kMissing;
  return std::clamp(value, lowest, highest);
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
                               .instrument = Instrument::amsua,
                               .scan_line = number_or_unknown(places.scan_line[subset]),
                               .field_of_view = number_or_unknown(places.field_of_view[subset]),
                               .surface = Surface::unknown,
                               .source = {}};
}

std::array<double, kAmsuAChannelCount> temperatures_of(const Slots& slots, std::size_t subset) {
  std::array<double, kAmsuAChannelCount> temperatures;
  temperatures.fill(kMissing);
  for (std::size_t slot = 0; slot < slots.codes.size(); ++slot) {
    const int channel = channel_of(slots.codes[slot][subset]);
    if (channel == 0) continue;
    double& temperature = temperatures[static_cast<std::size_t>(channel - 1)];
    if (std::isnan(temperature)) temperature = slots.temperatures[slot][subset];
  }
  return temperatures;
}

AmsuAMessage failed(const std::string& reason) {
  return {AmsuAMessage::State::failed, reason, "It is damaged: ask the sender for it again.", std::nullopt};
}

AmsuAMessage without_tables(const BufrHeader& header) {
  const std::string version = "version " + std::to_string(header.master_table_version) + " of master table " +
                              std::to_string(header.master_table);
  return {AmsuAMessage::State::failed, "it needs " + version + ", which this ecCodes does not have",
          "Install a newer ecCodes, or ask the sender for it again where it is damaged.", std::nullopt};
}

// Names what a decoded message without AMSU-A holds, by its first subset.
AmsuAMessage other_instrument(const BufrColumn& sensor) {
  const std::string name =
      std::isnan(sensor[0]) ? "ATOVS soundings of an unnamed instrument" : sensor_name(static_cast<int>(sensor[0]));
  return {AmsuAMessage::State::other_kind, name, other_sensor_remedy(), std::nullopt};
}

}  // namespace

AmsuAMessage open_amsua(std::span<const std::uint8_t> bytes, const BufrHeader& header) {
  if (!is_atovs(header)) {
    MessageKind kind = kind_of(header);
    return {AmsuAMessage::State::other_kind, kind.name, kind.remedy, std::nullopt};
  }
  if (header.subset_count == 0) return failed("it has no subsets");
  if (const std::string problem = unsuitable_atovs(header); !problem.empty()) return failed(problem);
  if (!eccodes_has_tables(header.master_table, header.master_table_version)) return without_tables(header);
  Result<EccodesMessage> message = EccodesMessage::open(bytes);
  if (!message) return failed(message.error().message);
  if (const Result<void> unpacked = message->unpack(); !unpacked) return failed(unpacked.error().message);

  const Result<BufrColumn> sensor = BufrColumn::read(*message, header, "satelliteSensorIndicator", 1);
  if (!sensor) return failed(sensor.error().message);
  std::vector<BufrColumn> codes;
  bool found = false;
  // MHS has five slots only; nothing of 310010 is AMSU-A.
  if (std::count(header.descriptors.begin(), header.descriptors.end(), kAmsuBSequence) == 0) {
    if (const Result<void> read = read_columns(*message, header, kChannelKey, codes); !read)
      return failed(read.error().message);
    for (std::size_t subset = 0; subset < static_cast<std::size_t>(header.subset_count) && !found; ++subset)
      found = is_amsua(*sensor, codes, subset);
  }
  if (!found) return other_instrument(*sensor);
  return {AmsuAMessage::State::amsua, "", "", std::move(*message)};
}

Result<std::uint32_t> append_soundings(const AmsuAMessage& amsua, const BufrHeader& header,
                                       std::uint32_t message_number, ObservationSet& into) {
  assert(amsua.message);
  Result<Places> places = read_places(*amsua.message, header);
  if (!places) return places.error();
  Slots slots;
  if (const Result<void> read = read_columns(*amsua.message, header, kChannelKey, slots.codes); !read)
    return read.error();
  if (const Result<void> read = read_columns(*amsua.message, header, kTemperatureKey, slots.temperatures); !read)
    return read.error();

  std::uint32_t left_out = 0;
  into.reserve(into.size() + static_cast<std::size_t>(header.subset_count));
  for (std::uint32_t subset = 0; subset < static_cast<std::uint32_t>(header.subset_count); ++subset) {
    std::optional<ObservationSet::Entry> entry = entry_of(*places, subset);
    if (!entry || !is_amsua(places->sensor, slots.codes, subset)) {
      ++left_out;
      continue;
    }
    entry->source = {0, message_number, subset};
    into.push_back(*entry, temperatures_of(slots, subset));
  }
  return left_out;
}

}  // namespace thin
