// JEDI's IODA: groups MetaData, ObsValue and others over the dimensions Location and Channel, as ioda-v2 and later
// write them; and the older form without groups, variables called "variable@Group" over nlocs and nchans, or one
// variable for each channel, "brightness_temperature_7@ObsValue".

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "libthin/formats/netcdf_layout.h"
#include "libthin/formats/sounding_table.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr int kIodaThinned = 16;  // QCflags::thinned of JEDI's UFO
constexpr const char* kObservedNames[] = {"brightnessTemperature", "brightness_temperature"};

// Variables of MetaData under the names that every format shares, new name and old.
constexpr std::pair<const char*, const char*> kSharedNames[] = {
    {"sensorZenithAngle", "satellite_zenith_angle_deg"},
    {"sensor_zenith_angle", "satellite_zenith_angle_deg"},
    {"solarZenithAngle", "solar_zenith_angle_deg"},
    {"solar_zenith_angle", "solar_zenith_angle_deg"},
    {"sensorAzimuthAngle", "satellite_azimuth_deg"},
    {"sensor_azimuth_angle", "satellite_azimuth_deg"},
    {"sensorViewAngle", "scan_angle_deg"},
    {"sensor_view_angle", "scan_angle_deg"},
    {"heightOfSurface", "surface_height_m"},
    {"heightOfLandSurface", "surface_height_m"},
    {"height", "surface_height_m"},
    {"landAreaFraction", "land_fraction"},
    {"surface_land_fraction", "land_fraction"},
};

// One variable of a group, in either form of the layout.
const NetcdfVariable* find(const NetcdfFile& file, const std::string& group, const std::string& name) {
  if (const NetcdfVariable* variable = file.find(group + "/" + name)) return variable;
  return file.find(name + "@" + group);
}

const NetcdfVariable* find(const NetcdfFile& file, const std::string& group, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const NetcdfVariable* variable = find(file, group, name)) return variable;
  return nullptr;
}

// "latitude", where the path is that of a variable of MetaData.
std::optional<std::string> metadata_name(const std::string& path) {
  if (path.starts_with("MetaData/")) return path.substr(9);
  if (path.ends_with("@MetaData")) return path.substr(0, path.size() - 9);
  return std::nullopt;
}

// The variables of a group that together hold a number for each location and channel: one over both, or one a channel.
struct Matrix {
  std::vector<const NetcdfVariable*> parts;
  std::vector<int> channels;  // of the parts, where there is one a channel
};

Matrix find_matrix(const NetcdfFile& file, const std::string& group) {
  for (const char* name : kObservedNames)
    if (const NetcdfVariable* variable = find(file, group, name)) return {{variable}, {}};
  std::map<int, const NetcdfVariable*> by_channel;
  const std::string before = "brightness_temperature_", behind = "@" + group, folder = group + "/";
  for (const auto& [path, variable] : file.variables()) {
    std::string name = path;
    if (name.starts_with(folder))
      name.erase(0, folder.size());
    else if (name.ends_with(behind))
      name.erase(name.size() - behind.size());
    else
      continue;
    int channel = 0;
    if (!name.starts_with(before)) continue;
    const char* end = name.data() + name.size();
    if (std::from_chars(name.data() + before.size(), end, channel).ptr == end) by_channel[channel] = &variable;
  }
  Matrix matrix;
  for (const auto& [channel, variable] : by_channel) {
    matrix.channels.push_back(channel);
    matrix.parts.push_back(variable);
  }
  return matrix;
}

class Reader {
 public:
  Reader(const NetcdfFile& file, const InputOptions& options) : file_(file), options_(options) {}

  Result<ReadObservations> read() {
    for (const auto step : {&Reader::read_places, &Reader::read_times, &Reader::read_observed, &Reader::read_channels,
                            &Reader::read_first_guess, &Reader::apply_quality, &Reader::read_variables})
      if (Result<void> done = (this->*step)(); !done) return done.error();
    return observations_of(std::move(table_), ioda_layout().name(), options_, file_.name());
  }

 private:
  Error lacks(const std::string& what, const std::string& remedy) const {
    return {ErrorKind::input, fmt::format("{}: IODA without {}. {}", file_.name(), what, remedy)};
  }

  bool over_locations(const NetcdfVariable& variable) const {
    return variable.lengths.size() == 1 && variable.dimensions == location_;
  }

  // One number per location; none where the file has no such variable.
  Result<std::vector<double>> column(std::initializer_list<const char*> names) const {
    const NetcdfVariable* variable = find(file_, "MetaData", names);
    if (!variable || !over_locations(*variable)) return std::vector<double>();
    return file_.numbers(*variable);
  }

  Result<void> read_into(std::vector<double>& target, std::initializer_list<const char*> names) const {
    Result<std::vector<double>> values = column(names);
    if (!values) return values.error();
    target = std::move(*values);
    return {};
  }

  Result<void> read_places() {
    const NetcdfVariable* latitude = find(file_, "MetaData", {"latitude"});
    if (!latitude || latitude->lengths.size() != 1 || !find(file_, "MetaData", {"longitude"}))
      return lacks("MetaData/latitude and longitude over its locations", "Send located soundings.");
    location_ = latitude->dimensions;
    table_.locations = latitude->lengths.front();
    if (table_.locations == 0) return lacks("a single location", "There is nothing in it to thin: don't send it.");
    if (table_.locations > kMostLocations)
      return lacks("a limit to its locations", fmt::format("More than {} are refused: split it.", kMostLocations));
    if (Result<void> done = read_into(table_.latitude_deg, {"latitude"}); !done) return done;
    if (Result<void> done = read_into(table_.longitude_deg, {"longitude"}); !done) return done;
    if (Result<void> done = read_into(table_.platform, {"satelliteIdentifier", "satellite_identifier", "satelliteID"});
        !done)
      return done;
    if (Result<void> done = read_into(table_.scan_line, {"scanLineNumber", "scan_line_number", "scan_line"}); !done)
      return done;
    return read_into(table_.field_of_view, {"sensorScanPosition", "scan_position", "fieldOfViewNumber"});
  }

  Result<void> read_times() {
    if (const NetcdfVariable* time = find(file_, "MetaData", {"dateTime", "datetime"})) {
      const auto units = file_.text_attribute(*time, "units");
      const auto parsed = units ? parse_time_units(*units) : std::nullopt;
      if (parsed && over_locations(*time)) return read_numeric_times(*time, *parsed);
      if (!units || !parsed) return read_text_times(*time);
    }
    // Hours from the time that the file names, 2018041500.
    const NetcdfVariable* time = find(file_, "MetaData", {"time"});
    const auto date_time = file_.number_attribute("date_time");
    const auto origin = date_time ? time_of_date_number(*date_time) : std::nullopt;
    if (!time || !over_locations(*time) || !origin)
      return lacks("MetaData/dateTime", "Convert it with a current version of JEDI's converters.");
    return read_numeric_times(*time, {3600, *origin});
  }

  Result<void> read_numeric_times(const NetcdfVariable& variable, const TimeUnits& units) {
    Result<std::vector<double>> values = file_.numbers(variable);
    if (!values) return values.error();
    for (double& value : *values) value = units.origin_s + units.seconds_per_unit * value;
    table_.time_s = std::move(*values);
    return {};
  }

  Result<void> read_text_times(const NetcdfVariable& variable) {
    const Result<std::vector<std::string>> texts = file_.texts(variable);
    if (!texts) return texts.error();
    for (const std::string& text : *texts) {
      const auto time_ms = from_iso8601(text);
      table_.time_s.push_back(time_ms ? static_cast<double>(*time_ms) / 1000 : kMissing);
    }
    return {};
  }

  // locations x channels, channels as they stand in the observed group.
  Result<std::vector<double>> matrix(const Matrix& found, const std::string& group) const {
    if (found.parts.size() == 1 && found.channels.empty()) {
      const NetcdfVariable& variable = *found.parts.front();
      const bool fits = variable.lengths.size() == 2 && variable.dimensions.front() == location_.front() &&
                        (channel_count_ == 0 || variable.lengths.back() == channel_count_);
      if (fits) return file_.numbers(variable);
    } else if (found.channels == table_.channels || table_.channels.empty()) {
      const std::size_t width = found.parts.size();
      if (width * table_.locations > kMostNetcdfValues) return lacks("a limit to its values", "Split it.");
      std::vector<double> values(width * table_.locations);
      for (std::size_t c = 0; c < width; ++c) {
        if (!over_locations(*found.parts[c])) return lacks(group + " over its locations", "It is damaged.");
        const Result<std::vector<double>> part = file_.numbers(*found.parts[c]);
        if (!part) return part.error();
        for (std::size_t i = 0; i < table_.locations; ++i) values[i * width + c] = (*part)[i];
      }
      return values;
    }
    return lacks(fmt::format("{}/brightnessTemperature over its locations and channels", group),
                 "Its dimensions differ from those of the observed values: ask the sender for it again.");
  }

  Result<void> read_observed() {
    observed_ = options_.ioda_observed;
    const Matrix found = find_matrix(file_, observed_);
    if (found.parts.empty())
      return lacks(fmt::format("brightness temperatures ({}/brightnessTemperature)", observed_),
                   "Send soundings, or name the group of the observed values in [input] ioda_observed.");
    table_.channels = found.channels;
    Result<std::vector<double>> values = matrix(found, observed_);
    if (!values) return values.error();
    table_.observed_k = std::move(*values);
    channel_count_ = table_.observed_k.size() / table_.locations;
    return {};
  }

  Result<void> read_channels() {
    if (table_.channels.empty()) {
      if (Result<void> numbers = read_channel_numbers(); !numbers) return numbers;
    }
    double second_frequency_ghz = kMissing;
    if (const NetcdfVariable* frequency = per_channel({"sensorCentralFrequency", "frequency"})) {
      const Result<std::vector<double>> values = file_.numbers(*frequency);
      if (values && channel_count_ > 1) second_frequency_ghz = (*values)[1] > 1e6 ? (*values)[1] / 1e9 : (*values)[1];
    }
    if (const auto sensor = file_.text_attribute("sensor")) table_.instrument = instrument_of_name(*sensor);
    if (table_.instrument == Instrument::unknown)
      table_.instrument = instrument_of_channels(table_.channels, second_frequency_ghz);
    if (!table_.platform.empty()) return {};
    for (const char* attribute : {"satellite", "platformCommonName", "platform"})
      if (const auto satellite = file_.text_attribute(attribute))
        if (const auto platform = platform_of_name(*satellite)) {
          table_.platform.assign(table_.locations, *platform);
          return {};
        }
    if (options_.platform.empty())
      table_.notes.emplace_back("the file does not say of which satellite it is: name it in [input] platform");
    return {};
  }

  const NetcdfVariable* per_channel(std::initializer_list<const char*> names) const {
    for (const char* group : {"MetaData", "VarMetaData"})
      for (const char* name : names) {
        const NetcdfVariable* variable = find(file_, group, name);
        if (variable && variable->lengths == std::vector<std::size_t>{channel_count_}) return variable;
      }
    return nullptr;
  }

  // sensorChannelNumber; else the coordinate of the channels, which some files leave 0; else from 1.
  Result<void> read_channel_numbers() {
    const NetcdfVariable* variable = per_channel({"sensorChannelNumber", "sensor_channel", "channelNumber"});
    for (const char* coordinate : {"Channel", "nchans"}) {
      const NetcdfVariable* other = file_.find(coordinate);
      if (!variable && other && other->lengths == std::vector<std::size_t>{channel_count_}) variable = other;
    }
    table_.channels.resize(channel_count_);
    std::iota(table_.channels.begin(), table_.channels.end(), 1);
    if (!variable) {
      table_.notes.emplace_back("the file does not number its channels: they are taken as 1, 2, ...");
      return {};
    }
    const Result<std::vector<double>> values = file_.numbers(*variable);
    if (!values) return values.error();
    if (std::all_of(values->begin(), values->end(), [](double value) { return value == 0; })) return {};
    for (std::size_t c = 0; c < channel_count_; ++c) {
      const double number = (*values)[c];
      if (!(number >= 0 && number < 100000)) return lacks("usable channel numbers", "Ask the sender for it again.");
      table_.channels[c] = static_cast<int>(std::lround(number));
    }
    return {};
  }

  Result<void> read_first_guess() {
    for (const std::string& group : options_.ioda_first_guess) {
      const Matrix found = find_matrix(file_, group);
      if (found.parts.empty()) continue;
      Result<std::vector<double>> values = matrix(found, group);
      if (!values) return values.error();
      table_.first_guess_k = std::move(*values);
      first_guess_ = group;
      return add_bias();
    }
    table_.notes.push_back(
        fmt::format("no innovations: the file has none of {}", fmt::join(options_.ioda_first_guess, ", ")));
    return {};
  }

  // For first guesses that are not yet corrected for bias.
  Result<void> add_bias() {
    const std::string& group = options_.ioda_bias;
    if (group.empty()) return {};
    const Matrix found = find_matrix(file_, group);
    if (found.parts.empty())
      return lacks("the bias that [input] ioda_bias names, " + group, "Name another group, or none: ioda_bias = \"\".");
    const Result<std::vector<double>> values = matrix(found, group);
    if (!values) return values.error();
    for (std::size_t i = 0; i < values->size(); ++i) table_.first_guess_k[i] += (*values)[i];
    first_guess_ = fmt::format("({} + {})", first_guess_, group);
    return {};
  }

  Result<void> apply_quality() {
    std::string rule = first_guess_.empty() ? observed_ : observed_ + " - " + first_guess_;
    for (const std::string& group : options_.ioda_quality) {
      const Matrix found = find_matrix(file_, group);
      if (found.parts.empty()) continue;
      const Result<std::vector<double>> values = matrix(found, group);
      if (!values) return values.error();
      for (std::size_t i = 0; i < values->size(); ++i)
        if (!is_accepted((*values)[i])) table_.observed_k[i] = kMissing;
      rule += fmt::format(" where {} is {}", group, fmt::join(options_.ioda_accepted, " or "));
      break;
    }
    table_.notes.insert(table_.notes.begin(), (first_guess_.empty() ? "values: " : "innovations: ") + rule);
    return {};
  }

  bool is_accepted(double flag) const {
    return std::any_of(options_.ioda_accepted.begin(), options_.ioda_accepted.end(),
                       [&](int accepted) { return flag == accepted; });
  }

  Result<void> read_variables() {
    for (const auto& [path, variable] : file_.variables()) {
      const std::optional<std::string> name = metadata_name(path);
      if (!name || !over_locations(variable)) continue;
      Result<std::vector<double>> values = file_.numbers(variable);
      if (!values) continue;  // texts, and other things that are no numbers
      const auto shared = std::find_if(std::begin(kSharedNames), std::end(kSharedNames),
                                       [&](const auto& entry) { return *name == entry.first; });
      if (*name == "landOrSeaQualifier") set_surface(*values);
      table_.variables["MetaData/" + *name] = *values;
      if (shared != std::end(kSharedNames)) table_.variables[shared->second] = std::move(*values);
    }
    return {};
  }

  // BUFR code table 008012.
  void set_surface(const std::vector<double>& qualifier) {
    for (const double value : qualifier)
      table_.surface.push_back(value == 0   ? Surface::land
                               : value == 1 ? Surface::sea
                               : value == 2 ? Surface::coast
                                            : Surface::unknown);
  }

  const NetcdfFile& file_;
  const InputOptions& options_;
  SoundingTable table_;
  std::vector<int> location_;  // its one dimension
  std::size_t channel_count_ = 0;
  std::string observed_, first_guess_;
};

class IodaLayout : public NetcdfLayout {
 public:
  const char* name() const override { return "ioda"; }
  bool recognises(const NetcdfFile& file) const override {
    return file.text_attribute("_ioda_layout").has_value() || find(file, "MetaData", {"latitude"}) != nullptr;
  }
  std::size_t locations(const NetcdfFile& file) const override {
    const NetcdfVariable* latitude = find(file, "MetaData", {"latitude"});
    return latitude ? latitude->count() : 0;
  }
  Result<ReadObservations> read(const NetcdfFile& file, const InputOptions& options) const override {
    return Reader(file, options).read();
  }

  Result<NetcdfEdit> subset(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                            const OutputOptions&) const override {
    const Result<int> location = check_locations(file, retained);
    if (!location) return location.error();
    NetcdfEdit edit;
    edit.kept[*location].assign(retained.begin(), retained.end());
    edit.locations = retained.size();
    return edit;
  }

  // A group of its own, over the same locations and channels as the observed values.
  Result<NetcdfEdit> flag(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                          const OutputOptions& options) const override {
    const Result<int> location = check_locations(file, retained);
    if (!location) return location.error();
    const std::string& group = options.ioda_flag_group;
    if (!find_matrix(file, group).parts.empty())
      return Error{ErrorKind::configuration, fmt::format("{}: it has a group {} already; name another one in [output] "
                                                         "ioda_flag_group",
                                                         file.name(), group)};
    NetcdfEdit edit;
    edit.locations = locations(file);
    std::vector<bool> is_retained(edit.locations);
    for (const std::uint32_t i : retained) is_retained[i] = true;
    for (const auto& [path, variable] : file.variables()) {
      const std::optional<std::string> name = observed_name(path);
      if (!name || variable.dimensions.empty() || variable.dimensions.front() != *location) continue;
      const bool has_groups = path.find('/') != std::string::npos;
      AddedVariable& added = edit.added.emplace_back();
      added.path = has_groups ? group + "/" + *name : *name + "@" + group;
      added.like = path;
      const std::size_t width = variable.count() / edit.locations;
      for (std::size_t i = 0; i < edit.locations; ++i)
        added.values.insert(added.values.end(), width, is_retained[i] ? 0 : kIodaThinned);
      added.flag_values = {0, kIodaThinned};
      added.attributes = {{"flag_meanings", "retained thinned"}};
    }
    return edit;
  }

 private:
  // The location dimension, where all of the retained locations are in it.
  static Result<int> check_locations(const NetcdfFile& file, std::span<const std::uint32_t> retained) {
    const NetcdfVariable* latitude = find(file, "MetaData", {"latitude"});
    if (latitude && latitude->lengths.size() == 1 && (retained.empty() || retained.back() < latitude->lengths.front()))
      return latitude->dimensions.front();
    return Error{ErrorKind::input, file.name() + ": it has fewer locations than when it was read. Read it again."};
  }

  // "brightnessTemperature", where the path is that of observed temperatures in the usual group.
  static std::optional<std::string> observed_name(const std::string& path) {
    std::string name;
    if (path.starts_with("ObsValue/")) name = path.substr(9);
    if (path.ends_with("@ObsValue")) name = path.substr(0, path.size() - 9);
    const bool temperatures = name == "brightnessTemperature" || name.starts_with("brightness_temperature");
    return temperatures ? std::optional(name) : std::nullopt;
  }
};

}  // namespace

const NetcdfLayout& ioda_layout() {
  static const IodaLayout layout;
  return layout;
}

}  // namespace thin
