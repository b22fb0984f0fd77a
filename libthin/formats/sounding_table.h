#pragma once

// What a netCDF layout says of its soundings, still in the file's own order and with everything that may be missing:
// one step away from an ObservationSet. Every layout's reader fills one, and one function makes the observations of it.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libthin/formats/observation_file.h"

namespace thin {

// Columns have one entry per location, or are empty where the file has none; NaN is missing.
struct SoundingTable {
  std::size_t locations = 0;
  std::vector<std::uint32_t> numbers;  // of the locations in the file, where they are not 0, 1, 2, ...
  std::vector<int> channels;           // the instrument's numbers, in the file's order, each once
  Instrument instrument = Instrument::unknown;

  std::vector<double> latitude_deg, longitude_deg;
  std::vector<double> time_s;  // since 1970-01-01T00:00:00Z
  std::vector<double> platform, scan_line, field_of_view;
  std::vector<Surface> surface;
  std::vector<double> observed_k;     // locations x channels, NaN where quality control rejects
  std::vector<double> first_guess_k;  // locations x channels
  std::map<std::string, std::vector<double>> variables;
  std::vector<std::string> notes;
};

// layout: "ioda". Locations without usable position or time are left out and counted. Where there is a first guess, a
// value without one is missing: it has no innovation. A platform that the file does not tell is options.platform.
// Errors: input, where no location is left, or some column has another length.
Result<ReadObservations> observations_of(SoundingTable table, const std::string& layout, const InputOptions& options,
                                         const std::string& name);

// Adds the observations of another instrument of the same file; its notes are taken to be the same.
void join(ReadObservations&& other, ReadObservations& into);

// Instruments by the names that files use, any case: "amsua", "AMSU-A", "amsua_n19", "mhs_metop-b".
Instrument instrument_of_name(const std::string& name);

// Of the numbers of WMO's common code table C-8 (satellite instruments): 570 AMSU-A, 574 AMSU-B, 203 MHS, 605 to 607
// HIRS, 621 ATMS.
Instrument instrument_of_number(double number);

// Where a file does not name its instrument: by the channels that it has, and where these leave a choice by the
// frequency of the second (GHz, NaN for unknown): 15 are AMSU-A's, 22 ATMS's, 5 MHS's or AMSU-B's, 19 HIRS's.
Instrument instrument_of_channels(const std::vector<int>& channels, double second_frequency_ghz);

// Satellites by the names that files use: "n19", "NOAA-19", "metop-b", "npp", "aqua"; or a WMO number, "223".
std::optional<std::int32_t> platform_of_name(const std::string& name);

// "seconds since 2020-12-14T21:00:00Z": what to multiply a time with and add to have seconds since 1970. Nothing where
// it is no such text.
struct TimeUnits {
  double seconds_per_unit = 1;
  double origin_s = 0;
};
std::optional<TimeUnits> parse_time_units(const std::string& units);

// 2018041506, year to hour, in seconds since 1970; nothing where it is no such number.
std::optional<double> time_of_date_number(double date);

}  // namespace thin
