#pragma once

// NCEP tanks, bit by bit: messages of tables (data category 11), then messages of data in the sequences that those
// tables define. Nothing here is shared with libthin/formats, and no ecCodes is needed. Elements and sequences are
// those of NC021023 and NC021027 (1bamua, 1bmhs) as NCEP's tables print them.

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace thin::test {

class BitString {
 public:
  void put(std::uint64_t value, int width) {
    for (int bit = width - 1; bit >= 0; --bit) bits_.push_back(value >> bit & 1);
  }
  void put_text(const std::string& text, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) put(i < text.size() ? static_cast<unsigned char>(text[i]) : ' ', 8);
  }
  std::vector<std::uint8_t> bytes() const {
    std::vector<std::uint8_t> packed((bits_.size() + 7) / 8, 0);
    for (std::size_t i = 0; i < bits_.size(); ++i)
      if (bits_[i]) packed[i / 8] |= static_cast<std::uint8_t>(0x80U >> i % 8);
    return packed;
  }

 private:
  std::vector<bool> bits_;
};

struct TankElement {
  int descriptor;  // as FXXYYY
  const char* mnemonic;
  const char* unit;
  int scale;
  long reference;
  int width;
};

struct TankSequence {
  int descriptor;
  const char* mnemonic;
  std::vector<int> members;  // 360001 to 360004 in front of what is repeated as often as the data say
};

struct TankTables {
  std::vector<TankElement> elements;
  std::vector<TankSequence> sequences;
};

// A message of edition 3 by NCEP. `descriptors` as FXXYYY.
inline std::vector<std::uint8_t> tank_message(int category, int sub_category, int subsets, bool compressed,
                                              const std::vector<int>& descriptors, const BitString& data) {
  std::vector<std::uint8_t> message = {'B', 'U', 'F', 'R', 0, 0, 0, 3};
  const auto put = [&](std::size_t value, int bytes) {
    for (int byte = bytes - 1; byte >= 0; --byte) message.push_back(static_cast<std::uint8_t>(value >> 8 * byte));
  };
  put(18, 3);
  for (const int byte : {0, 3, 7, 0, 0, category, sub_category, 29, 0, 20, 10, 26, 21, 0, 0}) put(byte, 1);
  const std::size_t section3 = 7 + 2 * descriptors.size();
  put(section3 + section3 % 2, 3);
  put(0, 1);
  put(static_cast<std::size_t>(subsets), 2);
  put(compressed ? 0xc0 : 0x80, 1);
  for (const int descriptor : descriptors)
    put(static_cast<std::size_t>(descriptor / 100'000 << 14 | descriptor / 1000 % 100 << 8 | descriptor % 1000), 2);
  if (section3 % 2) put(0, 1);
  std::vector<std::uint8_t> packed = data.bytes();
  if (packed.size() % 2) packed.push_back(0);
  put(4 + packed.size(), 3);
  put(0, 1);
  message.insert(message.end(), packed.begin(), packed.end());
  for (int i = 0; i < 4; ++i) message.push_back('7');
  const std::size_t size = message.size();
  for (int byte = 0; byte < 3; ++byte)
    message[4 + static_cast<std::size_t>(byte)] = static_cast<std::uint8_t>(size >> 8 * (2 - byte));
  return message;
}

// The tables as one message, in the form of NCEP's DX tables.
inline std::vector<std::uint8_t> tank_table_message(const TankTables& tables) {
  BitString data;
  const auto put_descriptor = [&](int descriptor) {
    char text[8];
    std::snprintf(text, sizeof text, "%06d", descriptor);
    data.put_text(text, 6);
  };
  data.put(0, 8);  // table A has no entries
  data.put(tables.elements.size(), 8);
  for (const TankElement& element : tables.elements) {
    put_descriptor(element.descriptor);
    data.put_text(std::string(element.mnemonic) + "  A NAME", 64);
    data.put_text(element.unit, 24);
    data.put_text(element.scale < 0 ? "-" : "+", 1);
    data.put_text(std::to_string(std::abs(element.scale)), 3);
    data.put_text(element.reference < 0 ? "-" : "+", 1);
    data.put_text(std::to_string(std::abs(element.reference)), 10);
    char width[8];
    std::snprintf(width, sizeof width, "%3d", element.width);
    data.put_text(width, 3);
  }
  data.put(tables.sequences.size(), 8);
  for (const TankSequence& sequence : tables.sequences) {
    put_descriptor(sequence.descriptor);
    data.put_text(std::string(sequence.mnemonic) + " A SEQUENCE", 64);
    data.put(sequence.members.size(), 8);
    for (const int member : sequence.members) put_descriptor(member);
  }
  return tank_message(11, 1, 1, false,
                      {103000, 31001, 1, 2, 3, 101000, 31001, 300004, 105000, 31001, 300003, 205064, 101000, 31001, 30},
                      data);
}

// 1bamua or 1bmhs: `instrument` 570 or 203, with 15 or 5 channels.
struct TankShape {
  int instrument = 570;
  int channels = 15;
  int sequence = 361223;
  int temperature_width = 16, temperature_scale = 2;  // of 012163
  bool compressed = true;
  bool counted_channels = false;  // a replication whose count stands in the data
};

inline TankTables tank_tables(const TankShape& shape) {
  std::vector<int> members = {4001, 4002, 4003, 4004, 4005, 4006,  207002, 5002, 6002,   207000, 1007,
                              2019, 5043, 8012, 7024, 7025, 10001, 202127, 7002, 202000, 5022,   5021};
  if (shape.counted_channels)
    members.insert(members.end(), {360002, 361171});
  else
    members.insert(members.end(), {101000 + shape.channels, 361171});
  return {{{4001, "YEAR", "YEAR", 0, 0, 12},
           {4002, "MNTH", "MONTH", 0, 0, 4},
           {4003, "DAYS", "DAY", 0, 0, 6},
           {4004, "HOUR", "HOUR", 0, 0, 5},
           {4005, "MINU", "MINUTE", 0, 0, 6},
           {4006, "SECO", "SECOND", 0, 0, 6},
           {5002, "CLAT", "DEGREE", 2, -9000, 15},
           {6002, "CLON", "DEGREE", 2, -18000, 16},
           {1007, "SAID", "CODE TABLE", 0, 0, 10},
           {2019, "SIID", "CODE TABLE", 0, 0, 11},
           {5043, "FOVN", "NUMERIC", 0, 0, 8},
           {8012, "LSQL", "CODE TABLE", 0, 0, 2},
           {7024, "SAZA", "DEGREE", 2, -9000, 15},
           {7025, "SOZA", "DEGREE", 2, -9000, 15},
           {10001, "HOLS", "M", 0, -400, 15},
           {7002, "HMSL", "M", -1, -40, 16},
           {5022, "SOLAZI", "DEGREE TRUE", 2, 0, 16},
           {5021, "BEARAZ", "DEGREE TRUE", 2, 0, 16},
           {5042, "CHNM", "NUMERIC", 0, 0, 6},
           {12163, "TMBR", "KELVIN", shape.temperature_scale, 0, shape.temperature_width},
           {12206, "CSTC", "KELVIN", 2, 0, 10}},
          {{361171, "BRITCSTC", {5042, 12163, 12206}}, {shape.sequence, "NC021000", members}}};
}

// The same as lines of ecCodes' definitions: element.table and sequence.def of a folder for local tables.
inline std::string eccodes_elements() {
  return "#code|abbreviation|type|name|unit|scale|reference|width\n"
         "012206|coldSpaceTemperatureCorrection|double|CSTC|K|2|0|10|K|2|4\n";
}
inline std::string eccodes_sequences(const std::vector<TankShape>& shapes) {
  std::string text;
  for (const TankShape& shape : shapes)
    for (const TankSequence& sequence : tank_tables(shape).sequences) {
      text += '"' + std::to_string(sequence.descriptor) + "\" = [ ";
      for (std::size_t i = 0; i < sequence.members.size(); ++i) {
        char member[16];
        std::snprintf(member, sizeof member, "%s%06d", i ? ", " : "", sequence.members[i]);
        text += member;
      }
      text += " ]\n";
    }
  return text;
}

struct TankSounding {
  long second = 0, latitude_e4 = 0, longitude_e4 = 0;  // degrees / 10,000
  long satellite = 3, field_of_view = 1, surface = 1, zenith_e2 = 1000, height_m = 0;
  std::vector<long> temperature;  // in the unit of the tank's own scale; -1 for missing
};

inline std::vector<TankSounding> tank_soundings(int count, const TankShape& shape) {
  std::vector<TankSounding> soundings;
  for (int i = 0; i < count; ++i) {
    TankSounding sounding;
    sounding.second = i == 5 ? 60 : i % 60;
    sounding.latitude_e4 = -600'000 + 5003L * i;
    sounding.longitude_e4 = 1'700'000 - 7001L * i;
    sounding.field_of_view = 1 + i % 30;
    sounding.surface = i % 3;
    sounding.zenith_e2 = -5000 + 37 * i;
    sounding.height_m = i % 3 == 0 ? 10 * i : 0;
    for (int channel = 1; channel <= shape.channels; ++channel)
      sounding.temperature.push_back(channel == 7 && i % 4 == 1 ? -1 : 20'000 + 100 * channel + i * 13 % 97);
    soundings.push_back(sounding);
  }
  return soundings;
}

inline std::vector<std::uint8_t> tank_data_message(const std::vector<TankSounding>& soundings, const TankShape& shape) {
  // Of each element its width, and its number in each subset; all bits set where that is -1.
  struct Column {
    int width;
    std::vector<long> numbers;
  };
  std::vector<Column> columns;
  const auto add = [&](int width, auto number) {
    columns.push_back({width, {}});
    for (const TankSounding& sounding : soundings) columns.back().numbers.push_back(number(sounding));
  };
  const auto constant = [](long number) { return [number](const TankSounding&) { return number; }; };
  for (const auto& [width, number] : {std::pair(12, 2020), {4, 10}, {6, 26}, {5, 21}, {6, 3}})
    add(width, constant(number));
  add(6, [](const TankSounding& s) { return s.second; });
  add(22, [](const TankSounding& s) { return s.latitude_e4 + 900'000; });
  add(23, [](const TankSounding& s) { return s.longitude_e4 + 1'800'000; });
  add(10, [](const TankSounding& s) { return s.satellite; });
  add(11, constant(shape.instrument));
  add(8, [](const TankSounding& s) { return s.field_of_view; });
  add(2, [](const TankSounding& s) { return s.surface; });
  add(15, [](const TankSounding& s) { return s.zenith_e2 + 9000; });
  add(15, constant(12'000));
  add(15, [](const TankSounding& s) { return s.height_m + 400; });
  add(16, constant(8230 + 40));
  add(16, constant(26'759));
  add(16, [](const TankSounding& s) { return 7000 + s.field_of_view; });
  if (shape.counted_channels) add(8, constant(shape.channels));
  for (int channel = 1; channel <= shape.channels; ++channel) {
    add(6, constant(channel));
    add(shape.temperature_width,
        [&](const TankSounding& s) { return s.temperature[static_cast<std::size_t>(channel - 1)]; });
    add(10, [&](const TankSounding& s) { return s.field_of_view % 5 == 0 ? -1 : 100 + channel; });
  }

  BitString data;
  const auto ones = [](int width) { return ~0ULL >> (64 - width); };
  const auto raw = [&](long number, int width) {
    return number < 0 ? ones(width) : static_cast<std::uint64_t>(number);
  };
  if (!shape.compressed)
    for (std::size_t subset = 0; subset < soundings.size(); ++subset)
      for (const Column& column : columns) data.put(raw(column.numbers[subset], column.width), column.width);
  for (const Column& column : columns) {
    if (!shape.compressed) break;
    long least = -1, most = -1;
    bool missing = false;
    for (const long number : column.numbers) {
      missing = missing || number < 0;
      if (number >= 0 && (least < 0 || number < least)) least = number;
      if (number > most) most = number;
    }
    data.put(raw(least, column.width), column.width);
    int width = 0;
    if (least >= 0 && (missing || most > least))
      while (static_cast<long>(ones(++width)) <= most - least) continue;
    data.put(static_cast<std::uint64_t>(width), 6);
    if (width == 0) continue;
    for (const long number : column.numbers) data.put(number < 0 ? ones(width) : number - least, width);
  }
  const int sub_category = shape.instrument == 570 ? 23 : 27;
  return tank_message(21, sub_category, static_cast<int>(soundings.size()), shape.compressed, {shape.sequence}, data);
}

}  // namespace thin::test
