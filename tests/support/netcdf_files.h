#pragma once

// Small files in the layouts of netCDF that are read, each by a writer of its own that shares nothing with the code
// under test (tests/support/cdl.h). Every value is a formula of its place, so that tests can say what must come out.
//
// IODA's groups are as the converters of JEDI write them, checked against real files; GSI diagnostics after GSI's
// setuprad, feedback files after the table of variables in DWD's feedback file definition: of these two no real sample
// was to be had.

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/cdl.h"

namespace thin::test {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

// A value per location, and one per location and channel (from 0).
template <class Formula>
std::vector<double> each_location(std::size_t locations, const Formula& formula) {
  std::vector<double> values;
  for (std::size_t i = 0; i < locations; ++i) values.push_back(formula(i));
  return values;
}
template <class Formula>
std::vector<double> each_value(std::size_t locations, std::size_t channels, const Formula& formula) {
  std::vector<double> values;
  for (std::size_t i = 0; i < locations; ++i)
    for (std::size_t c = 0; c < channels; ++c) values.push_back(formula(i, c));
  return values;
}

// What the soundings of all layouts hold: multiples of 1/8 survive as float what is done with them.
inline double latitude_of(std::size_t i) {
  return -60 + 0.125 * static_cast<double>(i);
}
inline double longitude_of(std::size_t i) {
  return std::fmod(10 + 2.5 * static_cast<double>(i), 360);
}
inline double observed_of(std::size_t i, std::size_t c) {
  return 200 + 5.0 * static_cast<double>(c) + 0.125 * static_cast<double>(i % 40);
}
inline double innovation_of(std::size_t i, std::size_t c) {
  return 0.125 * (static_cast<double>((7 * i + 3 * c) % 17) - 8);
}
inline bool is_rejected(std::size_t i, std::size_t c) {
  return (i + c) % 11 == 10;
}
constexpr double kFirstTimeS = 1639256400;  // 2021-12-11T21:00:00Z

struct IodaShape {
  std::size_t locations = 40, channels = 15;
  bool unlimited = true;
  bool first_guess = true;
  bool temperatures = true;
};

// As JEDI's converters write today.
inline std::string write_ioda(const std::string& path, const IodaShape& shape = {}) {
  const std::size_t n = shape.locations, k = shape.channels;
  const std::string count = std::to_string(n), width = std::to_string(k);
  const std::vector<std::string> kelvin = {"_FillValue = 9.96921e+36f", "string units = \"K\"", "_DeflateLevel = 6",
                                           "_ChunkSizes = " + count + ", " + width};
  const auto column = [&](const std::string& fill) {
    return std::vector<std::string>{"_FillValue = " + fill, "_DeflateLevel = 6", "_ChunkSizes = " + count};
  };
  Cdl cdl;
  cdl.dimension("Channel", k);
  if (shape.unlimited)
    cdl.unlimited_dimension("Location");
  else
    cdl.dimension("Location", n);
  cdl.variable("int Channel(Channel)", {}, each_location(k, [](std::size_t c) { return static_cast<double>(c + 1); }));
  cdl.variable("int64 Location(Location)", {"_ChunkSizes = " + count},
               each_location(n, [](std::size_t) { return 0.0; }));
  cdl.global("_ioda_layout = \"ObsGroup\"");
  cdl.global("_ioda_layout_version = 0");
  cdl.global("satellite = \"n19\"");
  cdl.begin_group("MetaData");
  cdl.variable("float latitude(Location)", column("9.96921e+36f"), each_location(n, latitude_of));
  cdl.variable("float longitude(Location)", column("9.96921e+36f"), each_location(n, longitude_of));
  std::vector<std::string> time = column("-9223372036854775806LL");
  time.emplace_back("string units = \"seconds since 1970-01-01T00:00:00Z\"");
  cdl.variable("int64 dateTime(Location)", time,
               each_location(n, [](std::size_t i) { return kFirstTimeS + static_cast<double>(i); }));
  cdl.variable("int sensorScanPosition(Location)", column("-2147483647"),
               each_location(n, [](std::size_t i) { return static_cast<double>(1 + i % 30); }));
  cdl.variable("float sensorZenithAngle(Location)", column("9.96921e+36f"),
               each_location(n, [](std::size_t i) { return i == 3 ? kNoValue : 0.25 * static_cast<double>(i); }));
  cdl.variable("int landOrSeaQualifier(Location)", column("-2147483647"),
               each_location(n, [](std::size_t i) { return static_cast<double>(i % 3); }));
  cdl.variable("float sensorChannelNumber(Channel)", {},
               each_location(k, [](std::size_t c) { return static_cast<double>(c + 1); }));
  cdl.texts("string variable_names(Channel)", {}, std::vector<std::string>(k, "brightness_temperature"));
  std::vector<std::string> stations;
  for (std::size_t i = 0; i < n; ++i) stations.push_back("location " + std::to_string(i));
  cdl.texts("string stationIdentification(Location)", {"_ChunkSizes = " + count}, stations);
  cdl.end_group();
  const auto matrix = [&](const std::string& group, const std::string& declaration,
                          const std::vector<std::string>& facts, const std::vector<double>& values) {
    cdl.begin_group(group);
    cdl.variable(declaration, facts, values);
    cdl.end_group();
  };
  const std::string temperature = "float brightnessTemperature(Location, Channel)";
  if (shape.temperatures) matrix("ObsValue", temperature, kelvin, each_value(n, k, observed_of));
  matrix("PreQC", "int brightnessTemperature(Location, Channel)", {"_FillValue = -2147483647", "_Shuffle = \"true\""},
         each_value(n, k, [](std::size_t i, std::size_t c) { return is_rejected(i, c) ? 50.0 : 0.0; }));
  if (shape.first_guess)
    matrix("hofx", temperature, kelvin,
           each_value(n, k, [](std::size_t i, std::size_t c) { return observed_of(i, c) - innovation_of(i, c); }));
  return cdl.write(path);
}

// The form before groups. per_channel: one variable for each channel, as the first version had it.
inline std::string write_old_ioda(const std::string& path, bool per_channel, std::size_t n = 40, std::size_t k = 15) {
  Cdl cdl;
  cdl.dimension("nlocs", n);
  cdl.dimension("nchans", k);
  cdl.dimension("nstring", 20);
  cdl.global("date_time = 2021121200");
  cdl.global("satellite = \"n19\"");
  cdl.variable("float latitude@MetaData(nlocs)", {}, each_location(n, latitude_of));
  cdl.variable("float longitude@MetaData(nlocs)", {}, each_location(n, longitude_of));
  if (per_channel) {
    std::vector<std::string> times;
    for (std::size_t i = 0; i < n; ++i) {
      std::string second = std::to_string(i % 60);
      times.push_back("2021-12-11T21:00:" + std::string(second.size() == 1 ? "0" : "") + second + "Z");
    }
    cdl.texts("char datetime@MetaData(nlocs, nstring)", {}, times);
  } else {
    cdl.variable("double time@MetaData(nlocs)", {},
                 each_location(n, [](std::size_t i) { return -3 + static_cast<double>(i) / 3600; }));
  }
  cdl.variable("float scan_position@MetaData(nlocs)", {},
               each_location(n, [](std::size_t i) { return static_cast<double>(1 + i % 30); }));
  cdl.variable("int sensor_channel@VarMetaData(nchans)", {},
               each_location(k, [](std::size_t c) { return static_cast<double>(c + 1); }));
  const auto matrix = [&](const std::string& group, const std::string& type, auto formula) {
    if (!per_channel)
      return cdl.variable(type + " brightness_temperature@" + group + "(nlocs, nchans)", {}, each_value(n, k, formula));
    for (std::size_t c = 0; c < k; ++c)
      cdl.variable(type + " brightness_temperature_" + std::to_string(c + 1) + "@" + group + "(nlocs)", {},
                   each_location(n, [&](std::size_t i) { return formula(i, c); }));
  };
  matrix("ObsValue", "float", observed_of);
  matrix("PreQC", "int", [](std::size_t i, std::size_t c) { return is_rejected(i, c) ? 50.0 : 0.0; });
  matrix("HofX", "float", [](std::size_t i, std::size_t c) { return observed_of(i, c) - innovation_of(i, c); });
  return cdl.write(path, per_channel ? "nc3" : "nc4");
}

// diag_amsua_n19_ges.2021121200.nc4: entries count the channels of one location after the other.
inline std::string write_gsi(const std::string& path, std::size_t n = 40, std::size_t k = 15) {
  const std::size_t entries = n * k;
  Cdl cdl;
  cdl.dimension("nchans", k);
  cdl.dimension("nobs", entries);
  cdl.dimension("Observation_Class_maxstrlen", 7);
  cdl.dimension("BC_angord_arr_dim", 5);
  for (const char* attribute : {"Satellite_Sensor = \"amsua_n19           \"", "Satellite = \"n19       \"",
                                "Observation_type = \"amsua     \"", "Outer_Loop_Iteration = 1",
                                "Number_of_Predictors = 12", "date_time = 2021121200", "iversion_radiag = 40000"})
    cdl.global(attribute);
  cdl.global("Number_of_channels = " + std::to_string(k));
  const auto number = [](std::size_t c) { return static_cast<double>(c + 1); };
  cdl.variable("int chaninfoidx(nchans)", {}, each_location(k, number));
  cdl.variable("double frequency(nchans)", {},
               each_location(k, [](std::size_t c) { return 23.8 + 2.0 * static_cast<double>(c); }));
  cdl.variable("int sensor_chan(nchans)", {}, each_location(k, number));
  cdl.variable("int use_flag(nchans)", {}, each_location(k, [](std::size_t c) { return c == 6 ? -1.0 : 1.0; }));
  cdl.variable("double error_variance(nchans)", {},
               each_location(k, [](std::size_t c) { return 0.25 * static_cast<double>(c + 1); }));
  // One value a location, and one an entry.
  const auto of_location = [&](const std::string& declaration, auto formula) {
    cdl.variable(declaration + "(nobs)", {"_DeflateLevel = 2"},
                 each_value(n, k, [&](std::size_t i, std::size_t) { return formula(i); }));
  };
  const auto of_entry = [&](const std::string& declaration, auto formula) {
    cdl.variable(declaration + "(nobs)", {"_DeflateLevel = 2"}, each_value(n, k, formula));
  };
  of_entry("int Channel_Index", [](std::size_t, std::size_t c) { return static_cast<double>(c + 1); });
  cdl.texts("char Observation_Class(nobs, Observation_Class_maxstrlen)", {},
            std::vector<std::string>(entries, "    rad"));
  of_location("float Latitude", latitude_of);
  of_location("float Longitude", longitude_of);
  of_location("float Elevation", [](std::size_t i) { return 10.0 * static_cast<double>(i); });
  of_location("float Obs_Time", [](std::size_t i) { return -3 + 0.125 * static_cast<double>(i % 48); });
  of_location("float Scan_Position", [](std::size_t i) { return static_cast<double>(1 + i % 30); });
  of_location("float Sat_Zenith_Angle", [](std::size_t i) { return 0.25 * static_cast<double>(i); });
  of_location("float Sat_Azimuth_Angle", [](std::size_t i) { return static_cast<double>(i); });
  of_location("float Sol_Zenith_Angle", [](std::size_t i) { return 90.0 - static_cast<double>(i); });
  of_location("float Water_Fraction", [](std::size_t i) { return i % 3 == 0 ? 1.0 : i % 3 == 1 ? 0.5 : 0.0; });
  of_location("float Land_Fraction", [](std::size_t i) { return i % 3 == 0 ? 0.0 : i % 3 == 1 ? 0.5 : 1.0; });
  of_location("float Ice_Fraction", [](std::size_t) { return 0.0; });
  of_location("float Snow_Fraction", [](std::size_t) { return 0.0; });
  of_entry("float Observation", observed_of);
  of_entry("float Obs_Minus_Forecast_adjusted", innovation_of);
  of_entry("float Obs_Minus_Forecast_unadjusted",
           [](std::size_t i, std::size_t c) { return innovation_of(i, c) + 1.5; });
  of_entry("float Inverse_Observation_Error",
           [](std::size_t i, std::size_t c) { return is_rejected(i, c) ? 0.0 : 2.0; });
  of_entry("float QC_Flag", [](std::size_t i, std::size_t c) { return is_rejected(i, c) ? 3.0 : 0.0; });
  std::vector<double> angles;
  for (std::size_t i = 0; i < 5 * entries; ++i) angles.push_back(0.5 * static_cast<double>(i % 64));
  cdl.variable("float BC_angord(nobs, BC_angord_arr_dim)", {"_DeflateLevel = 2"}, angles);
  return cdl.write(path);
}

struct FeedbackShape {
  std::size_t reports = 40, channels = 15;
  std::size_t unused_headers = 3, unused_bodies = 20;  // of the dimensions, beyond n_hdr and n_body
  bool mixed = true;           // every fifth report is of MHS with 5 channels, every seventh a TEMP with 2 levels
  bool reversed_body = false;  // reports' parts of the body in reverse order
  std::string kind = "64-bit offset";
};

enum class ReportKind { amsua, mhs, temp };
inline ReportKind report_kind(const FeedbackShape& shape, std::size_t i) {
  if (!shape.mixed) return ReportKind::amsua;
  return i % 7 == 6 ? ReportKind::temp : i % 5 == 4 ? ReportKind::mhs : ReportKind::amsua;
}

// fofRAD: the header, the body with bias-corrected values, and two verification runs, of which the second is the first
// guess.
inline std::string write_feedback(const std::string& path, const FeedbackShape& shape = {}) {
  const std::size_t n = shape.reports, headers = n + shape.unused_headers;
  struct Entry {
    double varno = 119, obs = 0, bcor = 0, level = 0, state = 1, flags = 0, check = 32, analysis = 0, guess = 0;
  };
  std::vector<double> first(headers, 0), length(headers, 0);
  std::vector<Entry> body;
  for (std::size_t step = 0; step < n; ++step) {
    const std::size_t i = shape.reversed_body ? n - 1 - step : step;
    const ReportKind kind = report_kind(shape, i);
    const std::size_t count = kind == ReportKind::temp ? 2 : kind == ReportKind::mhs ? 5 : shape.channels;
    first[i] = static_cast<double>(body.size() + 1);
    length[i] = static_cast<double>(count);
    for (std::size_t c = 0; c < count; ++c) {
      Entry entry;
      entry.varno = kind == ReportKind::temp ? 2 : 119;
      entry.level = kind == ReportKind::temp ? 50000 : static_cast<double>(c + 1);
      entry.bcor = 0.5;
      entry.obs = observed_of(i, c) + entry.bcor;
      entry.guess = entry.obs - innovation_of(i, c);
      entry.analysis = entry.obs - 0.5 * innovation_of(i, c);
      if (is_rejected(i, c)) entry.state = 7, entry.flags = 1 << 16, entry.check = 16;
      if (c == 2 && entry.state == 1) entry.state = 5;
      body.push_back(entry);
    }
  }
  const std::size_t bodies = body.size();
  body.resize(bodies + shape.unused_bodies, Entry{0, 0, 0, 0, 0, 0, 0, 0, 0});

  Cdl cdl;
  cdl.dimension("d_hdr", headers);
  cdl.dimension("d_body", body.size());
  cdl.unlimited_dimension("d_veri");
  cdl.dimension("char10", 10);
  for (const std::string& attribute :
       {std::string("title = \"ICON       Verification Data\""), std::string("file_version_number = \" 1.02\""),
        "n_hdr = " + std::to_string(n), "n_body = " + std::to_string(bodies), std::string("n_radar = 0"),
        std::string("verification_ref_date = 20211212"), std::string("verification_ref_time = 30"),
        std::string("resolution = 0.5f, 0.5f")})
    cdl.global(attribute);
  const auto header = [&](const std::string& declaration, auto formula) {
    cdl.variable(declaration + "(d_hdr)", {"longname = \"a header\""},
                 each_location(headers, [&](std::size_t i) { return i < n ? static_cast<double>(formula(i)) : 0.0; }));
  };
  cdl.variable("int i_body(d_hdr)", {"longname = \"index of 1st entry in report body\""}, first);
  cdl.variable("short l_body(d_hdr)", {"longname = \"number of entries in report body\""}, length);
  header("byte obstype", [&](std::size_t i) { return report_kind(shape, i) == ReportKind::temp ? 5 : 10; });
  header("short codetype", [](std::size_t) { return 210; });
  header("int ident", [](std::size_t) { return 223; });
  std::vector<std::string> stations;
  for (std::size_t i = 0; i < headers; ++i) stations.push_back("N19-" + std::to_string(i));
  cdl.texts("char statid(d_hdr, char10)", {}, stations);
  header("float lat", latitude_of);
  header("float lon", longitude_of);
  header("short time", [](std::size_t i) { return -90 + static_cast<double>(i); });
  header("byte r_state", [](std::size_t) { return 1; });
  header("int r_flags", [](std::size_t) { return 0; });
  header("byte r_check", [](std::size_t) { return 32; });
  header("byte mdlsfc", [](std::size_t i) { return i % 3 == 0 ? 2 : i % 3 == 1 ? 1 : 3; });
  header("short instype", [&](std::size_t i) { return report_kind(shape, i) == ReportKind::mhs ? 15 : 3; });
  header("float sat_zenit", [](std::size_t i) { return 0.25 * static_cast<double>(i); });
  header("short scanline", [](std::size_t i) { return 1 + static_cast<double>(i / 30); });
  header("short fov", [](std::size_t i) { return 1 + static_cast<double>(i % 30); });
  const auto column = [&](const std::string& declaration, double Entry::*field) {
    std::vector<double> values;
    for (const Entry& entry : body) values.push_back(entry.*field);
    cdl.variable(declaration + "(d_body)", {"longname = \"a body\""}, values);
  };
  column("short varno", &Entry::varno);
  column("float obs", &Entry::obs);
  column("float bcor", &Entry::bcor);
  column("float level", &Entry::level);
  column("byte state", &Entry::state);
  column("int flags", &Entry::flags);
  column("byte check", &Entry::check);
  std::vector<double> runs;
  for (const Entry& entry : body) runs.push_back(entry.analysis);
  for (const Entry& entry : body) runs.push_back(entry.guess);
  cdl.variable("float veri_data(d_veri, d_body)", {}, runs);
  cdl.texts("char veri_model(d_veri, char10)", {}, {"ICON      ", "ICON      "});
  cdl.variable("byte veri_run_type(d_veri)", {}, {3, 1});
  cdl.variable("int veri_ens_member(d_veri)", {}, {-1, -1});
  return cdl.write(path, shape.kind);
}

// Somebody else's CF file: other names than ours, known by the standard names.
inline std::string write_foreign_cf(const std::string& path, std::size_t n = 40, std::size_t k = 5) {
  Cdl cdl;
  cdl.dimension("record", n);
  cdl.dimension("band", k);
  cdl.global("Conventions = \"CF-1.8\"");
  cdl.global("featureType = \"point\"");
  cdl.global("instrument = \"MHS\"");
  cdl.global("platform = \"Metop-B\"");
  cdl.variable("float y(record)", {"standard_name = \"latitude\"", "units = \"degrees_north\""},
               each_location(n, latitude_of));
  cdl.variable("float x(record)", {"standard_name = \"longitude\"", "units = \"degrees_east\""},
               each_location(n, longitude_of));
  cdl.variable("double when(record)", {"standard_name = \"time\"", "units = \"hours since 2021-12-11 21:00:00\""},
               each_location(n, [](std::size_t i) { return static_cast<double>(i) / 3600; }));
  cdl.variable("int band(band)", {}, each_location(k, [](std::size_t c) { return static_cast<double>(c + 1); }));
  cdl.variable("short tb(record, band)",
               {"standard_name = \"toa_brightness_temperature\"", "units = \"K\"", "scale_factor = 0.125",
                "add_offset = 200.", "_FillValue = -1s"},
               each_value(n, k, [](std::size_t i, std::size_t c) {
                 return is_rejected(i, c) ? kNoValue : (observed_of(i, c) - 200) / 0.125;
               }));
  cdl.variable("float zenith(record)", {"standard_name = \"platform_zenith_angle\""},
               each_location(n, [](std::size_t i) { return 0.25 * static_cast<double>(i); }));
  return cdl.write(path);
}

}  // namespace thin::test
