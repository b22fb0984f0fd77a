// thin info, as it is called.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libthin/tools/commands.h"
#include "tests/support/bufr_messages.h"

namespace thin {
namespace {

using test::ScratchFolder;

struct Outcome {
  int code = -1;
  std::string output;
};

Outcome info(const std::vector<std::string>& arguments) {
  CLI::App program;
  Action action;
  add_info_command(program, action);
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  reversed.emplace_back("info");
  program.parse(reversed);
  testing::internal::CaptureStdout();
  const int code = action();
  return {code, testing::internal::GetCapturedStdout()};
}

test::ByteVector some_file() {
  std::vector<test::TestSounding> soundings = test::test_soundings(31);
  for (test::TestSounding& sounding : soundings) sounding.slots[3].second = test::kMissingValue;
  return test::joined({test::bytes_of("junk"), test::make_message(soundings)});
}

TEST(InfoCommand, ShowsATableForPeople) {
  const ScratchFolder folder;
  const Outcome outcome = info({folder.write("file.bufr", some_file())});
  EXPECT_EQ(outcome.code, 0);
  for (const char* part : {"file.bufr\n", "bufr edition 4", "AMSU-A", "1, of which 1 in use", "4 stray bytes", "310009",
                           "Metop-A (4): 31 observations", "2020-06-15T12:30:00.125Z to 2020-06-15T12:30:30.125Z",
                           "-60.0000 to -45.0000", "100.0000 to 107.5000"})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\n" << outcome.output;
}

TEST(InfoCommand, TellsTheInstrumentsOfAMixedFileApart) {
  std::vector<test::TestSounding> mhs = test::test_soundings(4);
  for (test::TestSounding& sounding : mhs) {
    sounding.sensor = 11;
    sounding.slots = {{43, 250}, {44, 251}, {45, 252}, {46, 253}, {47, 254}};
  }
  const ScratchFolder folder;
  const std::string path = folder.write(
      "file.bufr",
      test::joined({some_file(), test::make_message(mhs, {.descriptors = {310010}, .slots_per_subset = 5})}));
  const Outcome outcome = info({path});
  EXPECT_EQ(outcome.code, 0);
  for (const char* part : {"AMSU-A: 31 observations, MHS: 4 observations", "AMSU-A 15        31         0",
                           "MHS 5         4         0    254.00"})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\n" << outcome.output;
  const auto json = nlohmann::json::parse(info({"--json", path}).output);
  EXPECT_EQ(json[0]["instruments"][1]["name"], "MHS");
  EXPECT_EQ(json[0]["channels"][15]["instrument"], "MHS");
  EXPECT_EQ(json[0]["channels"][15]["channel"], 1);
}

TEST(InfoCommand, WritesJsonForMachines) {
  const ScratchFolder folder;
  const Outcome outcome = info({"--json", folder.write("file.bufr", some_file()), folder.write("empty", {})});
  EXPECT_EQ(outcome.code, 3);
  const auto json = nlohmann::json::parse(outcome.output);
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[0]["usable"], true);
  EXPECT_EQ(json[0]["observations"], 31);
  EXPECT_EQ(json[0]["scan_lines"], 2);
  EXPECT_EQ(json[0]["satellites"][0]["name"], "Metop-A");
  EXPECT_EQ(json[0]["channels"][3]["missing"], 31);
  EXPECT_TRUE(json[0]["channels"][3]["mean_k"].is_null());
  EXPECT_NEAR(json[0]["channels"][0]["mean_k"].get<double>(), 201.5, 1);
  EXPECT_EQ(json[0]["skipped"].size(), 1U);
  EXPECT_EQ(json[1]["usable"], false);
  EXPECT_NE(json[1]["reason"].get<std::string>().find("empty"), std::string::npos);
}

TEST(InfoCommand, GoesOnAfterAFileThatCannotBeUsed) {
  const ScratchFolder folder;
  const std::string good = folder.write("good", some_file());
  const Outcome outcome = info({folder.write("bad", test::bytes_of("no soundings")), folder.path("absent"), good});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.output.find("cannot be used"), std::string::npos);
  EXPECT_NE(outcome.output.find("no BUFR message"), std::string::npos);
  EXPECT_NE(outcome.output.find("No such file"), std::string::npos);
  EXPECT_NE(outcome.output.find("31 observations"), std::string::npos);
}

TEST(InfoCommand, NamesWithoutLettersOfUtf8AreNoErrorInJson) {
  const ScratchFolder folder;
  const Outcome outcome = info({"--json", folder.write("na\xffme", some_file())});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(nlohmann::json::parse(outcome.output).size(), 1U);
}

}  // namespace
}  // namespace thin
