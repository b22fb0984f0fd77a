#include "libthin/formats/sounding_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>

#include "libthin/observations/platforms.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kLatestTimeS = 1e11;  // the year 5138: what lies beyond is no time

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

bool has_place_and_time(const SoundingTable& table, std::size_t i) {
  return std::abs(table.latitude_deg[i]) <= 90 && table.longitude_deg[i] >= -180 && table.longitude_deg[i] <= 360 &&
         std::abs(table.time_s[i]) <= kLatestTimeS;
}

std::int32_t whole_number(const std::vector<double>& column, std::size_t i, std::int32_t otherwise) {
  if (column.empty() || std::isnan(column[i]) || std::abs(column[i]) > 1e9) return otherwise;
  return static_cast<std::int32_t>(std::lround(column[i]));
}

// Columns that must have an entry per location, and those that may.
bool lengths_fit(const SoundingTable& table) {
  const std::size_t n = table.locations, values = n * table.channels.size();
  const auto whole = [](std::size_t length, std::size_t wanted) { return length == wanted; };
  const auto fits = [](std::size_t length, std::size_t wanted) { return length == 0 || length == wanted; };
  return whole(table.latitude_deg.size(), n) && whole(table.longitude_deg.size(), n) && whole(table.time_s.size(), n) &&
         whole(table.observed_k.size(), values) && fits(table.numbers.size(), n) && fits(table.platform.size(), n) &&
         fits(table.scan_line.size(), n) && fits(table.field_of_view.size(), n) && fits(table.surface.size(), n) &&
         fits(table.first_guess_k.size(), values) &&
         std::all_of(table.variables.begin(), table.variables.end(),
                     [&](const auto& variable) { return variable.second.size() == n; });
}

// The places of the channels in ascending order of their numbers.
std::vector<std::size_t> channel_order(const std::vector<int>& channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return channels[a] < channels[b]; });
  return order;
}

}  // namespace

Result<ReadObservations> observations_of(SoundingTable table, const std::string& layout, const InputOptions& options,
                                         const std::string& name) {
  if (table.channels.empty()) return Error{ErrorKind::input, name + ": it has no channel. Send soundings."};
  if (!lengths_fit(table))
    return Error{ErrorKind::input, name + ": its variables differ in length. Ask the sender for it again."};
  ReadObservations contents;
  contents.layout = layout;
  contents.instrument = instrument_name(table.instrument);
  contents.message_count = 1;
  contents.notes = std::move(table.notes);
  ObservationSet& set = contents.observations;
  const std::vector<std::size_t> order = channel_order(table.channels);
  for (const std::size_t place : order) set.channels.push_back(table.channels[place]);
  if (std::adjacent_find(set.channels.begin(), set.channels.end()) != set.channels.end())
    return Error{ErrorKind::input, name + ": two of its channels have the same number. Send one instrument a file."};

  const std::int32_t platform = platform_of_name(options.platform).value_or(kUnknownNumber);
  const std::size_t channels = order.size();
  const bool has_first_guess = !table.first_guess_k.empty();
  std::vector<double> row(channels);
  std::vector<std::uint32_t> kept;
  set.reserve(table.locations);
  for (std::size_t i = 0; i < table.locations; ++i) {
    if (!has_place_and_time(table, i)) continue;
    const double* first_guess = has_first_guess ? &table.first_guess_k[i * channels] : nullptr;
    for (std::size_t c = 0; c < channels; ++c) {
      const bool has_innovation = !first_guess || !std::isnan(first_guess[order[c]]);
      row[c] = has_innovation ? table.observed_k[i * channels + order[c]] : kMissing;
      if (first_guess) set.first_guess_k.push_back(first_guess[order[c]]);
    }
    ObservationSet::Entry entry;
    entry.latitude_deg = table.latitude_deg[i];
    entry.longitude_deg = table.longitude_deg[i];
    entry.time_ms = std::llround(1000 * table.time_s[i]);
    entry.platform = whole_number(table.platform, i, platform);
    entry.instrument = table.instrument;
    entry.scan_line = whole_number(table.scan_line, i, kUnknownNumber);
    entry.field_of_view = whole_number(table.field_of_view, i, kUnknownNumber);
    entry.surface = table.surface.empty() ? Surface::unknown : table.surface[i];
    entry.source.subset = table.numbers.empty() ? static_cast<std::uint32_t>(i) : table.numbers[i];
    set.push_back(entry, row);
    kept.push_back(static_cast<std::uint32_t>(i));
  }
  if (set.size() == 0)
    return Error{ErrorKind::input, fmt::format("{}: none of its {} locations has a usable position and time. Ask the "
                                               "sender for located soundings.",
                                               name, table.locations)};
  for (const auto& [variable, column] : table.variables)
    for (const std::uint32_t i : kept) set.variables[variable].push_back(column[i]);
  if (const std::size_t left_out = table.locations - set.size(); left_out > 0)
    contents.skipped.push_back(
        {0, 0, fmt::format("{} of {} locations without usable position or time", left_out, table.locations)});
  return contents;
}

void join(ReadObservations&& other, ReadObservations& into) {
  into.observations.append(other.observations);
  into.instrument += ", " + other.instrument;
  into.skipped.insert(into.skipped.end(), other.skipped.begin(), other.skipped.end());
}

Instrument instrument_of_name(const std::string& name) {
  const std::string text = lower(name);
  constexpr std::pair<const char*, Instrument> kNames[] = {{"amsua", Instrument::amsua}, {"amsu-a", Instrument::amsua},
                                                           {"amsub", Instrument::amsub}, {"amsu-b", Instrument::amsub},
                                                           {"mhs", Instrument::mhs},     {"hirs", Instrument::hirs},
                                                           {"atms", Instrument::atms}};
  for (const auto& [known, instrument] : kNames)
    if (text.starts_with(known)) return instrument;
  return Instrument::unknown;
}

Instrument instrument_of_number(double number) {
  if (number == 570) return Instrument::amsua;
  if (number == 574) return Instrument::amsub;
  if (number == 203) return Instrument::mhs;
  if (number >= 605 && number <= 607) return Instrument::hirs;
  if (number == 621) return Instrument::atms;
  return Instrument::unknown;
}

Instrument instrument_of_channels(const std::vector<int>& channels, double second_frequency_ghz) {
  switch (channels.size()) {
    case 15:
      return Instrument::amsua;
    case 22:
      return Instrument::atms;
    case 19:
      return Instrument::hirs;
    case 5:  // their second channels lie at 157 and 150 GHz
      if (std::abs(second_frequency_ghz - 157) < 2) return Instrument::mhs;
      if (std::abs(second_frequency_ghz - 150) < 2) return Instrument::amsub;
      return Instrument::unknown;
    default:
      return Instrument::unknown;
  }
}

std::optional<std::int32_t> platform_of_name(const std::string& name) {
  if (const auto known = platform_number(name)) return known;
  const std::string text = lower(name);
  constexpr std::pair<const char*, const char*> kNames[] = {
      {"metop-1", "Metop-B"}, {"metop-2", "Metop-A"}, {"metop-3", "Metop-C"}, {"m01", "Metop-B"},
      {"m02", "Metop-A"},     {"m03", "Metop-C"},     {"npp", "Suomi-NPP"},   {"snpp", "Suomi-NPP"},
      {"metop_a", "Metop-A"}, {"metop_b", "Metop-B"}, {"metop_c", "Metop-C"}};
  for (const auto& [known, platform] : kNames)
    if (text == known) return platform_number(platform);
  const std::size_t digits = text.find_first_of("0123456789");
  if (digits == std::string::npos || text.size() > digits + 3 ||
      text.find_first_not_of("0123456789", digits) != std::string::npos)
    return std::nullopt;
  const std::string letters = text.substr(0, digits);
  if (letters.empty()) return std::stoi(text);
  if (letters == "n" || letters == "noaa" || letters == "noaa-" || letters == "noaa_")
    return platform_number("NOAA-" + std::to_string(std::stoi(text.substr(digits))));
  return std::nullopt;
}

std::optional<TimeUnits> parse_time_units(const std::string& units) {
  const std::size_t since = units.find(" since ");
  if (since == std::string::npos) return std::nullopt;
  TimeUnits parsed;
  const std::string unit = lower(units.substr(0, since));
  if (unit.starts_with("sec") || unit == "s")
    parsed.seconds_per_unit = 1;
  else if (unit.starts_with("min"))
    parsed.seconds_per_unit = 60;
  else if (unit.starts_with("hour") || unit == "h")
    parsed.seconds_per_unit = 3600;
  else if (unit.starts_with("day") || unit == "d")
    parsed.seconds_per_unit = 86400;
  else
    return std::nullopt;
  std::string origin = units.substr(since + 7);
  for (const char* utc : {" UTC", " +00:00", "+00:00", " +0:00", " 0:00", ".0"})
    if (origin.ends_with(utc)) origin.erase(origin.size() - std::char_traits<char>::length(utc));
  if (origin.size() > 10 && origin[10] == ' ') origin[10] = 'T';
  const auto origin_ms = from_iso8601(origin);
  if (!origin_ms) return std::nullopt;
  parsed.origin_s = static_cast<double>(*origin_ms) / 1000;
  return parsed;
}

std::optional<double> time_of_date_number(double date) {
  if (!(date >= 1900010100 && date < 2200000000)) return std::nullopt;
  const auto number = static_cast<std::int64_t>(date);
  CivilTime civil;
  civil.year = static_cast<int>(number / 1000000);
  civil.month = static_cast<int>(number / 10000 % 100);
  civil.day = static_cast<int>(number / 100 % 100);
  civil.hour = static_cast<int>(number % 100);
  const auto time_ms = to_time_ms(civil);
  return time_ms ? std::optional(static_cast<double>(*time_ms) / 1000) : std::nullopt;
}

}  // namespace thin
