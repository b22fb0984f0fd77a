// netCDF that can't be used: refused with a sentence that names the file and the remedy, whatever it is.

#include <gtest/gtest.h>
#include <netcdf.h>

#include <algorithm>
#include <random>

#include "libthin/formats/observation_file.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/netcdf_files.h"

namespace thin {
namespace {

class NetcdfDamageTest : public testing::Test {
 protected:
  std::string path(const char* name) { return scratch_.path(name); }

  Error refused(const std::string& file) {
    const Result<ReadObservations> contents = read_observations(file);
    EXPECT_FALSE(contents.ok());
    if (contents) return {};
    EXPECT_NE(contents.error().message.find(file), std::string::npos) << contents.error().message;
    return contents.error();
  }

  void expect_said(const Error& error, const char* part) {
    EXPECT_NE(error.message.find(part), std::string::npos) << error.message;
  }

  test::ScratchFolder scratch_;
};

// A location with one channel, and what else `add` puts into it.
template <class Add>
std::string write_small(const std::string& path, const Add& add) {
  test::Cdl cdl;
  cdl.dimension("Location", 1);
  cdl.dimension("Channel", 1);
  add(cdl);
  return cdl.write(path);
}

TEST_F(NetcdfDamageTest, WithoutSoundings) {
  const Error error =
      refused(write_small(path("a.nc4"), [](test::Cdl& cdl) { cdl.variable("int Location(Location)", {}, {1}); }));
  EXPECT_EQ(error.kind, ErrorKind::input);
  expect_said(error, "its variables are Location");
  expect_said(error, "Send IODA, GSI diagnostics, feedback files, or CF");
  const Error winds = refused(write_small(path("b.nc4"), [](test::Cdl& cdl) {
    cdl.global("_ioda_layout = \"ObsGroup\"");
    cdl.begin_group("MetaData");
    cdl.variable("float latitude(Location)", {}, {1});
    cdl.variable("float longitude(Location)", {}, {1});
    cdl.variable("int dateTime(Location)", {"units = \"seconds since 1970-01-01T00:00:00Z\""}, {1});
    cdl.end_group();
    cdl.begin_group("ObsValue");
    cdl.variable("float windEastward(Location)", {}, {1});
    cdl.end_group();
  }));
  EXPECT_EQ(winds.kind, ErrorKind::input);
  expect_said(winds, "brightness temperatures");
}

TEST_F(NetcdfDamageTest, AFileThatEndsTooEarlyIsIncomplete) {
  for (const std::string& file : {test::write_ioda(path("a.nc4")), test::write_gsi(path("b.nc4")),
                                  test::write_feedback(path("c.nc")), test::write_old_ioda(path("d.nc"), true)}) {
    const test::ByteVector whole = test::read_bytes(file);
    for (const std::size_t size :
         {std::size_t{9}, std::size_t{60}, whole.size() / 3, whole.size() / 2, whole.size() - 1}) {
      SCOPED_TRACE(file + " " + std::to_string(size) + " of " + std::to_string(whole.size()));
      const Error error =
          refused(scratch_.write("cut.nc", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}));
      EXPECT_EQ(error.kind, ErrorKind::incomplete) << error.message;
      expect_said(error, "Wait for the rest");
    }
  }
}

// Declared, chunked and never written: a few hundred bytes.
std::string write_huge(const std::string& path, std::size_t locations) {
  int file = 0, group = 0, variable = 0, location = 0;
  EXPECT_EQ(nc_create(path.c_str(), NC_NETCDF4, &file), NC_NOERR);
  EXPECT_EQ(nc_def_dim(file, "Location", locations, &location), NC_NOERR);
  EXPECT_EQ(nc_def_grp(file, "MetaData", &group), NC_NOERR);
  const std::size_t chunk = 1000;
  for (const char* name : {"latitude", "longitude", "dateTime"}) {
    EXPECT_EQ(nc_def_var(group, name, NC_FLOAT, 1, &location, &variable), NC_NOERR);
    EXPECT_EQ(nc_def_var_chunking(group, variable, NC_CHUNKED, &chunk), NC_NOERR);
  }
  EXPECT_EQ(nc_close(file), NC_NOERR);
  return path;
}

TEST_F(NetcdfDamageTest, HugeDeclaredDimensionsAreNotAllocated) {
  for (const std::size_t locations : {std::size_t{100000000}, std::size_t{2000000000}, std::size_t{1} << 60}) {
    const Error error = refused(write_huge(path("a.nc4"), locations));
    EXPECT_EQ(error.kind, ErrorKind::input);
    expect_said(error, "can hold: it is damaged. Ask the sender for it again.");
  }
}

TEST_F(NetcdfDamageTest, FeedbackTablesThatLeadOutOfTheBody) {
  const auto file_with = [&](std::size_t reports, const char* attribute) {
    test::Cdl cdl;
    cdl.dimension("d_hdr", 1);
    cdl.dimension("d_body", 2);
    cdl.global("n_hdr = " + std::to_string(reports));
    cdl.global(attribute);
    cdl.variable("int i_body(d_hdr)", {}, {2});
    cdl.variable("short l_body(d_hdr)", {}, {2});
    cdl.variable("byte obstype(d_hdr)", {}, {10});
    cdl.variable("short varno(d_body)", {}, {119, 119});
    cdl.variable("float level(d_body)", {}, {1, 2});
    return cdl.write(path("fof.nc"), "nc3");
  };
  expect_said(refused(file_with(2, "n_body = 2")), "n_hdr 2");
  expect_said(refused(file_with(1, "n_body = 3")), "n_body 3");
  expect_said(refused(file_with(1, "n_body = 2")), "outside of the body");
}

TEST_F(NetcdfDamageTest, ClassicHeadersThatNetcdfDoesNotSurviveAreRefusedFirst) {
  const test::ByteVector whole = test::read_bytes(test::write_feedback(path("fof.nc")));
  // CDF-2: magic, number of records, tag and length of the list of dimensions, length of the first name.
  for (const std::size_t place : {std::size_t{12}, std::size_t{16}}) {
    test::ByteVector changed = whole;
    changed[place] = 0x9b;
    const Error error = refused(scratch_.write("changed.nc", changed));
    EXPECT_EQ(error.kind, ErrorKind::input);
    expect_said(error, "makes no sense");
  }
  // The dimension of the records behind another one.
  test::ByteVector swapped = whole;
  const auto name = test::bytes_of("veri_data");
  const auto found = std::search(swapped.begin(), swapped.end(), name.begin(), name.end());
  ASSERT_NE(found, swapped.end());
  const auto dimensions = found + 12 + 4;  // the padded name, the number of dimensions
  std::swap_ranges(dimensions, dimensions + 4, dimensions + 4);
  expect_said(refused(scratch_.write("swapped.nc", swapped)), "makes no sense");
}

TEST_F(NetcdfDamageTest, EveryByteChangedOnceIsReadOrRefusedAndDoesNotCrash) {
  // Classic files in full, since nothing but netCDF's own short parser is between us and the bytes; HDF5 is left to the
  // fuzzer, in a process of its own.
  test::FeedbackShape shape;
  shape.reports = 3;
  shape.channels = 2;
  const test::ByteVector whole = test::read_bytes(test::write_feedback(path("fof.nc"), shape));
  std::mt19937 random(5);
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 1500);
  for (std::size_t i = 0; i < whole.size(); i += step) {
    test::ByteVector changed = whole;
    changed[i] = static_cast<std::uint8_t>(random());
    const Result<ReadObservations> contents = read_observations(changed, "changed.nc", {});
    if (!contents) {
      EXPECT_FALSE(contents.error().message.empty());
      EXPECT_NE(contents.error().kind, ErrorKind::internal) << contents.error().message;
    }
  }
}

}  // namespace
}  // namespace thin
