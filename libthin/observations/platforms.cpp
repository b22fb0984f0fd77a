#include "libthin/observations/platforms.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace thin {
namespace {

constexpr std::pair<std::int32_t, const char*> kPlatforms[] = {
    {3, "Metop-B"},   {4, "Metop-A"},   {5, "Metop-C"},   {200, "NOAA-8"},  {201, "NOAA-9"},
    {202, "NOAA-10"}, {203, "NOAA-11"}, {204, "NOAA-12"}, {205, "NOAA-14"}, {206, "NOAA-15"},
    {207, "NOAA-16"}, {208, "NOAA-17"}, {209, "NOAA-18"}, {223, "NOAA-19"}, {224, "Suomi-NPP"},
    {225, "NOAA-20"}, {226, "NOAA-21"}, {783, "Terra"},   {784, "Aqua"},
};

}  // namespace

std::string platform_name(std::int32_t platform) {
  for (const auto& [number, name] : kPlatforms)
    if (number == platform) return name;
  if (platform < 0) return "unknown satellite";
  return "satellite " + std::to_string(platform);
}

std::optional<std::int32_t> platform_number(const std::string& name) {
  const auto same_letter = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  for (const auto& [number, known_name] : kPlatforms) {
    const std::string known = known_name;
    if (std::equal(name.begin(), name.end(), known.begin(), known.end(), same_letter)) return number;
  }
  return std::nullopt;
}

}  // namespace thin
