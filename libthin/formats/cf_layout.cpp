// CF discrete sampling geometries, featureType "point", with brightness temperatures: one entry per sounding along the
// dimension of latitude, longitude and time, which are known by their standard names; temperatures by theirs,
// toa_brightness_temperature, over that dimension and one of channels. docs/formats.md has the names of the rest.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "libthin/formats/netcdf_layout.h"
#include "libthin/formats/sounding_table.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kTemperature = "toa_brightness_temperature";
constexpr const char* kFlagName = "thinning_flag";

constexpr std::pair<const char*, const char*> kSharedNames[] = {
    {"sensor_zenith_angle", "satellite_zenith_angle_deg"},
    {"platform_zenith_angle", "satellite_zenith_angle_deg"},
    {"solar_zenith_angle", "solar_zenith_angle_deg"},
    {"sensor_azimuth_angle", "satellite_azimuth_deg"},
    {"platform_azimuth_angle", "satellite_azimuth_deg"},
    {"sensor_view_angle", "scan_angle_deg"},
    {"surface_altitude", "surface_height_m"},
    {"land_area_fraction", "land_fraction"},
};

const NetcdfVariable* find_by_standard_name(const NetcdfFile& file, const std::string& name) {
  for (const auto& [path, variable] : file.variables())
    if (file.text_attribute(variable, "standard_name") == name) return &variable;
  return nullptr;
}

class Reader {
 public:
  Reader(const NetcdfFile& file, const InputOptions& options) : file_(file), options_(options) {}

  Result<ReadObservations> read() {
    for (const auto step : {&Reader::read_places, &Reader::read_temperatures, &Reader::read_first_guess,
                            &Reader::apply_quality, &Reader::read_identities, &Reader::read_variables})
      if (Result<void> done = (this->*step)(); !done) return done.error();
    return observations_of(std::move(table_), cf_layout().name(), options_, file_.name());
  }

 private:
  Error lacks(const std::string& what) const {
    return {ErrorKind::input,
            fmt::format("{}: CF without {}. docs/formats.md says what soundings in CF look like.", file_.name(), what)};
  }

  bool over_observations(const NetcdfVariable& variable) const { return variable.dimensions == observation_; }

  Result<void> read_standard(const char* standard_name, std::vector<double>& target) {
    const NetcdfVariable* variable = find_by_standard_name(file_, standard_name);
    if (!variable || !over_observations(*variable)) return lacks(fmt::format("{} per observation", standard_name));
    Result<std::vector<double>> values = file_.numbers(*variable);
    if (!values) return values.error();
    target = std::move(*values);
    return {};
  }

  Result<void> read_places() {
    const NetcdfVariable* latitude = find_by_standard_name(file_, "latitude");
    if (!latitude || latitude->lengths.size() != 1) return lacks("latitude per observation");
    observation_ = latitude->dimensions;
    table_.locations = latitude->lengths.front();
    if (table_.locations == 0 || table_.locations > kMostLocations)
      return lacks(fmt::format("observations, or with more than {}", kMostLocations));
    for (const auto& [name, target] :
         {std::pair("latitude", &table_.latitude_deg), {"longitude", &table_.longitude_deg}, {"time", &table_.time_s}})
      if (Result<void> done = read_standard(name, *target); !done) return done;
    const auto units = file_.text_attribute(*find_by_standard_name(file_, "time"), "units");
    const auto parsed = units ? parse_time_units(*units) : std::nullopt;
    if (!parsed) return lacks("units of time, \"seconds since 1970-01-01T00:00:00Z\"");
    for (double& time_s : table_.time_s) time_s = parsed->origin_s + parsed->seconds_per_unit * time_s;
    return {};
  }

  Result<void> read_temperatures() {
    const NetcdfVariable* temperature = find_by_standard_name(file_, kTemperature);
    if (!temperature || temperature->lengths.size() != 2 || temperature->dimensions.front() != observation_.front())
      return lacks(fmt::format("{} over observations and channels", kTemperature));
    matrix_ = temperature->dimensions;
    Result<std::vector<double>> values = file_.numbers(*temperature);
    if (!values) return values.error();
    table_.observed_k = std::move(*values);
    const std::size_t count = temperature->lengths.back();
    table_.channels.resize(count);
    std::iota(table_.channels.begin(), table_.channels.end(), 1);
    const Result<std::vector<double>> numbers = file_.column(file_.dimension_name(matrix_.back()), count);
    if (!numbers) return numbers.error();
    for (std::size_t c = 0; c < numbers->size(); ++c) {
      if (!((*numbers)[c] >= 0 && (*numbers)[c] < 100000)) return lacks("usable channel numbers");
      table_.channels[c] = static_cast<int>(std::lround((*numbers)[c]));
    }
    if (numbers->empty())
      table_.notes.emplace_back("the file does not number its channels: they are taken as 1, 2, ...");
    return {};
  }

  // Over observations and channels; none, where there is no such variable.
  Result<std::vector<double>> matrix(const std::string& name) const {
    const NetcdfVariable* variable = file_.find(name);
    if (!variable || variable->dimensions != matrix_) return std::vector<double>();
    return file_.numbers(*variable);
  }

  Result<void> read_first_guess() {
    Result<std::vector<double>> first_guess = matrix(options_.cf_first_guess);
    if (!first_guess) return first_guess.error();
    if (first_guess->empty()) {
      rule_ = fmt::format("values: {}", kTemperature);
      table_.notes.push_back(fmt::format("no innovations: the file has no {}", options_.cf_first_guess));
      return {};
    }
    const Result<std::vector<double>> bias = matrix(options_.cf_bias);
    if (!bias) return bias.error();
    for (std::size_t i = 0; i < bias->size(); ++i) (*first_guess)[i] += (*bias)[i];
    rule_ = fmt::format("innovations: {}{} - {}", kTemperature, bias->empty() ? "" : " - " + options_.cf_bias,
                        options_.cf_first_guess);
    table_.first_guess_k = std::move(*first_guess);
    return {};
  }

  Result<void> apply_quality() {
    const NetcdfVariable* variable = file_.find(options_.cf_quality);
    if (variable && (variable->dimensions == matrix_ || over_observations(*variable))) {
      const Result<std::vector<double>> flags = file_.numbers(*variable);
      if (!flags) return flags.error();
      const std::size_t share = table_.observed_k.size() / flags->size();
      for (std::size_t i = 0; i < table_.observed_k.size(); ++i) {
        const double flag = (*flags)[i / share];
        if (std::none_of(options_.cf_accepted.begin(), options_.cf_accepted.end(),
                         [&](int good) { return flag == good; }))
          table_.observed_k[i] = kMissing;
      }
      rule_ += fmt::format(" where {} is {}", options_.cf_quality, fmt::join(options_.cf_accepted, " or "));
    }
    table_.notes.insert(table_.notes.begin(), rule_);
    return {};
  }

  Result<void> read_identities() {
    const std::pair<const char*, std::vector<double>*> columns[] = {{"satellite_identifier", &table_.platform},
                                                                    {"scan_line", &table_.scan_line},
                                                                    {"field_of_view", &table_.field_of_view}};
    for (const auto& [name, target] : columns) {
      Result<std::vector<double>> values = file_.column(name, table_.locations);
      if (!values) return values.error();
      *target = std::move(*values);
    }
    const auto satellite = file_.text_attribute("platform");
    const auto platform = satellite ? platform_of_name(*satellite) : std::nullopt;
    if (table_.platform.empty() && platform) table_.platform.assign(table_.locations, *platform);
    if (table_.platform.empty() && options_.platform.empty())
      table_.notes.emplace_back("the file does not say of which satellite it is: name it in [input] platform");
    if (const auto instrument = file_.text_attribute("instrument")) table_.instrument = instrument_of_name(*instrument);
    if (table_.instrument == Instrument::unknown) table_.instrument = instrument_of_channels(table_.channels, kMissing);
    const Result<std::vector<double>> surface = file_.column("surface_type", table_.locations);
    if (!surface) return surface.error();
    for (const double value : *surface)
      table_.surface.push_back(value >= 0 && value <= static_cast<double>(Surface::ice)
                                   ? static_cast<Surface>(static_cast<int>(value))
                                   : Surface::unknown);
    return {};
  }

  Result<void> read_variables() {
    for (const auto& [path, variable] : file_.variables()) {
      const auto standard_name = file_.text_attribute(variable, "standard_name");
      const bool is_place = standard_name == "latitude" || standard_name == "longitude" || standard_name == "time";
      if (!over_observations(variable) || is_place) continue;
      Result<std::vector<double>> values = file_.numbers(variable);
      if (!values) continue;  // texts, and other things that are no numbers
      const auto shared = std::find_if(std::begin(kSharedNames), std::end(kSharedNames),
                                       [&](const auto& entry) { return standard_name == entry.first; });
      table_.variables[shared == std::end(kSharedNames) ? path : shared->second] = std::move(*values);
    }
    return {};
  }

  const NetcdfFile& file_;
  const InputOptions& options_;
  SoundingTable table_;
  std::vector<int> observation_, matrix_;  // dimensions
  std::string rule_;
};

class CfLayout : public NetcdfLayout {
 public:
  const char* name() const override { return "cf"; }
  bool recognises(const NetcdfFile& file) const override {
    return file.text_attribute("featureType") == "point" && find_by_standard_name(file, kTemperature) != nullptr;
  }
  std::size_t locations(const NetcdfFile& file) const override {
    const NetcdfVariable* latitude = find_by_standard_name(file, "latitude");
    return latitude ? latitude->count() : 0;
  }
  Result<ReadObservations> read(const NetcdfFile& file, const InputOptions& options) const override {
    return Reader(file, options).read();
  }

  Result<NetcdfEdit> subset(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                            const OutputOptions&) const override {
    if (const Result<void> fits = check(file, retained); !fits) return fits.error();
    NetcdfEdit edit;
    edit.kept[find_by_standard_name(file, "latitude")->dimensions.front()].assign(retained.begin(), retained.end());
    edit.locations = retained.size();
    return edit;
  }

  Result<NetcdfEdit> flag(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                          const OutputOptions&) const override {
    if (const Result<void> fits = check(file, retained); !fits) return fits.error();
    NetcdfEdit edit;
    edit.locations = locations(file);
    std::vector<int> flags(edit.locations, 1);
    for (const std::uint32_t i : retained) flags[i] = 0;
    if (file.find(kFlagName))
      edit.replaced[kFlagName].assign(flags.begin(), flags.end());
    else
      edit.added.push_back(
          {kFlagName,
           find_by_standard_name(file, "latitude")->path,
           std::move(flags),
           {0, 1},
           {{"long_name", "whether thinning left the observation out"}, {"flag_meanings", "retained thinned"}}});
    return edit;
  }

 private:
  static Result<void> check(const NetcdfFile& file, std::span<const std::uint32_t> retained) {
    const NetcdfVariable* latitude = find_by_standard_name(file, "latitude");
    if (latitude && latitude->lengths.size() == 1 && (retained.empty() || retained.back() < latitude->lengths.front()))
      return {};
    return Error{ErrorKind::input, file.name() + ": it has fewer observations than when it was read. Read it again."};
  }
};

}  // namespace

const NetcdfLayout& cf_layout() {
  static const CfLayout layout;
  return layout;
}

}  // namespace thin
