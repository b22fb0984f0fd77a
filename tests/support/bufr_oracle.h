#pragma once

// BUFR decoded the slow, obvious way: ecCodes finds the messages, every key is asked for by name, every value is kept
// as text, and a sounding is put together key by key. Nothing here is shared with libthin/formats.

#include <eccodes.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

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

// One field of view of AMSU-A, by its keys.
struct OracleSounding {
  double latitude_deg = 0, longitude_deg = 0;
  std::int64_t time_ms = 0;
  int platform = 0, scan_line = 0, field_of_view = 0;
  std::array<double, 15> temperature_k{};  // NaN for missing
};

inline double oracle_number(const OracleMessage& message, const std::string& key, std::size_t subset) {
  const auto found = message.data.find(key);
  if (found == message.data.end()) return std::numeric_limits<double>::quiet_NaN();
  const double value = std::strtod(found->second.at(subset).c_str(), nullptr);
  return value == CODES_MISSING_DOUBLE ? std::numeric_limits<double>::quiet_NaN() : value;
}

inline OracleSounding oracle_sounding(const OracleMessage& message, std::size_t subset) {
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
  sounding.temperature_k.fill(std::numeric_limits<double>::quiet_NaN());
  for (int slot = 20; slot >= 1; --slot) {
    const std::string rank = "#" + std::to_string(slot) + "#";
    const double code = oracle_number(message, rank + "tovsOrAtovsOrAvhrrInstrumentationChannelNumber", subset);
    const double temperature_k = oracle_number(message, rank + "brightnessTemperature", subset);
    for (int channel = 1; channel <= 15; ++channel)
      if (code == 27 + channel && !std::isnan(temperature_k))
        sounding.temperature_k[static_cast<std::size_t>(channel - 1)] = temperature_k;
  }
  return sounding;
}

}  // namespace thin::test
