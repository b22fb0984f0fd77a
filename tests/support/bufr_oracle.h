#pragma once

// BUFR decoded the slow, obvious way: ecCodes finds the messages, every key is asked for by name, every value is kept
// as text, and a sounding is put together key by key. Nothing here is shared with libthin/formats.

#include <eccodes.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "libthin/observations/observation_set.h"
#include "libthin/observations/time.h"

namespace thin::test {

// A message as text: header keys once, data keys once per subset. In the keys of data the rank counts within a subset.
struct OracleMessage {
  std::map<std::string, std::string> header;
  std::map<std::string, std::vector<std::string>> data;
  std::size_t subset_count = 0;
};

inline std::vector<std::string> all_values(codes_handle* handle, const std::string& key) {
  std::size_t count = 0;
  if (codes_get_size(handle, key.c_str(), &count) != CODES_SUCCESS) return {"no size"};
  int type = 0;
  codes_get_native_type(handle, key.c_str(), &type);
  std::vector<std::string> values;
  if (type == CODES_TYPE_STRING && count <= 1) {
    char text[512] = "";
    std::size_t length = sizeof text;
    codes_get_string(handle, key.c_str(), text, &length);
    return {text};
  }
  std::vector<double> numbers(count);
  if (codes_get_double_array(handle, key.c_str(), numbers.data(), &count) != CODES_SUCCESS) return {"not a number"};
  for (std::size_t i = 0; i < count; ++i) {
    char text[64];
    std::snprintf(text, sizeof text, "%a", numbers[i]);
    values.emplace_back(text);
  }
  return values;
}

inline std::vector<std::string> all_keys(codes_handle* handle) {
  std::vector<std::string> keys;
  codes_bufr_keys_iterator* iterator = codes_bufr_keys_iterator_new(handle, 0);
  while (codes_bufr_keys_iterator_next(iterator)) keys.emplace_back(codes_bufr_keys_iterator_get_name(iterator));
  codes_bufr_keys_iterator_delete(iterator);
  return keys;
}

struct RankedKey {
  std::size_t rank = 0;  // from 1
  std::string name;      // with "->attribute"
  std::string element;   // without
};

inline RankedKey split_key(const std::string& key) {
  const std::size_t end = key.find('#', 1);
  const std::string name = key.substr(end + 1);
  return {std::stoul(key.substr(1, end - 1)), name, name.substr(0, name.find("->"))};
}

// Decodes the message that `handle` holds.
inline OracleMessage decode_slowly(codes_handle* handle) {
  OracleMessage message;
  EXPECT_EQ(codes_set_long(handle, "unpack", 1), CODES_SUCCESS);
  long subsets = 0;
  long compressed = 0;
  codes_get_long(handle, "numberOfSubsets", &subsets);
  codes_get_long(handle, "compressedData", &compressed);
  message.subset_count = static_cast<std::size_t>(subsets);

  const std::vector<std::string> keys = all_keys(handle);
  std::map<std::string, std::size_t> occurrences;
  for (const std::string& key : keys)
    if (key[0] == '#') ++occurrences[split_key(key).name];
  for (const std::string& key : keys) {
    const std::vector<std::string> values = all_values(handle, key);
    if (key[0] != '#') {
      for (const std::string& value : values) message.header[key] += value + " ";
      continue;
    }
    const RankedKey ranked = split_key(key);
    if (compressed) {
      auto& column = message.data[key];
      for (std::size_t i = 0; i < message.subset_count; ++i)
        column.push_back(values.size() == 1 ? values[0] : values[i]);
    } else {
      // Ranks run over the subsets, which are all alike here.
      const std::size_t per_subset = occurrences[ranked.element] / message.subset_count;
      auto& column = message.data["#" + std::to_string((ranked.rank - 1) % per_subset + 1) + "#" + ranked.name];
      column.push_back(values[0]);
    }
  }
  return message;
}

// Every message of a file that ecCodes finds and opens.
inline std::vector<OracleMessage> decode_file_slowly(const std::filesystem::path& path) {
  std::vector<OracleMessage> messages;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  EXPECT_TRUE(file) << path;
  if (!file) return messages;
  int code = 0;
  while (codes_handle* handle = codes_bufr_handle_new_from_file(nullptr, file, &code)) {
    messages.push_back(decode_slowly(handle));
    codes_handle_delete(handle);
  }
  std::fclose(file);
  return messages;
}

inline double oracle_number(const OracleMessage& message, const std::string& key, std::size_t subset) {
  const auto found = message.data.find(key);
  if (found == message.data.end()) return std::numeric_limits<double>::quiet_NaN();
  const double value = std::strtod(found->second.at(subset).c_str(), nullptr);
  return value == CODES_MISSING_DOUBLE ? std::numeric_limits<double>::quiet_NaN() : value;
}

// A compressed message for those that are too long to be kept as text: the array of a key when it is asked for.
class KeyedMessage {
 public:
  // Takes the handle over.
  explicit KeyedMessage(codes_handle* handle) : handle_(handle, &codes_handle_delete) {
    EXPECT_EQ(codes_set_long(handle, "skipExtraKeyAttributes", 1), CODES_SUCCESS);
    EXPECT_EQ(codes_set_long(handle, "unpack", 1), CODES_SUCCESS);
    long subsets = 0, compressed = 0;
    codes_get_long(handle, "numberOfSubsets", &subsets);
    codes_get_long(handle, "compressedData", &compressed);
    EXPECT_TRUE(compressed || subsets == 0);
    subset_count = static_cast<std::size_t>(subsets);
  }

  // One value, or one for each subset; none where there is no such key.
  const std::vector<double>& values(const std::string& key) const {
    const auto [found, is_new] = columns_.try_emplace(key);
    std::size_t count = 0;
    if (is_new && codes_get_size(handle_.get(), key.c_str(), &count) == CODES_SUCCESS) {
      found->second.resize(count);
      EXPECT_EQ(codes_get_double_array(handle_.get(), key.c_str(), found->second.data(), &count), CODES_SUCCESS) << key;
    }
    return found->second;
  }

  std::vector<std::string> data_keys() const {
    std::vector<std::string> keys;
    for (const std::string& key : all_keys(handle_.get()))
      if (key[0] == '#' && key.find("->") == std::string::npos) keys.push_back(key);
    return keys;
  }

  std::size_t subset_count = 0;

 private:
  std::unique_ptr<codes_handle, int (*)(codes_handle*)> handle_;
  mutable std::map<std::string, std::vector<double>> columns_;
};

inline double oracle_number(const KeyedMessage& message, const std::string& key, std::size_t subset) {
  const std::vector<double>& values = message.values(key);
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double value = values.size() == 1 ? values[0] : values.at(subset);
  return value == CODES_MISSING_DOUBLE ? std::numeric_limits<double>::quiet_NaN() : value;
}

// Every message with subsets of soundings (not NCEP's tables) that ecCodes finds and opens.
template <class Use>
void for_each_keyed_message(const std::filesystem::path& path, const Use& use) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  ASSERT_TRUE(file) << path;
  int code = 0;
  std::uint32_t number = 0;
  while (codes_handle* handle = codes_bufr_handle_new_from_file(nullptr, file, &code)) {
    long category = 0;
    codes_get_long(handle, "dataCategory", &category);
    if (category == 11)
      codes_handle_delete(handle);
    else
      use(number, KeyedMessage(handle));
    ++number;
  }
  std::fclose(file);
}

// One field of view, by its keys.
struct OracleSounding {
  Instrument instrument = Instrument::unknown;
  double latitude_deg = 0, longitude_deg = 0;
  std::int64_t time_ms = 0;
  int platform = 0, scan_line = 0, field_of_view = 0;
  double satellite_zenith_deg = 0, solar_zenith_deg = 0;
  std::map<int, double> temperature_k;  // by channel; those that are missing are not in it
};

// Instrument, number of channels, and the code of channel 1 in tovsOrAtovsOrAvhrrInstrumentationChannelNumber.
struct OracleInstrument {
  Instrument instrument = Instrument::unknown;
  int channels = 0;
  int first_code = 0;
};

inline OracleInstrument oracle_instrument(double sensor, double satellite_instrument) {
  if (sensor == 3 || satellite_instrument == 570) return {Instrument::amsua, 15, 28};
  if (sensor == 4 || satellite_instrument == 574) return {Instrument::amsub, 5, 43};
  if (sensor == 11 || satellite_instrument == 203) return {Instrument::mhs, 5, 43};
  if (sensor == 0 || (satellite_instrument >= 605 && satellite_instrument <= 607)) return {Instrument::hirs, 19, 1};
  if (satellite_instrument == 621) return {Instrument::atms, 22, 0};
  return {};
}

template <class Message>
OracleSounding oracle_sounding(const Message& message, std::size_t subset,
                               const std::string& temperature_key = "brightnessTemperature") {
  const auto number = [&](const std::string& name) { return oracle_number(message, "#1#" + name, subset); };
  const auto whole = [&](const std::string& name) {
    return std::isnan(number(name)) ? -1 : static_cast<int>(number(name));
  };
  OracleSounding sounding;
  sounding.latitude_deg = number("latitude");
  sounding.longitude_deg = number("longitude");
  const auto time_ms =
      to_time_ms({whole("year"), whole("month"), whole("day"), whole("hour"), whole("minute"), number("second")});
  EXPECT_TRUE(time_ms.has_value());
  sounding.time_ms = time_ms.value_or(0);
  sounding.platform = whole("satelliteIdentifier");
  sounding.scan_line = whole("scanLineNumber");
  sounding.field_of_view = whole("fieldOfViewNumber");
  sounding.satellite_zenith_deg = number("satelliteZenithAngle");
  sounding.solar_zenith_deg = number("solarZenithAngle");
  double sensor = number("satelliteSensorIndicator");
  // Where nothing names the instrument, the channels do.
  const double first_code = number("tovsOrAtovsOrAvhrrInstrumentationChannelNumber");
  if (std::isnan(sensor) && first_code >= 28 && first_code <= 42) sensor = 3;
  const OracleInstrument instrument = oracle_instrument(sensor, number("satelliteInstruments"));
  sounding.instrument = instrument.instrument;
  for (int slot = 22; slot >= 1; --slot) {
    const std::string rank = "#" + std::to_string(slot) + "#";
    const double code = oracle_number(message, rank + "tovsOrAtovsOrAvhrrInstrumentationChannelNumber", subset);
    const double plain = oracle_number(message, rank + "channelNumber", subset);
    const double channel = std::isnan(code) ? plain : code - instrument.first_code + 1;
    const double temperature_k = oracle_number(message, rank + temperature_key, subset);
    if (channel >= 1 && channel <= instrument.channels && !std::isnan(temperature_k))
      sounding.temperature_k[static_cast<int>(channel)] = temperature_k;
  }
  return sounding;
}

}  // namespace thin::test
