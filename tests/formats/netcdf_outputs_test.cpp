// Writing netCDF again: subsets and flags of every layout, beside the oracle.

#include <gtest/gtest.h>

#include <random>

#include "libthin/formats/netcdf_rewrite.h"
#include "libthin/formats/observation_file.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/extraction_checks.h"
#include "tests/support/netcdf_files.h"
#include "tests/support/netcdf_oracle.h"

namespace thin {
namespace {

using test::KeptEntries;

OutputOptions flag_mode() {
  OutputOptions options;
  options.mode = OutputOptions::Mode::flag;
  return options;
}

class NetcdfOutputsTest : public testing::Test {
 protected:
  std::string path(const char* name) { return scratch_.path(name); }

  std::string extract(const std::string& original, const std::vector<SourceReference>& retained,
                      const OutputOptions& options = {}) {
    const std::string output = path("out.nc");
    const auto summary = extract_observations(original, retained, output, options);
    EXPECT_TRUE(summary.ok()) << summary.error().message;
    if (!summary) return output;
    EXPECT_EQ(summary->messages, 1U);
    EXPECT_EQ(summary->subsets, retained.size());
    EXPECT_EQ(summary->bytes, std::filesystem::file_size(output));
    EXPECT_TRUE(extract_observations(original, retained, path("again.nc"), options).ok());
    EXPECT_TRUE(test::read_bytes(path("again.nc")) == test::read_bytes(output)) << "the same input, the same bytes";
    return output;
  }

  std::vector<SourceReference> all_of(const std::string& file) {
    const auto contents = read_observations(file);
    EXPECT_TRUE(contents.ok()) << contents.error().message;
    return contents ? contents->observations.source : std::vector<SourceReference>{};
  }

  static std::vector<std::size_t> locations(const std::vector<SourceReference>& retained) {
    std::vector<std::size_t> result;
    for (const SourceReference& source : retained) result.push_back(source.subset);
    return result;
  }

  // Subsets of every shape; `kept` says which entries of which dimensions belong to locations.
  template <class Kept>
  void expect_subsets(const std::string& file, const Kept& kept, bool chunks_stay) {
    for (const test::Selection& selection : test::selections_of(all_of(file), 3)) {
      SCOPED_TRACE(selection.name);
      const std::string output = extract(file, selection.retained);
      test::expect_retained(file, output, kept(locations(selection.retained)));
      EXPECT_EQ(test::header_lines(output, chunks_stay), test::header_lines(file, chunks_stay));
      EXPECT_EQ(all_of(output).size(), selection.retained.size());
      if (selection.name == "all") {
        EXPECT_TRUE(test::read_bytes(output) == test::read_bytes(file)) << "byte for byte";
      }
    }
  }

  test::ScratchFolder scratch_;
};

TEST_F(NetcdfOutputsTest, IodaSubsets) {
  const auto kept = [](const std::vector<std::size_t>& retained) { return KeptEntries{{"Location", retained}}; };
  test::IodaShape shape;
  expect_subsets(test::write_ioda(path("unlimited.nc4"), shape), kept, true);
  shape.unlimited = false;
  expect_subsets(test::write_ioda(path("fixed.nc4"), shape), kept, false);
}

TEST_F(NetcdfOutputsTest, OldIodaSubsets) {
  const auto kept = [](const std::vector<std::size_t>& retained) { return KeptEntries{{"nlocs", retained}}; };
  expect_subsets(test::write_old_ioda(path("a.nc4"), false), kept, true);
  expect_subsets(test::write_old_ioda(path("a.nc"), true), kept, true);
}

TEST_F(NetcdfOutputsTest, GsiSubsetsHoldAllChannelsOfALocation) {
  expect_subsets(
      test::write_gsi(path("a.nc4")),
      [](const std::vector<std::size_t>& retained) {
        KeptEntries kept;
        for (const std::size_t i : retained)
          for (std::size_t c = 0; c < 15; ++c) kept["nobs"].push_back(15 * i + c);
        return kept;
      },
      false);
}

TEST_F(NetcdfOutputsTest, CfSubsets) {
  const auto kept = [](const std::vector<std::size_t>& retained) { return KeptEntries{{"record", retained}}; };
  expect_subsets(test::write_foreign_cf(path("a.nc")), kept, false);
}

// Header and body of the retained reports, and of the others where they stay.
KeptEntries feedback_entries(const std::string& file, const std::vector<std::size_t>& headers) {
  const auto variables = test::read_all_variables(file);
  const auto number = [&](const char* name, std::size_t i) {
    const std::string& bytes = variables.at(name).values[i];
    return bytes.size() == 4 ? *reinterpret_cast<const std::int32_t*>(bytes.data())
                             : *reinterpret_cast<const std::int16_t*>(bytes.data());
  };
  KeptEntries kept{{"d_hdr", headers}, {"d_body", {}}};
  for (const std::size_t i : headers)
    for (int entry = 0; entry < number("l_body", i); ++entry)
      kept["d_body"].push_back(static_cast<std::size_t>(number("i_body", i) - 1 + entry));
  std::sort(kept["d_body"].begin(), kept["d_body"].end());
  return kept;
}

TEST_F(NetcdfOutputsTest, FeedbackSubsetsHaveTheirTablesRebuilt) {
  for (const bool reversed : {false, true})
    for (const bool mixed : {false, true})
      for (const char* kind : {"64-bit offset", "nc7"}) {
        SCOPED_TRACE(std::string(kind) + (reversed ? ", reversed" : "") + (mixed ? ", mixed" : ""));
        test::FeedbackShape shape;
        shape.reversed_body = reversed;
        shape.mixed = mixed;
        shape.kind = kind;
        const std::string file = test::write_feedback(path("fof.nc"), shape);
        InputOptions input;
        const auto before = read_observations(file, input);
        ASSERT_TRUE(before.ok());
        for (const test::Selection& selection : test::selections_of(before->observations.source, 3)) {
          SCOPED_TRACE(selection.name);
          const std::string output = extract(file, selection.retained);
          if (selection.retained.size() == before->observations.size()) {
            EXPECT_TRUE(test::read_bytes(output) == test::read_bytes(file));
            continue;
          }
          std::vector<std::size_t> headers;
          for (const std::size_t i : locations(selection.retained)) headers.push_back(i);
          for (std::size_t i = 0; i < shape.reports; ++i)
            if (test::report_kind(shape, i) == test::ReportKind::temp) headers.push_back(i);
          std::sort(headers.begin(), headers.end());
          const KeptEntries kept = feedback_entries(file, headers);
          test::expect_retained(file, output, kept, {"i_body"});
          const KeptEntries again = feedback_entries(output, [&] {
            std::vector<std::size_t> every(headers.size());
            for (std::size_t i = 0; i < every.size(); ++i) every[i] = i;
            return every;
          }());
          std::vector<std::size_t> whole(kept.at("d_body").size());
          for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = i;
          EXPECT_EQ(again.at("d_body"), whole) << "reports cover the new body without gap";
          const test::OpenNetcdf opened(output);
          int n_hdr = 0, n_body = 0;
          nc_get_att_int(opened.id, NC_GLOBAL, "n_hdr", &n_hdr);
          nc_get_att_int(opened.id, NC_GLOBAL, "n_body", &n_body);
          EXPECT_EQ(static_cast<std::size_t>(n_hdr), headers.size());
          EXPECT_EQ(static_cast<std::size_t>(n_body), whole.size());

          // What is read of the output is what was read of the retained.
          const auto after = read_observations(output, input);
          ASSERT_TRUE(after.ok()) << after.error().message;
          ASSERT_EQ(after->observations.size(), selection.retained.size());
          std::map<std::pair<double, double>, std::size_t> rows;
          for (std::size_t i = 0; i < before->observations.size(); ++i)
            rows[{before->observations.latitude_deg[i], before->observations.longitude_deg[i]}] = i;
          for (std::size_t i = 0; i < after->observations.size(); ++i) {
            const std::size_t was =
                rows.at({after->observations.latitude_deg[i], after->observations.longitude_deg[i]});
            EXPECT_EQ(after->observations.time_ms[i], before->observations.time_ms[was]);
            EXPECT_EQ(after->observations.instrument[i], before->observations.instrument[was]);
            for (std::size_t place = 0; place < after->observations.channel_count(); ++place) {
              const double value = after->observations.values_of(i)[place];
              const Instrument whose = after->observations.channel_instrument.empty()
                                           ? after->observations.instrument[i]
                                           : after->observations.channel_instrument[place];
              for (std::size_t old = 0; old < before->observations.channel_count(); ++old) {
                const Instrument old_whose = before->observations.channel_instrument.empty()
                                                 ? before->observations.instrument[was]
                                                 : before->observations.channel_instrument[old];
                if (before->observations.channels[old] != after->observations.channels[place] || whose != old_whose)
                  continue;
                const double old_value = before->observations.values_of(was)[old];
                EXPECT_TRUE(value == old_value || (std::isnan(value) && std::isnan(old_value)));
              }
            }
          }
        }
      }
}

TEST_F(NetcdfOutputsTest, FeedbackReportsOfOtherKindsLeaveWhereAskedTo) {
  const test::FeedbackShape shape;
  const std::string file = test::write_feedback(path("fof.nc"), shape);
  std::vector<SourceReference> retained = all_of(file);
  retained.resize(5);
  OutputOptions options;
  options.other_messages = OutputOptions::OtherMessages::drop;
  const std::string output = extract(file, retained, options);
  std::vector<std::size_t> headers = locations(retained);
  std::sort(headers.begin(), headers.end());
  test::expect_retained(file, output, feedback_entries(file, headers), {"i_body"});
}

template <class Number>
std::vector<long> numbers_of(const test::OracleVariable& variable) {
  std::vector<long> numbers;
  for (const std::string& bytes : variable.values) {
    Number number;
    std::memcpy(&number, bytes.data(), sizeof number);
    numbers.push_back(static_cast<long>(number));
  }
  return numbers;
}

TEST_F(NetcdfOutputsTest, FeedbackFlags) {
  test::FeedbackShape shape;
  const std::string file = test::write_feedback(path("fof.nc"), shape);
  std::vector<SourceReference> retained;
  for (const SourceReference& source : all_of(file))
    if (source.subset % 2 == 0) retained.push_back(source);
  const std::string output = extract(file, retained, flag_mode());
  const std::set<std::string> flagged = {"state", "flags", "check", "r_state", "r_flags", "r_check"};
  test::expect_retained(file, output, {}, flagged);
  const auto before = test::read_all_variables(file), after = test::read_all_variables(output);
  const auto old_state = numbers_of<signed char>(before.at("state")),
             state = numbers_of<signed char>(after.at("state"));
  const auto old_flags = numbers_of<std::int32_t>(before.at("flags")),
             flags = numbers_of<std::int32_t>(after.at("flags"));
  const auto check = numbers_of<signed char>(after.at("check")),
             old_check = numbers_of<signed char>(before.at("check"));
  const auto r_state = numbers_of<signed char>(after.at("r_state")),
             r_check = numbers_of<signed char>(after.at("r_check"));
  const auto r_flags = numbers_of<std::int32_t>(after.at("r_flags"));
  for (std::size_t i = 0; i < shape.reports; ++i) {
    SCOPED_TRACE(i);
    const bool thinned = test::report_kind(shape, i) != test::ReportKind::temp && i % 2 != 0;
    EXPECT_EQ(r_state[i], thinned ? 7 : 1);
    EXPECT_EQ(r_flags[i], thinned ? 1 << 13 : 0);
    EXPECT_EQ(r_check[i], thinned ? 13 : 32);
    const KeptEntries entries = feedback_entries(file, {i});
    for (const std::size_t entry : entries.at("d_body")) {
      const bool decided = thinned && old_state[entry] < 7;
      EXPECT_EQ(state[entry], !decided ? old_state[entry] : old_state[entry] == 5 ? 9 : 7);
      EXPECT_EQ(flags[entry], thinned ? old_flags[entry] | 1 << 13 : old_flags[entry]);
      EXPECT_EQ(check[entry], decided ? 13 : old_check[entry]);
    }
  }
}

TEST_F(NetcdfOutputsTest, FlagsOfTheOtherLayouts) {
  struct Case {
    std::string file, variable;
    long thinned;
    std::size_t width;  // flags per location
  };
  const std::vector<Case> cases = {
      {test::write_ioda(path("a.nc4")), "ThinningQC/brightnessTemperature", 16, 15},
      {test::write_old_ioda(path("b.nc4"), false), "brightness_temperature@ThinningQC", 16, 15},
      {test::write_old_ioda(path("c.nc"), true), "brightness_temperature_7@ThinningQC", 16, 1},
      {test::write_gsi(path("d.nc4")), "Thinning_Flag", 1, 15},
      {test::write_foreign_cf(path("e.nc")), "thinning_flag", 1, 1}};
  for (const Case& tested : cases) {
    SCOPED_TRACE(tested.variable);
    std::vector<SourceReference> retained;
    for (const SourceReference& source : all_of(tested.file))
      if (source.subset % 3 == 1) retained.push_back(source);
    const std::string output = extract(tested.file, retained, flag_mode());
    const auto before = test::read_all_variables(tested.file), after = test::read_all_variables(output);
    for (const auto& [name, variable] : before) EXPECT_EQ(after.at(name).values, variable.values) << name;
    const std::vector<long> flags = numbers_of<std::int32_t>(after.at(tested.variable));
    ASSERT_EQ(flags.size(), 40 * tested.width);
    for (std::size_t i = 0; i < flags.size(); ++i)
      EXPECT_EQ(flags[i], i / tested.width % 3 == 1 ? 0 : tested.thinned) << i;
  }
}

TEST_F(NetcdfOutputsTest, WhatWasFlaggedOnceCanBeFlaggedAgain) {
  for (const std::string& file : {test::write_gsi(path("a.nc4")), test::write_foreign_cf(path("b.nc"))}) {
    const std::vector<SourceReference> all = all_of(file);
    const std::string once = extract(file, {all.begin(), all.begin() + 5}, flag_mode());
    std::filesystem::rename(once, path("once.nc"));
    const std::string direct = extract(file, {all.begin() + 5, all.end()}, flag_mode());
    const auto wanted = test::read_all_variables(direct);
    const auto twice = test::read_all_variables(extract(path("once.nc"), {all.begin() + 5, all.end()}, flag_mode()));
    for (const auto& [name, variable] : wanted) EXPECT_EQ(twice.at(name).values, variable.values) << name;
  }
  const std::string ioda = test::write_ioda(path("c.nc4"));
  const std::string once = extract(ioda, {{0, 0, 1}}, flag_mode());
  std::filesystem::rename(once, path("once.nc4"));
  const auto refused =
      extract_observations(path("once.nc4"), std::vector<SourceReference>{{0, 0, 2}}, path("x.nc4"), flag_mode());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::configuration);
  EXPECT_NE(refused.error().message.find("ioda_flag_group"), std::string::npos) << refused.error().message;
}

TEST_F(NetcdfOutputsTest, TypesOfTheFilesOwnGoThrough) {
  test::Cdl cdl;
  cdl.type("byte enum surface_t { sea = 0, land = 1, coast = 2 }");
  cdl.type("compound pair_t { int number; float weight; }");
  cdl.type("opaque(4) seal_t");
  cdl.type("int(*) list_t");
  cdl.dimension("Location", 4);
  cdl.dimension("Channel", 1);
  cdl.raw("surface_t surface(Location)", "sea, land, coast, land");
  cdl.raw("pair_t pair(Location)", "{1, 0.5}, {2, 1.5}, {3, 2.5}, {4, 3.5}");
  cdl.raw("seal_t seal(Location)", "0X01020304, 0X05060708, 0X090A0B0C, 0X0D0E0F10");
  cdl.raw("list_t list(Location)", "{1}, {1, 2}, {}, {4, 5, 6}");
  cdl.begin_group("MetaData");
  cdl.variable("double latitude(Location)", {}, {10, 11, 12, 13});
  cdl.variable("double longitude(Location)", {}, {20, 21, 22, 23});
  cdl.variable("double dateTime(Location)", {"units = \"seconds since 1970-01-01T00:00:00Z\""}, {1, 2, 3, 4});
  cdl.end_group();
  cdl.begin_group("ObsValue");
  cdl.variable("double brightnessTemperature(Location, Channel)", {"_Endianness = \"big\"", "_Fletcher32 = \"true\""},
               {200, 201, 202, 203});
  cdl.end_group();
  const std::string file = cdl.write(path("a.nc4"));
  const std::string output = path("out.nc4");
  ASSERT_TRUE(extract_observations(file, std::vector<SourceReference>{{0, 0, 3}, {0, 0, 1}}, output, {}).ok());
  const std::string dump = test::output_of("ncdump '" + output + "'");
  for (const char* part : {"surface = land, land", "pair = {2, 1.5}, {4, 3.5}", "seal = 0X05060708, 0X0D0E0F10",
                           "list = {1, 2}, {4, 5, 6}", "latitude = 11, 13"})
    EXPECT_NE(dump.find(part), std::string::npos) << part << "\n" << dump;
  EXPECT_EQ(test::header_lines(output, false), test::header_lines(file, false));
}

TEST_F(NetcdfOutputsTest, LargeVariablesGoThroughInSlabs) {
  for (const std::string& name : {test::write_ioda(path("a.nc4")), test::write_feedback(path("b.nc"))}) {
    const test::ByteVector bytes = test::read_bytes(name);
    const auto file = NetcdfFile::open(bytes, name);
    ASSERT_TRUE(file.ok());
    NetcdfEdit edit;
    for (const char* dimension : {"Location", "d_body"}) {
      int id = 0;
      if (nc_inq_dimid(file->id(), dimension, &id) == NC_NOERR) edit.kept[id] = {1, 2, 17, 30};
    }
    const auto whole = rewrite_netcdf(*file, edit, path("scratch"));
    ASSERT_TRUE(whole.ok()) << whole.error().message;
    scratch_.write("whole.nc", *whole);
    for (const std::size_t slab_bytes : {1, 100, 1000}) {
      const auto slabs = rewrite_netcdf(*file, edit, path("scratch"), slab_bytes);
      ASSERT_TRUE(slabs.ok()) << slabs.error().message;
      scratch_.write("slabs.nc", *slabs);
      test::expect_retained(path("whole.nc"), path("slabs.nc"), {});
    }
    test::expect_retained(name, path("whole.nc"), {{"Location", {1, 2, 17, 30}}, {"d_body", {1, 2, 17, 30}}});
    EXPECT_FALSE(std::filesystem::exists(path("scratch")));
  }
}

TEST_F(NetcdfOutputsTest, OthersCanAppendToTheOutput) {
  const std::string file = test::write_ioda(path("a.nc4"));
  const std::string output = extract(file, {{0, 0, 3}, {0, 0, 1}});
  int opened = 0, group = 0;
  ASSERT_EQ(nc_open(output.c_str(), NC_WRITE, &opened), NC_NOERR);
  EXPECT_EQ(nc_def_grp(opened, "EffectiveQC", &group), NC_NOERR);
  EXPECT_EQ(nc_put_att_text(opened, NC_GLOBAL, "history", 4, "more"), NC_NOERR);
  EXPECT_EQ(nc_close(opened), NC_NOERR);
  EXPECT_TRUE(read_observations(output).ok());
}

TEST_F(NetcdfOutputsTest, WhereNothingCanBeWrittenTheErrorSaysSo) {
  const std::string file = test::write_ioda(path("a.nc4"));
  const auto refused =
      extract_observations(file, std::vector<SourceReference>{{0, 0, 3}}, path("no/such/folder.nc4"), {});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("No such file or directory"), std::string::npos) << refused.error().message;
}

TEST_F(NetcdfOutputsTest, NothingRetainedWritesNothing) {
  const std::string file = test::write_ioda(path("a.nc4"));
  const auto summary = extract_observations(file, {}, path("out.nc"), {});
  ASSERT_TRUE(summary.ok());
  EXPECT_EQ(summary->messages, 0U);
  EXPECT_FALSE(std::filesystem::exists(path("out.nc")));
  const auto flags = numbers_of<std::int32_t>(
      test::read_all_variables(extract(file, {}, flag_mode())).at("ThinningQC/brightnessTemperature"));
  EXPECT_EQ(flags, std::vector<long>(flags.size(), 16)) << "but with flags everything is flagged";
}

TEST_F(NetcdfOutputsTest, AFileThatHasShrunkSinceIsRefused) {
  for (const std::string& file : {test::write_ioda(path("a.nc4")), test::write_gsi(path("b.nc4")),
                                  test::write_feedback(path("c.nc")), test::write_foreign_cf(path("d.nc"))})
    for (const OutputOptions& options : {OutputOptions{}, flag_mode()}) {
      const auto refused =
          extract_observations(file, std::vector<SourceReference>{{0, 0, 4000}}, path("out.nc"), options);
      ASSERT_FALSE(refused.ok());
      EXPECT_EQ(refused.error().kind, ErrorKind::input) << refused.error().message;
    }
}

TEST_F(NetcdfOutputsTest, BufrHasNoFlags) {
  const std::string file = scratch_.write("a.bufr", test::make_message(test::test_soundings(3)));
  const auto refused = extract_observations(file, std::vector<SourceReference>{{0, 0, 1}}, path("out"), flag_mode());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::input);
  EXPECT_EQ(check_output("bufr", flag_mode()).error().kind, ErrorKind::input);
  EXPECT_TRUE(check_output("ioda", flag_mode()).ok());
}

}  // namespace
}  // namespace thin
