#pragma once

// Satellite soundings as a structure of arrays: n observations (fields of view) x k channels.
//
// Every vector over observations has size() entries; values has size() * channels.size(), row by row. NaN in values,
// first guess and variables, and there alone, means "missing". Thinning never changes an ObservationSet: it selects
// indices of it, and the references in `source` lead from each index back to the bytes that it came from.
//
// A set may hold several instruments. Then `channels` lists those of each after those of another, channel_instrument
// says whose each is, and an observation has values in the columns of its own instrument alone; the others are NaN.

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace thin {

// Earth-centred, earth-fixed, WGS84; km.
struct Vector3 {
  double x = 0, y = 0, z = 0;
  bool operator==(const Vector3&) const = default;
};

enum class Surface : std::uint8_t { unknown, sea, land, coast, ice };

enum class Instrument : std::uint8_t { unknown, amsua, amsub, mhs, hirs, atms };
const char* instrument_name(Instrument instrument);  // "AMSU-A"; "unknown instrument"

enum class ValueKind : std::uint8_t {
  brightness_temperature,  // K, as measured
  innovation,              // K, observed minus first guess
};

// Where an observation stands in its file: in BUFR the message (counted from 0 over all that the file holds) and the
// subset in it (from 0); in netCDF the location, with message 0.
struct SourceReference {
  std::uint32_t file = 0;
  std::uint32_t message = 0;
  std::uint32_t subset = 0;
  auto operator<=>(const SourceReference&) const = default;  // NOLINT(modernize-use-nullptr): mistaken by clang-tidy 14
};

constexpr std::int32_t kUnknownNumber = -1;

struct ObservationSet {
  std::vector<int> channels;                   // instrument's channel numbers, ascending: AMSU-A 1..15
  std::vector<Instrument> channel_instrument;  // of each channel; empty: all observations have all channels
  ValueKind value_kind = ValueKind::brightness_temperature;

  std::vector<double> latitude_deg;    // geodetic, -90..90
  std::vector<double> longitude_deg;   // as stored, -180..360
  std::vector<Vector3> position_km;    // on the ellipsoid
  std::vector<std::int64_t> time_ms;   // since 1970-01-01T00:00:00Z
  std::vector<std::int32_t> platform;  // WMO common code table C-5: 4 Metop-A, 223 NOAA-19, ...
  std::vector<Instrument> instrument;
  std::vector<std::int32_t> scan_line;      // as stored, or kUnknownNumber
  std::vector<std::int32_t> field_of_view;  // from 1, or kUnknownNumber
  std::vector<Surface> surface;
  std::vector<double> values;         // K
  std::vector<double> first_guess_k;  // as values: the model's equivalents, bias correction included; empty for none
  std::vector<SourceReference> source;
  // Further numbers per observation, by name: angles, quality flags, predictors, whatever the file has.
  std::map<std::string, std::vector<double>> variables;

  std::size_t size() const { return latitude_deg.size(); }
  std::size_t channel_count() const { return channels.size(); }
  std::span<const double> values_of(std::size_t observation) const {
    return std::span<const double>(values).subspan(observation * channels.size(), channels.size());
  }
  bool measures(std::size_t observation, std::size_t channel_place) const {
    return channel_instrument.empty() || channel_instrument[channel_place] == instrument[observation];
  }

  // Everything about one observation but its values, first guess and variables, for push_back.
  struct Entry {
    double latitude_deg = 0;
    double longitude_deg = 0;
    std::int64_t time_ms = 0;
    std::int32_t platform = kUnknownNumber;
    Instrument instrument = Instrument::unknown;
    std::int32_t scan_line = kUnknownNumber;
    std::int32_t field_of_view = kUnknownNumber;
    Surface surface = Surface::unknown;
    SourceReference source;
  };

  // Computes position_km. A first guess and variables that there are get NaN for it: the caller fills them in.
  // REQUIRES: entry_values.size() == channels.size(), -90 <= latitude_deg <= 90, finite longitude
  void push_back(const Entry& entry, std::span<const double> entry_values);

  // Channels of an instrument that this set has not are added; what either set lacks (channels, first guess,
  // variables) is missing for its observations. Channels come in order of instrument and number, so that the result
  // of several appends differs in the order of observations alone.
  // REQUIRES: the same value_kind, unless one of the two is empty; each set of several instruments, or all of one
  // instrument, has an `instrument` for every observation
  void append(const ObservationSet& other);

  void reserve(std::size_t count);

  // The values with 0 for what an observation's instrument does not measure.
  std::vector<double> values_or_zero() const;

  // The given observations in the given order.
  ObservationSet select(std::span<const std::uint32_t> indices) const;

  // The same observations with only the channels at these places of `channels`.
  ObservationSet select_channels(std::span<const std::size_t> places) const;
};

// The order that results are stated in, so that they do not depend on the order of arrival: by time, platform, scan
// line, field of view, then position, values, and last the source. The permutation: result[i] is the index of the
// observation that comes i-th.
std::vector<std::uint32_t> canonical_order(const ObservationSet& observations);

}  // namespace thin
