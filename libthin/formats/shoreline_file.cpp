#include "libthin/formats/shoreline_file.h"

#include <fmt/format.h>
#include <netcdf.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <optional>

namespace thin {
namespace {

constexpr std::size_t kMostValues = 1'000'000'000;
constexpr int kLandLevel = 1;  // of GSHHG: land in the ocean, and Antarctica by its ice front
constexpr double kStepsPerBin = 65535;

// A file that is read to the end or until the first failure; ask once, at the end.
class Reader {
 public:
  explicit Reader(const std::string& path) { check(nc_open(path.c_str(), NC_NOWRITE, &file_), "it"); }
  ~Reader() {
    if (file_ >= 0) nc_close(file_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  bool ok() const { return problem_.empty(); }
  const std::string& problem() const { return problem_; }
  int failure() const { return failure_; }
  void fail(const std::string& problem) {
    if (problem_.empty()) problem_ = problem;
  }

  std::optional<int> find(const std::string& name) const {
    int variable = 0;
    return ok() && nc_inq_varid(file_, name.c_str(), &variable) == NC_NOERR ? std::optional(variable) : std::nullopt;
  }
  std::string name_of(int variable) const {
    char name[NC_MAX_NAME + 1] = {};
    nc_inq_varname(file_, variable, name);
    return name;
  }
  std::string text_attribute(int variable, const char* name) const {
    std::size_t length = 0;
    nc_type type = NC_NAT;
    if (nc_inq_att(file_, variable, name, &type, &length) != NC_NOERR || type != NC_CHAR || length > 1000) return "";
    std::string text(length, '\0');
    return nc_get_att_text(file_, variable, name, text.data()) == NC_NOERR ? text.c_str() : "";
  }
  std::optional<double> number_attribute(int variable, const char* name) const {
    std::size_t length = 0;
    double number = 0;
    if (nc_inq_attlen(file_, variable, name, &length) != NC_NOERR || length != 1) return std::nullopt;
    return nc_get_att_double(file_, variable, name, &number) == NC_NOERR ? std::optional(number) : std::nullopt;
  }
  int variable_count() const {
    int count = 0;
    if (ok()) nc_inq_nvars(file_, &count);
    return count;
  }

  struct Dimension {
    std::string name;
    std::size_t length;
  };
  std::vector<Dimension> dimensions_of(int variable) {
    int rank = 0, ids[NC_MAX_VAR_DIMS];
    check(nc_inq_var(file_, variable, nullptr, nullptr, &rank, ids, nullptr), name_of(variable));
    std::vector<Dimension> dimensions;
    for (int i = 0; i < rank && ok(); ++i) {
      char name[NC_MAX_NAME + 1] = {};
      std::size_t length = 0;
      check(nc_inq_dim(file_, ids[i], name, &length), name_of(variable));
      dimensions.push_back({name, length});
    }
    return dimensions;
  }

  std::vector<double> doubles(int variable) { return get<double>(variable, nc_get_var_double); }
  std::vector<int> integers(const char* name) {
    const std::optional<int> variable = find(name);
    if (!variable) fail(fmt::format("it has no {}", name));
    return variable ? get<int>(*variable, nc_get_var_int) : std::vector<int>();
  }

 private:
  void check(int code, const std::string& what) {
    if (code == NC_NOERR || !ok()) return;
    failure_ = code;
    problem_ = what + ": " + nc_strerror(code);
  }
  template <class T, class Read>
  std::vector<T> get(int variable, Read read) {
    std::size_t count = 1;
    for (const Dimension& dimension : dimensions_of(variable)) {
      if (dimension.length == 0 || count > kMostValues / dimension.length) fail(name_of(variable) + " is too large");
      count *= dimension.length;
    }
    std::vector<T> values(ok() ? count : 0);
    if (ok()) check(read(file_, variable, values.data()), name_of(variable));
    return values;
  }

  int file_ = -1;
  int failure_ = 0;
  std::string problem_;
};

// ---- GSHHG, cut into bins of some degrees, counted from the north-west; points relative to their bin's south-west
// corner

struct Bins {
  std::size_t columns = 0, rows = 0;
  double degrees = 0;
  std::vector<int> first_segment, segment_count;
};

struct Segments {
  std::vector<int> packed;  // number of points << 9 | level << 6 | sides
  std::vector<int> first_point;
  std::vector<int> x, y;  // 16 bits without sign
};

int only(const std::vector<int>& values) {
  return values.empty() ? 0 : values.front();
}

void add_segment(const Segments& segments, std::size_t segment, double west, double south, double degrees, Reader& file,
                 std::vector<ShoreEdge>& edges) {
  const int packed = segments.packed[segment];
  if (((packed >> 6) & 7) != kLandLevel) return;
  const auto first = static_cast<std::size_t>(segments.first_point[segment]);
  const auto count = static_cast<std::size_t>(packed >> 9);
  if (segments.first_point[segment] < 0 || packed < 0 || first + count > segments.x.size())
    return file.fail("a segment's points lie outside of it");
  const auto degree = [&](int step) { return static_cast<double>(step & 0xffff) * degrees / kStepsPerBin; };
  for (std::size_t p = first; p + 1 < first + count; ++p)
    edges.push_back({south + degree(segments.y[p]), west + degree(segments.x[p]), south + degree(segments.y[p + 1]),
                     west + degree(segments.x[p + 1])});
}

std::vector<ShoreEdge> read_gshhg(Reader& file) {
  Bins bins;
  bins.degrees = only(file.integers("Bin_size_in_minutes")) / 60.0;
  bins.columns = static_cast<std::size_t>(std::max(0, only(file.integers("N_bins_in_360_longitude_range"))));
  bins.rows = static_cast<std::size_t>(std::max(0, only(file.integers("N_bins_in_180_degree_latitude_range"))));
  bins.first_segment = file.integers("Id_of_first_segment_in_a_bin");
  bins.segment_count = file.integers("N_segments_in_a_bin");
  Segments segments;
  segments.packed = file.integers("Embedded_npts_levels_exit_entry_for_a_segment");
  segments.first_point = file.integers("Id_of_first_point_in_a_segment");
  segments.x = file.integers("Relative_longitude_from_SW_corner_of_bin");
  segments.y = file.integers("Relative_latitude_from_SW_corner_of_bin");
  const bool fits = bins.degrees > 0 && bins.degrees * static_cast<double>(bins.columns) == 360 &&
                    bins.degrees * static_cast<double>(bins.rows) == 180 &&
                    bins.first_segment.size() == bins.columns * bins.rows &&
                    bins.segment_count.size() == bins.first_segment.size() &&
                    segments.first_point.size() == segments.packed.size() && segments.x.size() == segments.y.size();
  if (!fits) file.fail("its bins, segments and points do not fit together");

  std::vector<ShoreEdge> edges;
  for (std::size_t bin = 0; bin < bins.first_segment.size() && file.ok(); ++bin) {
    const double west = static_cast<double>(bin % bins.columns) * bins.degrees;
    const double south = 90 - static_cast<double>(bin / bins.columns + 1) * bins.degrees;
    const int first = bins.first_segment[bin], count = bins.segment_count[bin];
    if (first < 0 || count < 0 ||
        static_cast<std::size_t>(first) + static_cast<std::size_t>(count) > segments.packed.size()) {
      file.fail("a bin's segments lie outside of it");
      break;
    }
    for (int segment = first; segment < first + count; ++segment)
      add_segment(segments, static_cast<std::size_t>(segment), west, south, bins.degrees, file, edges);
  }
  return edges;
}

// ---- a mask on a grid: edges run between cells of which one is land and the other sea

struct Mask {
  std::vector<double> latitudes, longitudes;  // of the cells' centres; latitudes from north to south
  std::vector<double> land;                   // latitude by longitude

  bool is_land(std::size_t row, std::size_t column) const { return land[row * longitudes.size() + column] >= 0.5; }
};

std::optional<int> find_mask(const Reader& file) {
  for (int variable = 0; variable < file.variable_count(); ++variable) {
    const std::string standard_name = file.text_attribute(variable, "standard_name");
    if (standard_name == "land_binary_mask" || standard_name == "land_area_fraction") return variable;
  }
  for (const char* name : {"land_sea_mask", "lsm", "land_fraction"})
    if (const std::optional<int> variable = file.find(name)) return variable;
  return std::nullopt;
}

std::vector<double> coordinate(Reader& file, const Reader::Dimension& dimension) {
  const std::optional<int> variable = file.find(dimension.name);
  if (!variable || dimension.length < 2) {
    file.fail(fmt::format("its dimension {} has no coordinate variable, or is shorter than 2", dimension.name));
    return {};
  }
  std::vector<double> values = file.doubles(*variable);
  const double step = values.size() > 1 ? values[1] - values[0] : 0;
  bool even = values.size() == dimension.length && step != 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    even = even && std::abs(values[i] - values[i - 1] - step) < 0.01 * std::abs(step);
  if (!even) file.fail(fmt::format("its coordinate {} is not evenly spaced", dimension.name));
  return values;
}

// Packed values (scale_factor, add_offset) in their own unit, missing ones as sea.
void unpack(const Reader& file, int variable, std::vector<double>& values) {
  const double scale = file.number_attribute(variable, "scale_factor").value_or(1);
  const double offset = file.number_attribute(variable, "add_offset").value_or(0);
  const std::optional<double> fill = file.number_attribute(variable, "_FillValue");
  for (double& value : values) value = fill && value == *fill ? 0 : value * scale + offset;
}

void turn_north_up(Mask& mask) {
  if (mask.latitudes.front() > mask.latitudes.back()) return;
  std::reverse(mask.latitudes.begin(), mask.latitudes.end());
  const auto width = static_cast<std::ptrdiff_t>(mask.longitudes.size());
  std::vector<double> turned;
  turned.reserve(mask.land.size());
  for (auto row = mask.land.end(); row != mask.land.begin(); row -= width)
    turned.insert(turned.end(), row - width, row);
  mask.land = std::move(turned);
}

Mask read_mask(Reader& file, int variable) {
  Mask mask;
  const std::vector<Reader::Dimension> dimensions = file.dimensions_of(variable);
  const std::size_t rank = dimensions.size();
  for (std::size_t i = 0; i + 2 < rank; ++i)
    if (dimensions[i].length != 1) file.fail("its mask has more than the dimensions latitude and longitude");
  if (rank < 2) file.fail("its mask has no dimensions latitude and longitude");
  if (!file.ok()) return mask;
  mask.latitudes = coordinate(file, dimensions[rank - 2]);
  mask.longitudes = coordinate(file, dimensions[rank - 1]);
  mask.land = file.doubles(variable);
  if (!file.ok()) return mask;
  unpack(file, variable, mask.land);
  turn_north_up(mask);
  const double latitude_step = mask.latitudes[0] - mask.latitudes[1];
  const double width = std::abs(mask.longitudes[1] - mask.longitudes[0]) * static_cast<double>(mask.longitudes.size());
  const bool whole = std::abs(width - 360) < 0.5 * width / static_cast<double>(mask.longitudes.size()) &&
                     mask.latitudes.front() + latitude_step > 89.999 && mask.latitudes.back() - latitude_step < -89.999;
  const bool on_earth = mask.latitudes.front() <= 90.001 && mask.latitudes.back() >= -90.001;
  if (!whole || !on_earth) file.fail("its mask does not cover the globe");
  return mask;
}

std::vector<ShoreEdge> edges_of(const Mask& mask) {
  const std::size_t rows = mask.latitudes.size(), columns = mask.longitudes.size();
  const double longitude_step = mask.longitudes[1] - mask.longitudes[0];
  const auto west_of = [&](std::size_t column) {
    return mask.longitudes[0] + (static_cast<double>(column) - 0.5) * longitude_step;
  };
  // Cells reach halfway to their neighbours; those of the first and last row to the pole.
  const auto north_of = [&](std::size_t row) {
    return row == 0 ? 90.0 : row == rows ? -90.0 : 0.5 * (mask.latitudes[row - 1] + mask.latitudes[row]);
  };
  std::vector<ShoreEdge> edges;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const bool land = mask.is_land(row, column);
      const double west = west_of(column), east = west_of(column + 1);
      // Beyond the pole, where the map ends.
      if (row == 0 && land) edges.push_back({91, west, 91, east, false});
      if (row > 0 && land != mask.is_land(row - 1, column)) edges.push_back({north_of(row), west, north_of(row), east});
      if (land != mask.is_land(row, (column + columns - 1) % columns))
        edges.push_back({north_of(row), west, north_of(row + 1), west});
    }
  return edges;
}

Error cannot_use(const std::string& path, const Reader& file) {
  // netCDF passes the system's error numbers on where they are positive.
  if (file.failure() == ENOENT)
    return {ErrorKind::configuration,
            fmt::format("there is no land/sea mask {}: install Debian's package gmt-gshhg-low, or name a file in "
                        "[preparation] land_sea_mask",
                        path)};
  if (file.failure() > 0) return system_error("open the land/sea mask", path, file.failure());
  return {ErrorKind::configuration,
          fmt::format("{} can't be used as a land/sea mask: {}. Name GSHHG's shorelines (Debian's gmt-gshhg-low) or a "
                      "netCDF mask as docs/operations.md describes it in [preparation] land_sea_mask",
                      path, file.problem())};
}

}  // namespace

Result<std::vector<ShoreEdge>> read_shoreline(const std::string& path) {
  Reader file(path);
  std::vector<ShoreEdge> edges;
  if (file.find("Embedded_npts_levels_exit_entry_for_a_segment")) {
    edges = read_gshhg(file);
  } else if (const std::optional<int> variable = find_mask(file)) {
    const Mask mask = read_mask(file, *variable);
    if (file.ok()) edges = edges_of(mask);
  } else {
    file.fail("it holds neither GSHHG's segments nor a variable that is a land mask");
  }
  if (!file.ok()) return cannot_use(path, file);
  return edges;
}

}  // namespace thin
