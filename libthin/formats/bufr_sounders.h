#pragma once

// The instruments that are read from BUFR, and the elements that they are read from: one table each. To read another
// instrument is a line more.

#include <array>
#include <span>

#include "libthin/observations/observation_set.h"

namespace thin {

struct BufrSounder {
  Instrument instrument = Instrument::unknown;
  int sensor = kUnknownNumber;  // code table 002048, of the ATOVS sequences 310008 to 310010
  // Channel 1 in code table 002150, where TOVS' and ATOVS' channels are numbered on; elsewhere (005042) 1 is 1.
  int first_channel_code = kUnknownNumber;
  int channel_count = 0;  // with brightness temperatures. HIRS has one more, which is a radiance
};

std::span<const BufrSounder> bufr_sounders();

// Null for instruments that are not read.
const BufrSounder* sounder_of_sensor(int sensor);
const BufrSounder* sounder_of(Instrument instrument);

// Channel from 1 by a number in kChannelCodeElement or kChannelNumberElement; 0 where it is another instrument's,
// unused, missing, or has no brightness temperature.
int channel_of(const BufrSounder& sounder, int descriptor, double number);

constexpr int kMostChannels = 22;

// Elements, as FXXYYY. Where there are two, NCEP's tanks and files of different resolutions have one or the other.
constexpr int kSatelliteElement = 1007;
constexpr int kSatelliteInstrumentElement = 2019;
constexpr int kSensorElement = 2048;
constexpr std::array<int, 2> kLatitudeElements = {5001, 5002};
constexpr std::array<int, 2> kLongitudeElements = {6001, 6002};
constexpr int kFirstClockElement = 4001;  // year, month, day, hour, minute, second
constexpr int kScanLineElement = 5041;
constexpr int kFieldOfViewElement = 5043;
constexpr int kSurfaceElement = 8012;
constexpr int kChannelCodeElement = 2150;
constexpr int kChannelNumberElement = 5042;
constexpr std::array<int, 2> kBrightnessTemperatureElements = {12063, 12163};
constexpr int kAntennaTemperatureElement = 12066;

// Further numbers of each field of view, under the names that ObservationSet::variables has in every format.
struct BufrVariable {
  int descriptor;
  const char* name;
};
std::span<const BufrVariable> bufr_variables();

}  // namespace thin
