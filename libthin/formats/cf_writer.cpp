#include "libthin/formats/cf_writer.h"

#include <fmt/format.h>
#include <netcdf.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <limits>
#include <vector>

#include "libthin/formats/atomic_file.h"
#include "libthin/foundation/file_bytes.h"

namespace thin {
namespace {

using Attributes = std::vector<std::pair<const char*, std::string>>;

// What CF calls the variables that every format shares.
Attributes facts_of(const std::string& name) {
  if (name == "satellite_zenith_angle_deg") return {{"standard_name", "sensor_zenith_angle"}, {"units", "degree"}};
  if (name == "solar_zenith_angle_deg") return {{"standard_name", "solar_zenith_angle"}, {"units", "degree"}};
  if (name == "satellite_azimuth_deg") return {{"standard_name", "sensor_azimuth_angle"}, {"units", "degree"}};
  if (name == "scan_angle_deg") return {{"standard_name", "sensor_view_angle"}, {"units", "degree"}};
  if (name == "surface_height_m") return {{"standard_name", "surface_altitude"}, {"units", "m"}};
  if (name == "land_fraction") return {{"standard_name", "land_area_fraction"}, {"units", "1"}};
  return {};
}

// Keeps the first failure; after it nothing is done any more.
class Writer {
 public:
  explicit Writer(const std::string& path) {
    check(nc_create(path.c_str(), NC_NETCDF4 | NC_CLOBBER, &file_));
    if (failure_ != NC_NOERR) file_ = -1;
  }
  ~Writer() {
    if (file_ >= 0) nc_abort(file_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void global(const char* name, const std::string& text) { put_text(NC_GLOBAL, name, text); }

  int dimension(const char* name, std::size_t length) {
    int id = -1;
    if (good()) check(nc_def_dim(file_, name, length, &id));
    return id;
  }

  int define(const std::string& name, int type, const std::vector<int>& dimensions, const Attributes& attributes) {
    int id = 0;
    if (good())
      check(nc_def_var(file_, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(), &id));
    if (good()) check(nc_def_var_deflate(file_, id, 1, 1, 4));
    const float missing = std::numeric_limits<float>::quiet_NaN();
    if (good() && type == NC_FLOAT) check(nc_put_att_float(file_, id, "_FillValue", NC_FLOAT, 1, &missing));
    for (const auto& [attribute, text] : attributes) put_text(id, attribute, text);
    return id;
  }

  void put(int id, const std::vector<double>& values) {
    if (good()) check(nc_put_var_double(file_, id, values.data()));
  }
  void put(int id, const std::vector<int>& values) {
    if (good()) check(nc_put_var_int(file_, id, values.data()));
  }
  void fill_value(int id, int value) {
    if (good()) check(nc_put_att_int(file_, id, "_FillValue", NC_INT, 1, &value));
  }
  void flag_values(int id, const std::vector<int>& values) {
    if (good()) check(nc_put_att_int(file_, id, "flag_values", NC_INT, values.size(), values.data()));
  }

  int close() {
    if (good()) check(nc_close(file_));
    if (good()) file_ = -1;
    return failure_;
  }

 private:
  bool good() const { return failure_ == NC_NOERR; }
  void check(int code) {
    if (good()) failure_ = code;
  }
  void put_text(int id, const char* name, const std::string& text) {
    if (good()) check(nc_put_att_text(file_, id, name, text.size(), text.data()));
  }

  int file_ = -1;
  int failure_ = NC_NOERR;
};

template <class T>
std::vector<int> numbers_of(const std::vector<T>& values) {
  std::vector<int> numbers;
  for (const T value : values) numbers.push_back(static_cast<int>(value));
  return numbers;
}

void write_all(Writer& file, const ObservationSet& set) {
  const std::vector<int> obs = {file.dimension("obs", set.size())};
  const std::vector<int> channel = {file.dimension("channel", set.channels.size())};
  const std::vector<int> both = {obs.front(), channel.front()};
  file.global("Conventions", "CF-1.8");
  file.global("featureType", "point");
  file.global("instrument", instrument_name(set.instrument.front()));

  const std::string coordinates = "time lat lon";
  file.put(file.define("channel", NC_INT, channel, {{"long_name", "channel number of the instrument"}}), set.channels);
  std::vector<double> time_s;
  for (const std::int64_t time_ms : set.time_ms) time_s.push_back(static_cast<double>(time_ms) / 1000);
  file.put(file.define(
               "time", NC_DOUBLE, obs,
               {{"standard_name", "time"}, {"units", "seconds since 1970-01-01 00:00:00"}, {"calendar", "standard"}}),
           time_s);
  file.put(file.define("lat", NC_DOUBLE, obs, {{"standard_name", "latitude"}, {"units", "degrees_north"}}),
           set.latitude_deg);
  file.put(file.define("lon", NC_DOUBLE, obs, {{"standard_name", "longitude"}, {"units", "degrees_east"}}),
           set.longitude_deg);
  const auto identity = [&](const char* name, const char* meaning, const std::vector<int>& values) {
    const int id = file.define(name, NC_INT, obs, {{"long_name", meaning}, {"coordinates", coordinates}});
    file.fill_value(id, kUnknownNumber);
    file.put(id, values);
  };
  identity("satellite_identifier", "WMO common code table C-5", numbers_of(set.platform));
  identity("scan_line", "number of the scan line", numbers_of(set.scan_line));
  identity("field_of_view", "number of the field of view in its scan line, from 1", numbers_of(set.field_of_view));
  const int surface = file.define("surface_type", NC_INT, obs,
                                  {{"flag_meanings", "unknown sea land coast ice"}, {"coordinates", coordinates}});
  file.flag_values(surface, {0, 1, 2, 3, 4});
  file.put(surface, numbers_of(set.surface));
  file.put(file.define("brightness_temperature", NC_FLOAT, both,
                       {{"standard_name", "toa_brightness_temperature"}, {"units", "K"}, {"coordinates", coordinates}}),
           set.values);
  if (!set.first_guess_k.empty())
    file.put(file.define("first_guess_brightness_temperature", NC_FLOAT, both,
                         {{"long_name", "the model's equivalent, corrected for the bias of the observed values"},
                          {"units", "K"},
                          {"coordinates", coordinates}}),
             set.first_guess_k);
  for (const auto& [name, column] : set.variables) {
    std::string own = name;
    std::replace(own.begin(), own.end(), '/', '_');
    Attributes facts = facts_of(name);
    facts.emplace_back("coordinates", coordinates);
    file.put(file.define(own, NC_FLOAT, obs, facts), column);
  }
}

}  // namespace

Result<std::uint64_t> write_cf_file(const std::string& path, const ObservationSet& observations) {
  assert(observations.size() > 0);
  const std::filesystem::path whole(path);
  const std::string temporary = (whole.parent_path() / ("." + whole.filename().string() + ".tmp")).string();
  // What keeps a file from being made has an errno here, and none in netCDF.
  if (Result<void> writable = write_file_bytes(temporary, {}); !writable) return writable.error();
  int failure = NC_NOERR;
  {
    Writer file(temporary);
    write_all(file, observations);
    failure = file.close();
  }
  if (failure != NC_NOERR) {
    ::unlink(temporary.c_str());
    return Error{ErrorKind::temporary,
                 fmt::format("cannot write {}: netCDF says \"{}\"; is the disk full?", path, nc_strerror(failure))};
  }
  if (Result<void> published = publish_file(temporary, path); !published) return published.error();
  std::error_code ignored;
  return static_cast<std::uint64_t>(std::filesystem::file_size(path, ignored));
}

}  // namespace thin
