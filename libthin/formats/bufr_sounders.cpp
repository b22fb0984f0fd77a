#include "libthin/formats/bufr_sounders.h"

#include <algorithm>

namespace thin {
namespace {

constexpr BufrSounder kSounders[] = {
    {Instrument::amsua, 3, 28, 15},
    {Instrument::amsub, 4, 43, 5},
    {Instrument::mhs, 11, 43, 5},
    {Instrument::hirs, 0, 1, 19},
    {Instrument::atms, kUnknownNumber, kUnknownNumber, kMostChannels},
};

constexpr BufrVariable kVariables[] = {
    {5021, "satellite_azimuth_deg"},        {7024, "satellite_zenith_angle_deg"},
    {7025, "solar_zenith_angle_deg"},       {10001, "surface_height_m"},
    {33030, "scan_line_status_flags"},      {33031, "scan_line_quality_flags"},
    {33033, "field_of_view_quality_flags"}, {33080, "scan_line_quality_flags"},  // ATMS
};

template <class Condition>
const BufrSounder* find_sounder(Condition condition) {
  const auto found = std::find_if(std::begin(kSounders), std::end(kSounders), condition);
  return found == std::end(kSounders) ? nullptr : found;
}

}  // namespace

std::span<const BufrSounder> bufr_sounders() {
  return kSounders;
}

const BufrSounder* sounder_of_sensor(int sensor) {
  return find_sounder([&](const BufrSounder& sounder) { return sensor >= 0 && sounder.sensor == sensor; });
}

const BufrSounder* sounder_of(Instrument instrument) {
  return find_sounder([&](const BufrSounder& sounder) { return sounder.instrument == instrument; });
}

int channel_of(const BufrSounder& sounder, int descriptor, double number) {
  const double channel = descriptor == kChannelCodeElement ? number - (sounder.first_channel_code - 1) : number;
  const bool is_numbered = descriptor != kChannelCodeElement || sounder.first_channel_code > 0;
  return is_numbered && channel >= 1 && channel <= sounder.channel_count ? static_cast<int>(channel) : 0;
}

std::span<const BufrVariable> bufr_variables() {
  return kVariables;
}

}  // namespace thin
