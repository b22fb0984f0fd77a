// GSI's radiance diagnostics in netCDF (diag_amsua_n19_ges.*.nc4): a table of the channels over nchans, and everything
// else over nobs, which counts the channels of one location after the other: the channel fastest. Which entries are one
// location, Channel_Index and position tell.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "libthin/formats/netcdf_layout.h"
#include "libthin/formats/sounding_table.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kGsiMissing = -1e9;  // GSI writes -9.99e9
constexpr double kWholeFraction = 0.99;
constexpr const char* kFlagName = "Thinning_Flag";

// Variables with one value per location, under the names that every format shares, or their own.
constexpr std::pair<const char*, const char*> kLocationVariables[] = {
    {"Sat_Zenith_Angle", "satellite_zenith_angle_deg"},
    {"Sol_Zenith_Angle", "solar_zenith_angle_deg"},
    {"Sat_Azimuth_Angle", "satellite_azimuth_deg"},
    {"Elevation", "surface_height_m"},
    {"Land_Fraction", "land_fraction"},
    {"Water_Fraction", "Water_Fraction"},
    {"Ice_Fraction", "Ice_Fraction"},
    {"Snow_Fraction", "Snow_Fraction"},
    {"Sfc_Wind_Speed", "Sfc_Wind_Speed"},
    {"Cloud_Frac", "Cloud_Frac"},
    {"CLW", "CLW"},
};

struct Entries {
  std::vector<double> channel_index, latitude_deg, longitude_deg, time_h;
  std::vector<std::uint32_t> first;  // entry of each location, and the number of entries at the end
  std::size_t count() const { return channel_index.size(); }
};

Error damaged(const NetcdfFile& file, const std::string& what) {
  return {ErrorKind::input, fmt::format("{}: GSI diagnostics {}. Ask the sender for it again.", file.name(), what)};
}

Result<Entries> read_entries(const NetcdfFile& file) {
  const std::size_t count = file.dimension_length("nobs").value_or(0);
  Entries entries;
  const std::pair<const char*, std::vector<double>*> columns[] = {{"Channel_Index", &entries.channel_index},
                                                                  {"Latitude", &entries.latitude_deg},
                                                                  {"Longitude", &entries.longitude_deg},
                                                                  {"Obs_Time", &entries.time_h}};
  for (const auto& [name, column] : columns) {
    Result<std::vector<double>> values = file.column(name, count);
    if (!values) return values.error();
    if (values->empty()) return damaged(file, fmt::format("without {} for {} entries of nobs", name, count));
    *column = std::move(*values);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool same_place = i > 0 && entries.latitude_deg[i] == entries.latitude_deg[i - 1] &&
                            entries.longitude_deg[i] == entries.longitude_deg[i - 1] &&
                            entries.time_h[i] == entries.time_h[i - 1];
    if (!same_place || !(entries.channel_index[i] > entries.channel_index[i - 1]))
      entries.first.push_back(static_cast<std::uint32_t>(i));
  }
  entries.first.push_back(static_cast<std::uint32_t>(count));
  return entries;
}

class Reader {
 public:
  Reader(const NetcdfFile& file, const InputOptions& options) : file_(file), options_(options) {}

  Result<ReadObservations> read() {
    Result<Entries> entries = read_entries(file_);
    if (!entries) return entries.error();
    entries_ = std::move(*entries);
    table_.locations = entries_.first.size() - 1;
    for (const auto step :
         {&Reader::read_channels, &Reader::read_places, &Reader::read_values, &Reader::read_variables})
      if (Result<void> done = (this->*step)(); !done) return done.error();
    return observations_of(std::move(table_), gsi_layout().name(), options_, file_.name());
  }

 private:
  Result<void> read_channels() {
    const std::size_t count = file_.dimension_length("nchans").value_or(0);
    const Result<std::vector<double>> numbers = file_.column("sensor_chan", count);
    if (!numbers) return numbers.error();
    for (const double number : *numbers) {
      if (!(number >= 1 && number < 100000)) return damaged(file_, "with impossible channel numbers in sensor_chan");
      table_.channels.push_back(static_cast<int>(number));
    }
    if (table_.channels.empty()) return damaged(file_, "without sensor_chan");
    if (table_.locations > kMostLocations || table_.locations > kMostNetcdfValues / count)
      return damaged(file_,
                     fmt::format("with {} locations of {} channels, more than any file has", table_.locations, count));
    if (const auto sensor = file_.text_attribute("Observation_type")) table_.instrument = instrument_of_name(*sensor);
    const auto satellite = file_.text_attribute("Satellite");
    const auto platform = satellite ? platform_of_name(*satellite) : std::nullopt;
    if (platform)
      table_.platform.assign(table_.locations, *platform);
    else if (options_.platform.empty())
      table_.notes.push_back(fmt::format("the file's satellite \"{}\" is not known here: name it in [input] platform",
                                         satellite.value_or("")));
    return {};
  }

  // One value of each location: that of its first entry.
  std::vector<double> of_locations(const std::vector<double>& column) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < table_.locations && !column.empty(); ++i) {
      const double value = column[entries_.first[i]];
      values.push_back(value <= kGsiMissing ? kMissing : value);
    }
    return values;
  }

  Result<void> read_places() {
    const auto date = file_.number_attribute("date_time");
    const auto origin_s = date ? time_of_date_number(*date) : std::nullopt;
    if (!origin_s) return damaged(file_, "without date_time, the time of the analysis as 2021121200");
    table_.latitude_deg = of_locations(entries_.latitude_deg);
    table_.longitude_deg = of_locations(entries_.longitude_deg);
    for (const double hours : of_locations(entries_.time_h)) table_.time_s.push_back(*origin_s + 3600 * hours);
    const Result<std::vector<double>> scan_position = file_.column("Scan_Position", entries_.count());
    if (!scan_position) return scan_position.error();
    table_.field_of_view = of_locations(*scan_position);
    return {};
  }

  Result<void> read_values() {
    const Result<std::vector<double>> observed = file_.column("Observation", entries_.count());
    if (!observed) return observed.error();
    const Result<std::vector<double>> innovation = file_.column(options_.gsi_innovation, entries_.count());
    if (!innovation) return innovation.error();
    const Result<std::vector<double>> quality = file_.column("QC_Flag", entries_.count());
    if (!quality) return quality.error();
    if (observed->empty()) return damaged(file_, "without Observation");
    if (innovation->empty())
      return Error{ErrorKind::input, fmt::format("{}: it has no variable {} over nobs, which [input] gsi_innovation "
                                                 "names. Name one that it has.",
                                                 file_.name(), options_.gsi_innovation)};
    const std::size_t channels = table_.channels.size();
    table_.observed_k.assign(table_.locations * channels, kMissing);
    table_.first_guess_k.assign(table_.locations * channels, kMissing);
    for (std::size_t location = 0; location < table_.locations; ++location)
      for (std::size_t i = entries_.first[location]; i < entries_.first[location + 1]; ++i) {
        const double index = entries_.channel_index[i];
        if (!(index >= 1 && index <= static_cast<double>(channels)))
          return damaged(file_, fmt::format("whose Channel_Index {} is none of the {} channels", index, channels));
        const std::size_t place = location * channels + static_cast<std::size_t>(index) - 1;
        if ((*observed)[i] <= kGsiMissing || (*innovation)[i] <= kGsiMissing) continue;
        table_.first_guess_k[place] = (*observed)[i] - (*innovation)[i];
        if (quality->empty() || is_accepted((*quality)[i])) table_.observed_k[place] = (*observed)[i];
      }
    table_.notes.insert(
        table_.notes.begin(),
        fmt::format(
            "innovations: {}{}", options_.gsi_innovation,
            quality->empty() ? "" : fmt::format(" where QC_Flag is {}", fmt::join(options_.gsi_accepted, " or "))));
    return {};
  }

  bool is_accepted(double flag) const {
    return std::any_of(options_.gsi_accepted.begin(), options_.gsi_accepted.end(),
                       [&](int accepted) { return flag == accepted; });
  }

  Result<void> read_variables() {
    for (const auto& [name, shared] : kLocationVariables) {
      const Result<std::vector<double>> column = file_.column(name, entries_.count());
      if (!column) return column.error();
      if (!column->empty()) table_.variables[shared] = of_locations(*column);
    }
    const auto fraction = [&](const char* name) -> const std::vector<double>* {
      const auto found = table_.variables.find(name);
      return found == table_.variables.end() ? nullptr : &found->second;
    };
    const std::vector<double>*water = fraction("Water_Fraction"), *land = fraction("land_fraction"),
          *ice = fraction("Ice_Fraction"), *snow = fraction("Snow_Fraction");
    if (!water || !land || !ice || !snow) return {};
    // As GSI tells surfaces apart: more than 0.99 of one, or a mixture.
    for (std::size_t i = 0; i < table_.locations; ++i)
      table_.surface.push_back((*water)[i] > kWholeFraction                                 ? Surface::sea
                               : (*ice)[i] > kWholeFraction                                 ? Surface::ice
                               : (*land)[i] > kWholeFraction || (*snow)[i] > kWholeFraction ? Surface::land
                                                                                            : Surface::coast);
    return {};
  }

  const NetcdfFile& file_;
  const InputOptions& options_;
  Entries entries_;
  SoundingTable table_;
};

class GsiLayout : public NetcdfLayout {
 public:
  const char* name() const override { return "gsi_diagnostics"; }
  bool recognises(const NetcdfFile& file) const override {
    return file.dimension_length("nobs") && file.dimension_length("nchans") && file.find("Channel_Index") &&
           file.find("Obs_Time");
  }
  std::size_t locations(const NetcdfFile& file) const override {
    const Result<Entries> entries = read_entries(file);
    return entries ? entries->first.size() - 1 : 0;
  }
  Result<ReadObservations> read(const NetcdfFile& file, const InputOptions& options) const override {
    return Reader(file, options).read();
  }

  // All entries, that is all channels, of the retained locations.
  Result<NetcdfEdit> subset(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                            const OutputOptions&) const override {
    const Result<Entries> entries = read_checked(file, retained);
    if (!entries) return entries.error();
    NetcdfEdit edit;
    std::vector<std::uint32_t>& kept = edit.kept[file.find("Channel_Index")->dimensions.front()];
    for (const std::uint32_t location : retained)
      for (std::uint32_t i = entries->first[location]; i < entries->first[location + 1]; ++i) kept.push_back(i);
    edit.locations = retained.size();
    return edit;
  }

  // A variable of its own: QC_Flag says what GSI did.
  Result<NetcdfEdit> flag(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                          const OutputOptions&) const override {
    const Result<Entries> entries = read_checked(file, retained);
    if (!entries) return entries.error();
    NetcdfEdit edit;
    edit.locations = entries->first.size() - 1;
    std::vector<int> flags(entries->count(), 1);
    for (const std::uint32_t location : retained)
      std::fill(flags.begin() + entries->first[location], flags.begin() + entries->first[location + 1], 0);
    if (file.find(kFlagName))
      edit.replaced[kFlagName].assign(flags.begin(), flags.end());
    else
      edit.added.push_back(
          {kFlagName, "Channel_Index", std::move(flags), {0, 1}, {{"flag_meanings", "retained thinned"}}});
    return edit;
  }

 private:
  static Result<Entries> read_checked(const NetcdfFile& file, std::span<const std::uint32_t> retained) {
    Result<Entries> entries = read_entries(file);
    if (entries && !retained.empty() && retained.back() + 1 >= entries->first.size())
      return damaged(file, "have fewer locations than when they were read");
    return entries;
  }
};

}  // namespace

const NetcdfLayout& gsi_layout() {
  static const GsiLayout layout;
  return layout;
}

}  // namespace thin
