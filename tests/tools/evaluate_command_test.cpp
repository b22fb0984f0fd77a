#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "libthin/tools/commands.h"
#include "libthin/tools/evaluation_settings.h"

namespace thin {
namespace {

constexpr const char* kSmall = R"(
[synthetic]
source = "orbits"
count = 1500
[evaluate]
counts = [60, 150]
level = 5
methods = ["box", "stepwise"]
list_boxes = true
[[evaluate.variant]]
label = "removal, lazy"
method = "eea"
update = "lazy"
[[evaluate.variant]]
method = "grid_top_down_eea"
level = 4
)";

class EvaluateCommand : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "thin-evaluate-XXXXXX").string();
    ASSERT_TRUE(::mkdtemp(pattern.data()));
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  int evaluate(const std::string& configuration, std::vector<std::string> words) {
    std::ofstream(folder_ / "c.toml") << configuration;
    words.insert(words.begin(), {"evaluate", "-c", path("c.toml")});
    CLI::App program("thin");
    Action action;
    add_evaluate_command(program, action);
    program.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes the words from the back
    testing::internal::CaptureStdout();
    const int code = action();
    output_ = testing::internal::GetCapturedStdout();
    return code;
  }

  std::filesystem::path folder_;
  std::string output_;
};

TEST_F(EvaluateCommand, WritesATableAndFiles) {
  ASSERT_EQ(evaluate(kSmall, {"--json", path("r.json"), "--csv", path("r.csv"), "--costs", path("c.csv")}), 0);
  for (const char* label : {"box", "stepwise", "removal, lazy", "grid_top_down_eea"})
    EXPECT_NE(output_.find(label), std::string::npos) << output_;

  const auto json = nlohmann::json::parse(read("r.json"));
  EXPECT_EQ(json["observations"]["count"], 1500);
  ASSERT_EQ(json["variants"].size(), 4U);
  EXPECT_EQ(json["variants"][0]["label"], "removal, lazy");
  EXPECT_EQ(json["variants"][0]["options"]["update"], "\"lazy\"");
  EXPECT_EQ(json["variants"][0]["options"]["bandwidth_km"], "100");  // the common one
  EXPECT_EQ(json["variants"][1]["options"]["level"], "4");
  ASSERT_EQ(json["results"].size(), 8U);
  EXPECT_EQ(json["results"][0]["retained"], 60);
  EXPECT_GT(json["results"][0]["error_on_grid"]["mean_squared_k2"], 0);
  EXPECT_FALSE(json["results"][0]["boxes"]["difference"].empty());
  EXPECT_FALSE(json["results"][7].contains("boxes"));  // stepwise is the reference

  const std::string csv = read("r.csv"), costs = read("c.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 9);
  EXPECT_EQ(std::count(costs.begin(), costs.end(), '\n'), 9);
  EXPECT_NE(csv.find("\"removal, lazy\",60,60,"), std::string::npos) << csv;
}

TEST_F(EvaluateCommand, ResultsDependNeitherOnThreadsNorOnTheOrderOfTheInput) {
  ASSERT_EQ(evaluate(kSmall + std::string("[run]\nthreads = 1\n"), {"--json", path("1.json"), "--csv", path("1.csv")}),
            0);
  ASSERT_EQ(evaluate(kSmall + std::string("[run]\nthreads = 2\n"),
                     {"--json", path("2.json"), "--csv", path("2.csv"), "--shuffle", "7"}),
            0);
  EXPECT_EQ(read("1.json"), read("2.json"));
  EXPECT_EQ(read("1.csv"), read("2.csv"));
}

TEST_F(EvaluateCommand, AsksForEitherFilesOrASource) {
  EXPECT_EQ(evaluate("[evaluate]\n", {}), 2);
  EXPECT_EQ(evaluate(kSmall, {"some.bufr"}), 2);
}

// What reading it says; empty where all is well.
std::string problems(const std::string& text) {
  auto configuration = Configuration::parse(text, "c.toml");
  EXPECT_TRUE(configuration);
  const auto settings = read_evaluation_settings(std::move(*configuration));
  return settings ? "" : settings.error().message;
}

TEST(EvaluationSettings, WithoutAnythingEveryMethodIsCompared) {
  const auto settings = read_evaluation_settings(Configuration::parse("", "c.toml").value());
  ASSERT_TRUE(settings);
  ASSERT_EQ(settings->variants.size(), thinning_methods().size());
  for (std::size_t i = 0; i < settings->variants.size(); ++i)
    EXPECT_EQ(settings->variants[i].label, thinning_methods()[i].name);
}

TEST(EvaluationSettings, AVariantTakesTheCommonBandwidthUnlessItSaysOtherwise) {
  const auto settings = read_evaluation_settings(Configuration::parse("[evaluate]\nbandwidth_km = 70\n"
                                                                      "[[evaluate.variant]]\nmethod = 'eea'\n"
                                                                      "[[evaluate.variant]]\nlabel = 'own'\n"
                                                                      "method = 'eea'\nbandwidth_km = 50\n"
                                                                      "[[evaluate.variant]]\nlabel = 'rule'\n"
                                                                      "method = 'eea'\nbandwidth = 'auto'\n",
                                                                      "c.toml")
                                                     .value());
  ASSERT_TRUE(settings) << settings.error().message;
  const auto bandwidth = [&](std::size_t i) {
    return settings->variants[i].options.find("bandwidth_km")->current_value();
  };
  EXPECT_EQ(bandwidth(0), "70");
  EXPECT_EQ(bandwidth(1), "50");
  EXPECT_EQ(bandwidth(2), "unset");
}

TEST(EvaluationSettings, NamesWhatIsWrong) {
  EXPECT_EQ(problems("[evaluate]\nmethods = ['eea', 'grid_eae']\n"),
            "c.toml:2:11: evaluate.methods = \"grid_eae\" is not a method; did you mean \"grid_eea\"?");
  EXPECT_EQ(problems("[[evaluate.variant]]\nmethod = 'ea'\n"),
            "c.toml:2:10: evaluate.variant[0].method = \"ea\" is not a method; did you mean \"eea\"?");
  EXPECT_EQ(problems("[[evaluate.variant]]\nmethod = 'eea'\nretain_count = 5\n").rfind("c.toml:3:1: unknown key", 0),
            0U);
  EXPECT_EQ(problems("[[evaluate.variant]]\nmethod = 'box'\nfit = 'mesh'\n"),
            "c.toml:3:7: evaluate.variant[0].fit = \"mesh\" is no option of box");
  EXPECT_EQ(problems("[evaluate]\nmethods = ['eea', 'eea']\n"),
            "c.toml:2:11: evaluate.methods and [[evaluate.variant]] give two variants the label \"eea\"; set label");
  EXPECT_EQ(problems("[evaluate.variant]\nmethod = 'eea'\n"),
            "c.toml:1:11: evaluate.variant is a list of sections: write [[evaluate.variant]]");
}

// In any order of the observations, and the same with the share in the configuration.
TEST_F(EvaluateCommand, CrossValidates) {
  const std::string draws = "withhold_draws = 2\nwithhold_lengths_km = [200.0, 400.0]\nwithhold_error_ratios = [1.0]\n";
  std::string configuration = kSmall;
  configuration.insert(configuration.find("methods ="), draws);
  ASSERT_EQ(evaluate(configuration, {"--withhold", "0.25", "--json", path("a.json")}), 0);
  EXPECT_NE(output_.find("farthest_point"), std::string::npos) << output_;
  ASSERT_EQ(evaluate(configuration, {"--withhold", "0.25", "--json", path("b.json"), "--shuffle", "3"}), 0);
  EXPECT_EQ(read("a.json"), read("b.json"));
  configuration.insert(configuration.find("methods ="), "withhold = 0.25\n");
  ASSERT_EQ(evaluate(configuration, {"--json", path("c.json")}), 0);
  EXPECT_EQ(read("a.json"), read("c.json"));

  const auto json = nlohmann::json::parse(read("a.json"));
  EXPECT_EQ(json["observations"]["withheld"], 375);
  EXPECT_EQ(json["observations"]["thinned"], 1125);
  EXPECT_EQ(json["observations"]["channels"].size(), 8U);
  EXPECT_EQ(json["scores"][0]["set"], "all");
  EXPECT_EQ(json["scores"][0]["relative_rms"].size(), 2U);
  // all, and two sets and four variants to two numbers; each channel alone, then of all jointly each and the mean.
  EXPECT_EQ(json["scores"].size(), (1 + 2 * 2 + 4 * 2) * (8 + 9));
}

}  // namespace
}  // namespace thin
