#include "libthin/formats/bufr_kinds.h"

#include <algorithm>
#include <vector>

namespace thin {
namespace {

constexpr int kTablesCategory = 11;
constexpr int kFirstLocalCategory = 240;
constexpr int kPrepbufrFirstCategory = 240;

struct NamedDescriptor {
  int first, last;
  const char* name;
};

constexpr NamedDescriptor kSounders[] = {
    {310061, 310061, "ATMS"},
    {310060, 310060, "CrIS"},
    {310013, 310013, "AVHRR"},
    {310024, 310026, "SSMIS"},
    {310062, 310062, "VIIRS"},
    {340001, 340008, "IASI radiances or principal components"},
    {310014, 310016, "geostationary radiances"},
    {310022, 310022, "AIRS"},
};

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

// Whether every replication (1XXYYY: the next XX descriptors) ends within the list, and within the replication around
// it. ecCodes 2.28 overflows its stack over those that do not.
bool replications_nest(const std::vector<int>& descriptors) {
  std::vector<std::size_t> ends;
  for (std::size_t place = 0; place < descriptors.size(); ++place) {
    while (!ends.empty() && ends.back() <= place) ends.pop_back();
    if (descriptors[place] / 100'000 != 1) continue;
    const auto replicated = static_cast<std::size_t>(descriptors[place] / 1000 % 100);
    const std::size_t factor = descriptors[place] % 1000 == 0 ? 1 : 0;  // its descriptor stands in between
    const std::size_t end = place + 1 + factor + replicated;
    if (replicated == 0 || end > (ends.empty() ? descriptors.size() : ends.back())) return false;
    ends.push_back(end);
  }
  return true;
}

// Whether every operator (2XXYYY) is one of table C's, and each that refers to a bitmap (quality information 222000 and
// its like) has one behind it: data present indicators 031031, or an earlier bitmap used again, 237000. ecCodes 2.28
// follows null pointers over those that have none.
bool operators_are_whole(const std::vector<int>& descriptors) {
  for (auto descriptor = descriptors.begin(); descriptor != descriptors.end(); ++descriptor) {
    if (*descriptor / 100'000 != 2) continue;
    const int x = *descriptor / 1000 % 100;
    const bool known =
        (x >= 1 && x <= 8) || (x >= 21 && x <= 25) || x == 32 || (x >= 35 && x <= 37) || (x >= 41 && x <= 43);
    const bool needs_bitmap = (x >= 22 && x <= 25) || x == 32;
    const bool has_bitmap = std::any_of(descriptor, descriptors.end(), [](int d) { return d == 31031 || d == 237000; });
    if (!known || (needs_bitmap && !has_bitmap)) return false;
  }
  return true;
}

std::string number_of(const char* what, int number) {
  return std::string(" (") + what + std::to_string(number) + ")";
}

}  // namespace

bool is_atovs(const BufrHeader& header) {
  return std::any_of(header.descriptors.begin(), header.descriptors.end(),
                     [](int descriptor) { return descriptor >= kHirsSequence && descriptor <= kAmsuBSequence; });
}

// What keeps ranks from meaning what they mean in a lone ATOVS sequence; empty for nothing. Behind the sequence
// anything may follow; in front of it single elements may stand that it doesn't hold itself: they shift no rank.
std::string unsuitable_atovs(const BufrHeader& header) {
  const auto is_sequence = [](int descriptor) { return descriptor >= kHirsSequence && descriptor <= kAmsuBSequence; };
  const auto first = std::find_if(header.descriptors.begin(), header.descriptors.end(), is_sequence);
  if (std::count_if(header.descriptors.begin(), header.descriptors.end(), is_sequence) != 1)
    return "it holds several ATOVS sequences, of which none can be chosen";
  if (!replications_nest(header.descriptors)) return "its descriptors repeat more descriptors than there are";
  if (!operators_are_whole(header.descriptors)) return "its descriptors have operators without sense";
  for (auto descriptor = header.descriptors.begin(); descriptor != first; ++descriptor) {
    const int element_class = *descriptor / 1000;
    const bool own = *descriptor == 1007 || *descriptor == 2048 || *descriptor == 2150 || *descriptor == 12063 ||
                     element_class == 4 || element_class == 5 || element_class == 6;
    if (*descriptor >= 100'000 || own)
      return "descriptor " + std::to_string(*descriptor) + " stands in front of the ATOVS sequence, which is not read";
  }
  return "";
}

std::string sensor_name(int sensor) {
  const char* name = sensor == kSensorHirs    ? "HIRS"
                     : sensor == kSensorAmsuA ? "AMSU-A"
                     : sensor == kSensorAmsuB ? "AMSU-B"
                     : sensor == kSensorMhs   ? "MHS"
                                              : "another instrument";
  return name + number_of("sensor ", sensor);
}

MessageKind kind_of(const BufrHeader& header) {
  const int category = header.data_category;
  if (category == kTablesCategory)
    return {"BUFR tables that travel inside the file (data category 11)",
            "ecCodes does not take tables from the file: ask the sender for messages in WMO's own tables."};
  if (has_local_descriptor(header) && header.centre == kCentreNcep) {
    const bool prepbufr = category >= kPrepbufrFirstCategory;
    return {std::string(prepbufr ? "prepBUFR" : "NCEP data") + number_of("data category ", category) +
                " in NCEP's own descriptors, whose tables travel inside the file",
            "ecCodes cannot decode it as it is: ask for the WMO form (310009), as on the GTS or EUMETCast."};
  }
  for (const int descriptor : header.descriptors)
    for (const NamedDescriptor& sounder : kSounders)
      if (descriptor >= sounder.first && descriptor <= sounder.last)
        return {sounder.name + number_of("", descriptor), other_sensor_remedy()};
  if (header.descriptors.empty())
    return {"data without descriptors" + number_of("data category ", category), "Ask the sender for a whole file."};
  return {category_name(category) + number_of("data category ", category), "Send it elsewhere: it holds no soundings."};
}

std::string other_sensor_remedy() {
  return "This version thins AMSU-A; keep other instruments out of the inbox.";
}

}  // namespace thin
