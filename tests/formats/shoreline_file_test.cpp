#include "libthin/formats/shoreline_file.h"

#include <gtest/gtest.h>
#include <netcdf.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "libthin/observations/geodesy.h"
#include "libthin/preparation/shoreline.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/preparation_oracle.h"

namespace thin {
namespace {

const char* const kGshhg = "/usr/share/gmt-gshhg/binned_GSHHS_l.nc";

std::vector<int> integers(const char* path, const char* name) {
  int file = 0, variable = 0, dimension = 0;
  std::size_t length = 0;
  EXPECT_EQ(nc_open(path, NC_NOWRITE, &file), NC_NOERR);
  EXPECT_EQ(nc_inq_varid(file, name, &variable), NC_NOERR);
  nc_inq_vardimid(file, variable, &dimension);
  nc_inq_dimlen(file, dimension, &length);
  std::vector<int> values(length);
  EXPECT_EQ(nc_get_var_int(file, variable, values.data()), NC_NOERR);
  nc_close(file);
  return values;
}

// GSHHG itself says what is land at the corners of its bins: an oracle that knows nothing of our edges.
TEST(ShorelineFile, AgreesWithGshhgsOwnCorners) {
  if (!std::filesystem::exists(kGshhg)) GTEST_SKIP() << "no " << kGshhg << ": install gmt-gshhg-low";
  const auto edges = read_shoreline(kGshhg);
  ASSERT_TRUE(edges) << edges.error().message;
  const Shoreline shoreline(*edges);
  const std::vector<int> levels = integers(kGshhg, "Embedded_node_levels_in_a_bin");
  const double size_deg = integers(kGshhg, "Bin_size_in_minutes").front() / 60.0;
  const int columns = integers(kGshhg, "N_bins_in_360_longitude_range").front();
  std::size_t land = 0;
  for (std::size_t bin = 0; bin < levels.size(); ++bin) {
    const double west = static_cast<double>(static_cast<int>(bin) % columns) * size_deg;
    const double south = 90 - (static_cast<int>(bin) / columns + 1) * size_deg;
    const double corners[][2] = {
        {south, west}, {south, west + size_deg}, {south + size_deg, west + size_deg}, {south + size_deg, west}};
    for (int corner = 0; corner < 4; ++corner) {
      const bool expected = ((levels[bin] >> (9 - 3 * corner)) & 7) >= 1;
      EXPECT_EQ(shoreline.is_land(corners[corner][0], corners[corner][1]), expected)
          << corners[corner][0] << " " << corners[corner][1];
      land += expected;
    }
  }
  EXPECT_GT(land, 500U);
}

TEST(ShorelineFile, KnowsPlacesThatEverybodyKnows) {
  if (!std::filesystem::exists(kGshhg)) GTEST_SKIP() << "no " << kGshhg << ": install gmt-gshhg-low";
  const auto edges = read_shoreline(kGshhg);
  ASSERT_TRUE(edges) << edges.error().message;
  const Shoreline shoreline(*edges);
  struct Place {
    const char* name;
    double latitude, longitude;
    bool is_land;
  };
  const Place places[] = {{"Paris", 48.86, 2.35, true},
                          {"mid Atlantic", 30, -40, false},
                          {"South Pole", -90, 0, true},
                          {"near the South Pole", -89.9, 123, true},
                          {"North Pole", 90, 0, false},
                          {"near the North Pole", 89.9, -77, false},
                          {"Filchner ice shelf", -80, -41, true},
                          {"Ross ice shelf", -81, 180, true},
                          {"Southern Ocean", -60, -180, false},
                          {"Chukotka, east of the date line", 67, -179, true},
                          {"Chukotka, west of it", 67.5, 179, true},
                          {"Vanua Levu, at it", -16.6, 179.2, true},
                          {"Pacific at it", 0, 180, false},
                          {"Greenwich, at the meridian of 0", 51.48, 0, true},
                          {"Gulf of Guinea", 0, 0, false},
                          {"Lake Victoria: lakes are land", -1, 33, true},
                          {"Caspian Sea: the largest of them", 42, 51, true},
                          {"Greenland", 75, -40, true}};
  for (const Place& place : places)
    EXPECT_EQ(shoreline.is_land(place.latitude, place.longitude), place.is_land) << place.name;
  // Shores are coasts, the data's own cuts are not.
  EXPECT_FALSE(shoreline.is_near(geocentric_km(-90, 0), 300));
  EXPECT_FALSE(shoreline.is_near(geocentric_km(-85, 0), 50));
  EXPECT_FALSE(shoreline.is_near(geocentric_km(70, 100), 50));
  EXPECT_FALSE(shoreline.is_near(geocentric_km(0, 180), 50));
  EXPECT_TRUE(shoreline.is_near(geocentric_km(43.3, 5.37), 5)) << "Marseille";
}

// Random places of the whole world, every edge looked at from the other pole.
TEST(ShorelineFile, AgreesWithEveryEdgeTogether) {
  if (!std::filesystem::exists(kGshhg)) GTEST_SKIP() << "no " << kGshhg << ": install gmt-gshhg-low";
  const auto edges = read_shoreline(kGshhg);
  ASSERT_TRUE(edges) << edges.error().message;
  const Shoreline shoreline(*edges);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> latitudes(-90, 90), longitudes(0, 360);
  std::size_t land = 0;
  for (int i = 0; i < 3000; ++i) {
    const double latitude = latitudes(random), longitude = longitudes(random);
    const bool expected = test::is_land_seen_from_the_south(*edges, latitude, longitude);
    EXPECT_EQ(shoreline.is_land(latitude, longitude), expected) << latitude << " " << longitude;
    land += expected;
  }
  EXPECT_GT(land, 700U);
}

// A mask of the whole globe at `step_deg`, south to north where `upwards`; named `name`.
std::string write_mask(const std::string& path, double step_deg, bool upwards, const char* name,
                       const std::function<bool(double, double)>& is_land, double longitude_end = 360) {
  const int rows = static_cast<int>(180 / step_deg), columns = static_cast<int>(longitude_end / step_deg);
  std::vector<double> latitudes, longitudes;
  for (int row = 0; row < rows; ++row) {
    const double south_up = -90 + (row + 0.5) * step_deg;
    latitudes.push_back(upwards ? south_up : -south_up);
  }
  for (int column = 0; column < columns; ++column) longitudes.push_back(column * step_deg);
  std::vector<short> land;
  for (const double latitude : latitudes)
    for (const double longitude : longitudes) land.push_back(is_land(latitude, longitude) ? 100 : 0);
  int file = 0, dimensions[3], variables[3];
  const double scale = 0.01;
  EXPECT_EQ(nc_create(path.c_str(), NC_NETCDF4, &file), NC_NOERR);
  nc_def_dim(file, "time", 1, &dimensions[0]);
  nc_def_dim(file, "lat", latitudes.size(), &dimensions[1]);
  nc_def_dim(file, "lon", longitudes.size(), &dimensions[2]);
  nc_def_var(file, "lat", NC_DOUBLE, 1, &dimensions[1], &variables[0]);
  nc_def_var(file, "lon", NC_DOUBLE, 1, &dimensions[2], &variables[1]);
  nc_def_var(file, name, NC_SHORT, 3, dimensions, &variables[2]);
  nc_put_att_double(file, variables[2], "scale_factor", NC_DOUBLE, 1, &scale);
  nc_put_var_double(file, variables[0], latitudes.data());
  nc_put_var_double(file, variables[1], longitudes.data());
  EXPECT_EQ(nc_put_var_short(file, variables[2], land.data()), NC_NOERR);
  nc_close(file);
  return path;
}

TEST(ShorelineFile, ReadsAMaskCellByCell) {
  const test::ScratchFolder folder;
  const auto is_land = [](double latitude, double longitude) {
    return latitude > 70 || std::fmod(std::floor(latitude / 15) + std::floor(longitude / 30) + 100, 2) == 0;
  };
  for (const bool upwards : {false, true}) {
    const auto edges = read_shoreline(write_mask(folder.path("mask.nc"), 2.5, upwards, "lsm", is_land));
    ASSERT_TRUE(edges) << edges.error().message;
    const Shoreline shoreline(*edges);
    for (double latitude = -88.7; latitude < 90; latitude += 2.5)
      for (double longitude = 0.1; longitude < 360; longitude += 2.5)
        EXPECT_EQ(shoreline.is_land(latitude, longitude), is_land(latitude - 0.05, longitude - 0.1))
            << latitude << " " << longitude;
    EXPECT_TRUE(shoreline.is_land(90, 0));
    EXPECT_FALSE(shoreline.is_near(geocentric_km(90, 0), 500)) << "a map's end at the pole is no coast";
  }
}

TEST(ShorelineFile, SaysWhatIsWrongWithAFile) {
  const test::ScratchFolder folder;
  const auto problem = [](const std::string& path) {
    const auto edges = read_shoreline(path);
    EXPECT_FALSE(edges);
    if (edges) return std::string();
    EXPECT_EQ(edges.error().kind, ErrorKind::configuration);
    return edges.error().message;
  };
  EXPECT_NE(problem(folder.path("none.nc")).find("install Debian's package gmt-gshhg-low"), std::string::npos);
  EXPECT_NE(problem(folder.write("text.nc", test::bytes_of("no netCDF"))).find("can't be used as a land/sea mask"),
            std::string::npos);
  const auto land = [](double, double) { return true; };
  EXPECT_NE(problem(write_mask(folder.path("a.nc"), 10, true, "topography", land)).find("neither GSHHG's segments"),
            std::string::npos);
  EXPECT_NE(problem(write_mask(folder.path("b.nc"), 10, true, "lsm", land, 180)).find("does not cover the globe"),
            std::string::npos);
}

}  // namespace
}  // namespace thin
