#pragma once

// BUFR messages with ATOVS soundings, made by ecCodes, in every shape that the sequence allows; and what may stand
// around them in a file.

#include <eccodes.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace thin::test {

using ByteVector = std::vector<std::uint8_t>;
constexpr double kMissingValue = std::numeric_limits<double>::quiet_NaN();

struct TestSounding {
  double latitude_deg = 10, longitude_deg = 20;
  double year = 2020, month = 6, day = 15, hour = 12, minute = 30, second = 1.25;
  double platform = 4, sensor = 3, scan_line = 7, field_of_view = 1;
  std::vector<std::pair<double, double>> slots;  // channel code and temperature
};

// Fifteen slots in order, temperatures that differ by channel and by `seed`.
inline TestSounding test_sounding(int seed) {
  TestSounding sounding;
  sounding.latitude_deg = -60 + 0.5 * seed;
  sounding.longitude_deg = 100 + 0.25 * seed;
  sounding.second = seed % 60 + 0.125;
  const int line = 1 + seed / 30;
  sounding.scan_line = line;
  sounding.field_of_view = 1 + seed % 30;
  for (int channel = 1; channel <= 15; ++channel)
    sounding.slots.emplace_back(27 + channel, 200 + channel + 0.01 * (seed * 7 % 100));
  return sounding;
}

inline std::vector<TestSounding> test_soundings(int count) {
  std::vector<TestSounding> soundings;
  for (int i = 0; i < count; ++i) soundings.push_back(test_sounding(i));
  return soundings;
}

struct MessageShape {
  int edition = 4;
  bool compressed = true;
  std::vector<long> descriptors = {310009};
  int slots_per_subset = 15;    // 19 for 310008
  int temperatures_behind = 0;  // brightnessTemperature among the descriptors behind the sequence
  bool ecmwf_section2 = false;
};

namespace bufr_detail {

inline void expect_done(int code, const std::string& what) {
  EXPECT_EQ(code, CODES_SUCCESS) << what << ": " << codes_get_error_message(code);
}

inline double encoded(double value) {
  return std::isnan(value) ? CODES_MISSING_DOUBLE : value;
}

// One element over all subsets, of `per_subset` such elements, the rank-th.
template <class Value>
void put_column(codes_handle* handle, const MessageShape& shape, const std::string& name, int rank, int per_subset,
                const std::vector<TestSounding>& soundings, Value value) {
  std::vector<double> column;
  for (const TestSounding& sounding : soundings) column.push_back(encoded(value(sounding)));
  if (shape.compressed) {
    const std::string key = "#" + std::to_string(rank) + "#" + name;
    expect_done(codes_set_double_array(handle, key.c_str(), column.data(), column.size()), key);
    return;
  }
  for (std::size_t i = 0; i < column.size(); ++i) {
    const std::string key = "#" + std::to_string(static_cast<int>(i) * per_subset + rank) + "#" + name;
    expect_done(codes_set_double(handle, key.c_str(), column[i]), key);
  }
}

inline void put_places(codes_handle* handle, const MessageShape& shape, const std::vector<TestSounding>& soundings) {
  const std::pair<const char*, double TestSounding::*> columns[] = {
      {"latitude", &TestSounding::latitude_deg},
      {"longitude", &TestSounding::longitude_deg},
      {"year", &TestSounding::year},
      {"month", &TestSounding::month},
      {"day", &TestSounding::day},
      {"hour", &TestSounding::hour},
      {"minute", &TestSounding::minute},
      {"second", &TestSounding::second},
      {"satelliteIdentifier", &TestSounding::platform},
      {"satelliteSensorIndicator", &TestSounding::sensor},
      {"scanLineNumber", &TestSounding::scan_line},
      {"fieldOfViewNumber", &TestSounding::field_of_view},
  };
  for (const auto& [name, member] : columns)
    put_column(handle, shape, name, 1, 1, soundings, [place = member](const TestSounding& s) { return s.*place; });
}

inline void put_slots(codes_handle* handle, const MessageShape& shape, const std::vector<TestSounding>& soundings) {
  // The longer sequence ends in one more channel number, of HIRS's visible channel.
  const int codes_per_subset = shape.slots_per_subset == 19 ? 20 : shape.slots_per_subset;
  for (int slot = 0; slot < shape.slots_per_subset; ++slot) {
    const auto slot_of = [&](const TestSounding& s) {
      const auto place = static_cast<std::size_t>(slot);
      return place < s.slots.size() ? s.slots[place] : std::pair(kMissingValue, kMissingValue);
    };
    put_column(handle, shape, "tovsOrAtovsOrAvhrrInstrumentationChannelNumber", slot + 1, codes_per_subset, soundings,
               [&](const TestSounding& s) { return slot_of(s).first; });
    put_column(handle, shape, "brightnessTemperature", slot + 1, shape.slots_per_subset + shape.temperatures_behind,
               soundings, [&](const TestSounding& s) { return slot_of(s).second; });
  }
}

}  // namespace bufr_detail

inline ByteVector make_message(const std::vector<TestSounding>& soundings, const MessageShape& shape = {}) {
  const std::string sample =
      std::string("BUFR") + std::to_string(shape.edition) + (shape.ecmwf_section2 ? "_local_satellite" : "");
  codes_handle* handle = codes_bufr_handle_new_from_samples(nullptr, sample.c_str());
  EXPECT_TRUE(handle) << sample;
  const auto set = [&](const char* key, long value) {
    bufr_detail::expect_done(codes_set_long(handle, key, value), key);
  };
  set("masterTablesVersionNumber", 13);
  set("localTablesVersionNumber", 0);
  set("dataCategory", 3);
  set("numberOfSubsets", static_cast<long>(soundings.size()));
  set("compressedData", shape.compressed ? 1 : 0);
  const long new_reference = -700;
  if (std::any_of(shape.descriptors.begin(), shape.descriptors.end(), [](long d) { return d / 1000 == 203; }))
    codes_set_long_array(handle, "inputOverriddenReferenceValues", &new_reference, 1);
  bufr_detail::expect_done(
      codes_set_long_array(handle, "unexpandedDescriptors", shape.descriptors.data(), shape.descriptors.size()),
      "unexpandedDescriptors");
  bufr_detail::put_places(handle, shape, soundings);
  bufr_detail::put_slots(handle, shape, soundings);
  set("pack", 1);
  if (shape.ecmwf_section2) set("localNumberOfObservations", static_cast<long>(soundings.size()));
  const void* bytes = nullptr;
  std::size_t size = 0;
  bufr_detail::expect_done(codes_get_message(handle, &bytes, &size), "codes_get_message");
  const auto* first = static_cast<const std::uint8_t*>(bytes);
  ByteVector message(first, first + size);
  codes_handle_delete(handle);
  return message;
}

inline ByteVector bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

inline ByteVector joined(const std::vector<ByteVector>& parts) {
  ByteVector all;
  for (const ByteVector& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// A bulletin as WMO files hold it: format 00, or 01 without start, number and end.
inline ByteVector bulletin(const ByteVector& content, int format = 0) {
  const std::string heading = "INAX01 EUMC 151230\r\r\n";
  const std::string start = format == 0 ? "\x01\r\r\n042\r\r\n" : "\r\r\n";
  const std::string end = format == 0 ? "\r\r\n\x03" : "";
  char prefix[24];
  std::snprintf(prefix, sizeof prefix, "%08zu%02d", start.size() + heading.size() + content.size() + end.size(),
                format);
  return joined({bytes_of(prefix + start + heading), content, bytes_of(end)});
}

inline void write_bytes(const std::string& path, const ByteVector& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(file.good()) << path;
}

inline ByteVector read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// A folder of its own for the running test, empty at first and gone at its end.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "." + test->name() + "." + std::to_string(::getpid()) +
                       "." + std::to_string(++made_);
    for (char& letter : name)
      if (letter == '/') letter = '_';
    folder_ = std::filesystem::temp_directory_path() / ("thin." + name);
    std::filesystem::create_directories(folder_);
  }
  ~ScratchFolder() { std::filesystem::remove_all(folder_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const ByteVector& bytes) const {
    write_bytes(path(name), bytes);
    return path(name);
  }

 private:
  inline static int made_ = 0;
  std::filesystem::path folder_;
};

}  // namespace thin::test
