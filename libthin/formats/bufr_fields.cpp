#include "libthin/formats/bufr_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "libthin/formats/bufr_sounders.h"

namespace thin {
namespace {

bool is_one_of(int descriptor, std::span<const int> elements) {
  return std::find(elements.begin(), elements.end(), descriptor) != elements.end();
}

bool is_channel(int descriptor) {
  return descriptor == kChannelCodeElement || descriptor == kChannelNumberElement;
}

bool is_temperature(int descriptor, BufrTemperature temperature) {
  return temperature == BufrTemperature::antenna ? descriptor == kAntennaTemperatureElement
                                                 : is_one_of(descriptor, kBrightnessTemperatureElements);
}

// The fields of a subset that describe soundings; what a quality block says about them comes behind.
std::span<const BufrField> described_fields(const AlikeSubsets& group) {
  const auto end = std::find_if(group.fields.begin(), group.fields.end(),
                                [](const BufrField& field) { return field.in_quality_block; });
  return {group.fields.begin(), end};
}

const BufrField* find_field(const AlikeSubsets& group, int descriptor) {
  for (const BufrField& field : described_fields(group))
    if (field.descriptor == descriptor && !field.text) return &field;
  return nullptr;
}

}  // namespace

std::vector<BufrSlot> slots_of(const AlikeSubsets& group, BufrTemperature temperature) {
  std::vector<BufrSlot> slots;
  for (const BufrField& field : described_fields(group)) {
    if (field.text) continue;
    if (is_channel(field.descriptor))
      slots.push_back({&field, nullptr});
    else if (!slots.empty() && !slots.back().temperature && is_temperature(field.descriptor, temperature))
      slots.back().temperature = &field;
  }
  std::erase_if(slots, [](const BufrSlot& slot) { return !slot.temperature; });
  return slots;
}

BufrColumn column_of(const BufrData& data, const AlikeSubsets& group, int descriptor) {
  const BufrField* field = find_field(group, descriptor);
  return field ? data.column(group, *field) : BufrColumn();
}

BufrColumn column_of(const BufrData& data, const AlikeSubsets& group, std::span<const int> elements) {
  for (const int descriptor : elements)
    if (find_field(group, descriptor)) return column_of(data, group, descriptor);
  return {};
}

std::int32_t number_or_unknown(double value) {
  constexpr double kLargest = std::numeric_limits<std::int32_t>::max();
  return value >= 0 && value <= kLargest ? static_cast<std::int32_t>(value) : kUnknownNumber;
}

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
        descriptor = field.descriptor;
      }
    if (count > 1)
      return fmt::format("{} (descriptor {}) stands {} times in a subset, and none says which is the sounding's",
                         place.name, descriptor, count);
    if (count == 0) return fmt::format("it holds no {}", place.name);
  }
  return "";
}

}  // namespace thin
