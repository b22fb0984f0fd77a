#include "libthin/formats/ecmwf_section2.h"

namespace thin {
namespace {

constexpr std::size_t kSection2Size = 52;
constexpr std::size_t kTypeOffset = 4;
constexpr std::size_t kOldSubtypeOffset = 5;
constexpr std::size_t kSatelliteKeyOffset = 27;
constexpr std::size_t kMessageLengthOffset = 36;

bool is_satellite_type(int type) {
  return type == 2 || type == 3 || type == 8 || type == 12;
}

// The number of observations takes 16 bits for new or large reports, else 8; the satellite follows in 16 bits.
std::size_t count_size(std::span<const std::uint8_t> section, int subset_count) {
  const int subtype = section[kOldSubtypeOffset];
  return subtype == 255 || subset_count > 255 || (subtype >= 121 && subtype <= 130) || subtype == 31 ? 2 : 1;
}

struct SatelliteKey {
  std::uint32_t observation_count;
  std::uint32_t satellite;
};

SatelliteKey read_key(std::span<const std::uint8_t> section, int subset_count) {
  const std::size_t size = count_size(section, subset_count);
  return {big_endian(section, kSatelliteKeyOffset, size), big_endian(section, kSatelliteKeyOffset + size, 2)};
}

void put_key(std::span<std::uint8_t> section, int subset_count, SatelliteKey key, std::size_t old_size) {
  const std::size_t size = count_size(section, subset_count);
  // What is behind the key is spare; a byte that the shorter form sets free is cleared.
  if (size < old_size) section[kSatelliteKeyOffset + old_size + 1] = 0;
  put_big_endian(section, kSatelliteKeyOffset, size, key.observation_count);
  put_big_endian(section, kSatelliteKeyOffset + size, 2, key.satellite);
}

}  // namespace

void correct_ecmwf_section2(std::span<const std::uint8_t> original, const BufrHeader& original_header,
                            std::span<std::uint8_t> extracted, const BufrHeader& extracted_header) {
  if (original_header.centre != kCentreEcmwf || original_header.section2_length != kSection2Size ||
      extracted_header.section2_length != kSection2Size)
    return;
  const auto before = original.subspan(original_header.section2_offset, kSection2Size);
  const auto after = extracted.subspan(extracted_header.section2_offset, kSection2Size);

  if (big_endian(before, kMessageLengthOffset, 2) == original.size() && extracted.size() <= 0xffff)
    put_big_endian(after, kMessageLengthOffset, 2, static_cast<std::uint32_t>(extracted.size()));
  if (!is_satellite_type(before[kTypeOffset])) return;

  // The width of the count depends on the number of subsets, so that the satellite has to move with it in any case.
  SatelliteKey key = read_key(before, original_header.subset_count);
  const auto subsets_before = static_cast<std::uint32_t>(original_header.subset_count);
  if (key.observation_count == subsets_before)
    key.observation_count = static_cast<std::uint32_t>(extracted_header.subset_count);
  put_key(after, extracted_header.subset_count, key, count_size(before, original_header.subset_count));
}

}  // namespace thin
