#include "libthin/formats/bufr_header.h"

#include <cassert>
#include <string>

namespace thin {
namespace {

constexpr std::size_t kSmallestSection1[] = {17, 17, 22};  // editions 2, 3, 4
constexpr std::size_t kSmallestSection3 = 7;
constexpr std::size_t kSmallestSection4 = 4;

Error misfit(const std::string& problem) {
  return {ErrorKind::input, problem};
}

// Length of the section at `offset`, checked against its smallest size and against `end`, the place of "7777".
Result<std::size_t> section_length(std::span<const std::uint8_t> message, int section, std::size_t offset,
                                   std::size_t smallest) {
  const std::size_t end = message.size() - kBufrSection5Size;
  const std::string name = "section " + std::to_string(section);
  if (offset + 3 > end) return misfit(name + " is not there: the sections before it fill the message");
  const std::size_t length = big_endian(message, offset, 3);
  if (length < smallest) return misfit(name + " is too short: its length field says " + std::to_string(length));
  if (length > end - offset)
    return misfit(name + " runs over the end of the message: its length field says " + std::to_string(length) + ", " +
                  std::to_string(end - offset) + " bytes are left");
  return length;
}

// Section 1 as far as it is needed; returns whether it announces a section 2.
bool read_section1(std::span<const std::uint8_t> section, BufrHeader& header) {
  header.master_table = section[3];
  header.master_table_version = section[header.edition == 4 ? 13 : 10];
  header.local_table_version = section[header.edition == 4 ? 14 : 11];
  if (header.edition == 4) {
    header.centre = static_cast<int>(big_endian(section, 4, 2));
    header.sub_centre = static_cast<int>(big_endian(section, 6, 2));
    header.data_category = section[10];
    header.data_sub_category = section[12];
    return (section[9] & 0x80) != 0;
  }
  // Edition 3 has the sub-centre in front of the centre, edition 2 one centre of two bytes.
  header.centre = header.edition == 3 ? section[5] : static_cast<int>(big_endian(section, 4, 2));
  header.sub_centre = header.edition == 3 ? section[4] : 0;
  header.data_category = section[8];
  header.data_sub_category = section[9];
  return (section[7] & 0x80) != 0;
}

void read_section3(std::span<const std::uint8_t> section, BufrHeader& header) {
  header.subset_count = static_cast<int>(big_endian(section, 4, 2));
  header.compressed = (section[6] & 0x40) != 0;
  // A single byte left over pads the section to an even length.
  for (std::size_t place = 7; place + 2 <= section.size(); place += 2) {
    const auto code = static_cast<int>(big_endian(section, place, 2));
    header.descriptors.push_back((code >> 14) * 100'000 + ((code >> 8) & 0x3f) * 1000 + (code & 0xff));
  }
}

}  // namespace

std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t offset, std::size_t count) {
  assert(count <= 4 && offset + count <= bytes.size());
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[offset + i];
  return value;
}

void put_big_endian(std::span<std::uint8_t> bytes, std::size_t offset, std::size_t count, std::uint32_t value) {
  assert(count <= 4 && offset + count <= bytes.size());
  for (std::size_t i = count; i-- > 0; value >>= 8) bytes[offset + i] = static_cast<std::uint8_t>(value);
}

Result<BufrHeader> parse_bufr_header(std::span<const std::uint8_t> message) {
  assert(message.size() >= kBufrSection0Size + kBufrSection5Size);
  BufrHeader header;
  header.edition = message[7];
  if (header.edition < 2 || header.edition > 4)
    return misfit("BUFR edition " + std::to_string(header.edition) + " is not read; 2, 3 and 4 are");

  std::size_t offset = kBufrSection0Size;
  Result<std::size_t> length = section_length(message, 1, offset, kSmallestSection1[header.edition - 2]);
  if (!length) return length.error();
  const bool has_section2 = read_section1(message.subspan(offset, *length), header);
  offset += *length;

  if (has_section2) {
    length = section_length(message, 2, offset, 4);
    if (!length) return length.error();
    header.section2_offset = offset;
    header.section2_length = *length;
    offset += *length;
  }

  length = section_length(message, 3, offset, kSmallestSection3);
  if (!length) return length.error();
  read_section3(message.subspan(offset, *length), header);
  header.section3_offset = offset;
  offset += *length;

  length = section_length(message, 4, offset, kSmallestSection4);
  if (!length) return length.error();
  header.section4_offset = offset;
  header.section4_length = *length;
  return header;
}

}  // namespace thin
