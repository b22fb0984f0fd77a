#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "libthin/formats/observation_file.h"
#include "libthin/observations/time.h"
#include "libthin/tools/commands.h"

namespace thin {
namespace {

class SynthCommand : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "thin-synth-XXXXXX").string();
    ASSERT_TRUE(::mkdtemp(pattern.data()));
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  struct Outcome {
    int exit_status;
    std::string output, errors;
  };

  // `thin synth -o FOLDER/name ...`
  Outcome synth(const std::string& name, std::vector<std::string> words) const {
    words.insert(words.begin(), {"synth", "-o", (folder_ / name).string()});
    CLI::App program("thin");
    Action action;
    add_synth_command(program, action);
    program.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes the words from the back
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int exit_status = action();
    return {exit_status, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
  }

  // Bytes of each file in FOLDER/name, hidden ones too.
  std::map<std::string, std::string> files(const std::string& name) const {
    std::map<std::string, std::string> contents;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / name)) {
      std::ifstream file(entry.path(), std::ios::binary);
      contents[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
    }
    return contents;
  }

  ReadObservations read(const std::string& name, const std::string& file) const {
    auto contents = read_observations((folder_ / name / file).string());
    EXPECT_TRUE(contents) << contents.error().message;
    return contents ? *contents : ReadObservations{};
  }

  std::filesystem::path folder_;
};

TEST_F(SynthCommand, WritesFilesPerSatelliteAndTime) {
  const Outcome outcome = synth("a", {"--duration-minutes", "25"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto written = files("a");
  std::vector<std::string> names;
  for (const auto& [name, bytes] : written) names.push_back(name);
  const std::vector<std::string> expected = {
      "amsua_noaa15_20040721T223000Z.bufr", "amsua_noaa15_20040721T224000Z.bufr", "amsua_noaa15_20040721T225000Z.bufr",
      "amsua_noaa16_20040721T223000Z.bufr", "amsua_noaa16_20040721T224000Z.bufr", "amsua_noaa16_20040721T225000Z.bufr"};
  EXPECT_EQ(names, expected);
  for (const std::string& name : names) EXPECT_NE(outcome.output.find(name), std::string::npos) << name;
  // 25 minutes are 187.5 lines.
  EXPECT_NE(outcome.output.find("6 files, 11280 observations"), std::string::npos) << outcome.output;

  const ReadObservations first = read("a", "amsua_noaa16_20040721T224000Z.bufr");
  EXPECT_EQ(first.observations.size(), 75U * 30U);
  EXPECT_EQ(first.message_count, 8U);
  EXPECT_EQ(first.observations.platform.front(), 207);
  EXPECT_EQ(first.observations.time_ms.front(), from_iso8601("2004-07-21T22:40Z"));
}

TEST_F(SynthCommand, SeedDecidesEveryByte) {
  const std::vector<std::string> words = {"--duration-minutes", "4", "--seed"};
  const auto with_seed = [&](const std::string& name, const std::string& seed) {
    auto all = words;
    all.push_back(seed);
    EXPECT_EQ(synth(name, all).exit_status, 0);
    return files(name);
  };
  const auto one = with_seed("a", "1");
  EXPECT_EQ(one, with_seed("b", "1"));
  const auto other = with_seed("c", "2");
  ASSERT_EQ(one.size(), other.size());
  for (const auto& [name, bytes] : one) EXPECT_NE(bytes, other.at(name));
}

TEST_F(SynthCommand, CutIntoOtherFilesTheSoundingsAreTheSame) {
  ASSERT_EQ(synth("whole", {"--satellite", "NOAA-15", "--duration-minutes", "6"}).exit_status, 0);
  ASSERT_EQ(synth("parts", {"--satellite", "NOAA-15", "--duration-minutes", "6", "--minutes-per-file", "1",
                            "--lines-per-message", "3"})
                .exit_status,
            0);
  const ObservationSet whole = read("whole", "amsua_noaa15_20040721T223000Z.bufr").observations;
  ObservationSet parts;
  parts.channels = whole.channels;
  for (const auto& [name, bytes] : files("parts")) parts.append(read("parts", name).observations);
  EXPECT_EQ(whole.size(), 45U * 30U);
  EXPECT_EQ(parts.values, whole.values);
  EXPECT_EQ(parts.time_ms, whole.time_ms);
  EXPECT_EQ(parts.latitude_deg, whole.latitude_deg);
  EXPECT_EQ(parts.scan_line, whole.scan_line);
}

TEST_F(SynthCommand, NoiseCanBeLeftOut) {
  ASSERT_EQ(synth("noisy", {"--satellite", "NOAA-15", "--duration-minutes", "10"}).exit_status, 0);
  ASSERT_EQ(synth("quiet", {"--satellite", "NOAA-15", "--duration-minutes", "10", "--no-noise"}).exit_status, 0);
  const auto noisy = read("noisy", "amsua_noaa15_20040721T223000Z.bufr").observations;
  const auto quiet = read("quiet", "amsua_noaa15_20040721T223000Z.bufr").observations;
  double squares = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) squares += std::pow(noisy.values_of(i)[4] - quiet.values_of(i)[4], 2);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(noisy.size())), 0.25, 0.02);  // channel 5's
}

TEST_F(SynthCommand, DeadChannelsAreMissing) {
  ASSERT_EQ(synth("a", {"--duration-minutes", "2", "--dead-channel", "NOAA-16:4"}).exit_status, 0);
  const auto hurt = read("a", "amsua_noaa16_20040721T223000Z.bufr").observations;
  const auto sound = read("a", "amsua_noaa15_20040721T223000Z.bufr").observations;
  for (std::size_t i = 0; i < hurt.size(); ++i)
    for (std::size_t channel = 0; channel < 15; ++channel) {
      EXPECT_EQ(std::isnan(hurt.values_of(i)[channel]), channel == 3);
      EXPECT_FALSE(std::isnan(sound.values_of(i)[channel]));
    }
}

TEST_F(SynthCommand, GtsBulletinsHoldTheSameSoundings) {
  ASSERT_EQ(synth("plain", {"--satellite", "metop-a", "--duration-minutes", "2"}).exit_status, 0);
  ASSERT_EQ(synth("gts", {"--satellite", "metop-a", "--duration-minutes", "2", "--gts"}).exit_status, 0);
  const std::string file = "amsua_metopa_20040721T223000Z.bufr";
  EXPECT_EQ(files("gts").at(file).find("BUFR"), 41U);
  EXPECT_EQ(read("gts", file).observations.values, read("plain", file).observations.values);
}

TEST_F(SynthCommand, MistakesAreNamedWithTheRemedy) {
  const Outcome satellite = synth("a", {"--satellite", "NOAA-51"});
  EXPECT_EQ(satellite.exit_status, 2);
  for (const char* part : {"NOAA-51", "NOAA-15", "Metop-C", "Aqua"})
    EXPECT_NE(satellite.errors.find(part), std::string::npos) << satellite.errors;

  const Outcome begin = synth("a", {"--begin", "yesterday"});
  EXPECT_EQ(begin.exit_status, 2);
  EXPECT_NE(begin.errors.find("yesterday"), std::string::npos);

  for (const char* dead : {"NOAA-16", "NOAA-16:0", "NOAA-16:16", "NOAA-16:x", "NOAA-99:4", "NOAA-16:-1"})
    EXPECT_EQ(synth("a", {"--dead-channel", dead}).exit_status, 2) << dead;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a"));  // found before anything was written

  EXPECT_THROW(synth("a", {"--duration-minutes", "0"}), CLI::ValidationError);
}

TEST_F(SynthCommand, AFolderThatCannotBeMadeIsNamed) {
  std::ofstream(folder_ / "file") << "in the way";
  const Outcome outcome = synth("file/below", {"--duration-minutes", "1"});
  EXPECT_NE(outcome.exit_status, 0);
  EXPECT_NE(outcome.errors.find("file/below"), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace thin
