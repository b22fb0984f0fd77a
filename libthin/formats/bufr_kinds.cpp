#include "libthin/formats/bufr_kinds.h"

#include <algorithm>
#include <iterator>

#include "libthin/formats/bufr_tank_tables.h"

namespace thin {
namespace {

constexpr int kFirstLocalCategory = 240;
constexpr int kSoundingsCategory = 3, kRadiancesCategory = 21;
constexpr int kHirsSequence = 310008, kAmsuBSequence = 310010, kAtmsSequence = 310061;

struct NamedDescriptor {
  int first, last;
  const char* name;
  const char* remedy;  // null for the one of other_sensor_remedy()
};

constexpr const char* kRadiances =
    "Its radiances or principal components are no brightness temperatures; keep it out of "
    "the inbox.";
constexpr NamedDescriptor kOtherSounders[] = {
    {310060, 310060, "CrIS", kRadiances},
    {310013, 310013, "AVHRR", nullptr},
    {310024, 310026, "SSMIS", nullptr},
    {310062, 310062, "VIIRS", nullptr},
    {340001, 340008, "IASI radiances or principal components", kRadiances},
    {310014, 310016, "geostationary radiances", nullptr},
    {310022, 310022, "AIRS", nullptr},
};

struct NamedNumber {
  int number;
  const char* name;
};
constexpr NamedNumber kSensors[] = {{1, "MSU"}, {2, "SSU"}, {5, "AVHRR"}, {6, "SSM/I"}};
constexpr NamedNumber kSatelliteInstruments[] = {{207, "SEVIRI"},  {221, "IASI"},  {420, "AIRS"}, {590, "AVHRR/2"},
                                                 {591, "AVHRR/3"}, {616, "VIIRS"}, {620, "CrIS"}, {623, "MSU"},
                                                 {627, "SSU"},     {905, "SSM/I"}, {908, "SSMIS"}};

// BUFR table A, as its users speak of it.
std::string category_name(int category) {
  switch (category) {
    case 0:
      return "SYNOP or other surface observations on land";
    case 1:
      return "SHIP, BUOY or other surface observations at sea";
    case 2:
      return "TEMP, PILOT or other ascents";
    case 3:
      return "satellite soundings";
    case 4:
      return "AIREP, AMDAR or other aircraft reports";
    case 5:
      return "satellite winds or other single-level satellite data";
    case 6:
      return "radar data";
    case 7:
      return "synoptic features";
    case 8:
      return "atmospheric composition";
    case 9:
      return "dispersal and transport";
    case 10:
      return "radiological data";
    case kTablesCategory:
      return "BUFR tables";
    case 12:
      return "satellite surface data";
    case 21:
      return "satellite radiances";
    case 31:
      return "ocean data";
    case 101:
      return "satellite images";
    default:
      return category >= kFirstLocalCategory ? "data of a local category" : "data";
  }
}

// F, X or Y outside the ranges that WMO keeps for itself.
bool is_local(int descriptor) {
  const int f = descriptor / 100'000;
  return (f == 0 || f == 3) && (descriptor / 1000 % 100 >= 48 || descriptor % 1000 >= 192);
}

bool has_local_descriptor(const BufrHeader& header) {
  return std::any_of(header.descriptors.begin(), header.descriptors.end(), is_local);
}

const NamedDescriptor* other_sounder(const BufrHeader& header) {
  for (const int descriptor : header.descriptors)
    for (const NamedDescriptor& sounder : kOtherSounders)
      if (descriptor >= sounder.first && descriptor <= sounder.last) return &sounder;
  return nullptr;
}

std::string number_of(const char* what, int number) {
  return std::string(" (") + what + std::to_string(number) + ")";
}

template <std::size_t n>
std::string name_of(const NamedNumber (&names)[n], int number, const char* what) {
  const auto found =
      std::find_if(std::begin(names), std::end(names), [&](const auto& name) { return name.number == number; });
  return (found == std::end(names) ? "another instrument" : found->name) + number_of(what, number);
}

}  // namespace

bool is_atms(const BufrHeader& header) {
  return std::find(header.descriptors.begin(), header.descriptors.end(), kAtmsSequence) != header.descriptors.end();
}

bool may_hold_soundings(const BufrHeader& header, bool has_own_tables) {
  const bool is_atovs = std::any_of(header.descriptors.begin(), header.descriptors.end(), [](int descriptor) {
    return descriptor >= kHirsSequence && descriptor <= kAmsuBSequence;
  });
  if (is_atovs || is_atms(header)) return true;
  if (other_sounder(header)) return false;
  return has_own_tables || header.data_category == kSoundingsCategory || header.data_category == kRadiancesCategory;
}

std::string sensor_name(int sensor) {
  return name_of(kSensors, sensor, "sensor ");
}

std::string satellite_instrument_name(int number) {
  return name_of(kSatelliteInstruments, number, "satellite instrument ");
}

MessageKind kind_of(const BufrHeader& header, bool has_own_tables) {
  const int category = header.data_category;
  if (category == kTablesCategory)
    return {"BUFR tables that travel inside the file (data category 11)",
            "Send them together with the data that they are for."};
  if (has_local_descriptor(header) && header.centre == kCentreNcep) {
    const bool prepbufr = category >= kFirstLocalCategory;
    const std::string name = (prepbufr ? "prepBUFR" : "NCEP data") + number_of("data category ", category);
    if (has_own_tables) return {name, "It holds no soundings that are read: send tanks such as 1bamua, 1bmhs, 1bhrs4."};
    return {name + " in NCEP's own descriptors, whose tables are not in the file",
            "Send the tank as a whole: its first messages are the tables (data category 11)."};
  }
  if (const NamedDescriptor* sounder = other_sounder(header)) {
    const int descriptor = *std::find_if(header.descriptors.begin(), header.descriptors.end(),
                                         [&](int one) { return one >= sounder->first && one <= sounder->last; });
    return {sounder->name + number_of("", descriptor), sounder->remedy ? sounder->remedy : other_sensor_remedy()};
  }
  if (header.descriptors.empty())
    return {"data without descriptors" + number_of("data category ", category), "Ask the sender for a whole file."};
  return {category_name(category) + number_of("data category ", category), "Send it elsewhere: it holds no soundings."};
}

std::string other_sensor_remedy() {
  return "AMSU-A, AMSU-B, MHS, HIRS and ATMS are thinned; keep other instruments out of the inbox.";
}

}  // namespace thin
