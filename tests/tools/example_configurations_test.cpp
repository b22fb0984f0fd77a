// Every example in config/ is one that thin takes.

#include <gtest/gtest.h>

#include <filesystem>

#include "libthin/foundation/file_bytes.h"
#include "libthin/tools/preparation_data.h"
#include "libthin/tools/settings.h"

namespace thin {
namespace {

std::vector<std::string> examples() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(PROJECT_FOLDER "/config"))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

// Examples of what a build may not have: they are held to this as soon as it has it.
std::string lacking(const std::string& path) {
  const Result<Configuration> configuration = Configuration::read(path);
  if (!configuration) return "";
  OptionTable output;
  OutputOptions options;
  options.declare(output);
  if (configuration->peek_text("output", "mode") && !output.find("mode")) return "output.mode";
  const std::string method = configuration->peek_text("thinning", "method").value_or("grid_eea");
  return find_thinning_method(method) ? "" : "the method " + method;
}

class ExampleConfiguration : public testing::TestWithParam<std::string> {};

TEST_P(ExampleConfiguration, IsGood) {
  if (const std::string what = lacking(GetParam()); !what.empty()) GTEST_SKIP() << "this build has not " << what;
  const Result<Settings> settings = read_settings(GetParam());
  EXPECT_TRUE(settings) << settings.error().message;
  if (!settings || !std::filesystem::exists(SurfaceOptions().land_sea_mask)) return;
  const auto data = read_preparation_data(settings->preparation);
  EXPECT_TRUE(data) << data.error().message;
}

INSTANTIATE_TEST_SUITE_P(Config, ExampleConfiguration, testing::ValuesIn(examples()), [](const auto& tested) {
  std::string name = std::filesystem::relative(tested.param, PROJECT_FOLDER "/config").replace_extension().string();
  for (char& letter : name)
    if (!std::isalnum(static_cast<unsigned char>(letter))) letter = '_';
  return name;
});

TEST(ExampleBiasFiles, AreGood) {
  PreparationOptions options;
  options.bias.table = PROJECT_FOLDER "/config/bias.csv";
  options.bias.predictors = PROJECT_FOLDER "/config/predictors.csv";
  const auto data = read_preparation_data(options);
  EXPECT_TRUE(data) << data.error().message;
}

}  // namespace
}  // namespace thin
