#include "libthin/foundation/configuration.h"

#include <gtest/gtest.h>

namespace thin {
namespace {

enum class Mode { fast, careful };

struct Sample {
  bool flag = false;
  int count = 3;
  double size_km = 75;
  std::string label = "none";
  std::optional<double> limit;
  std::vector<int> channels;
  std::vector<double> factors = {1.5};
  Mode mode = Mode::fast;
  OptionTable table;

  Sample() {
    table.add("flag", flag, {.explanation = "a flag"});
    table.add("count", count, {.minimum = 1, .maximum = 9});
    table.add("size_km", size_km, {.unit = "km", .above = 0});
    table.add("label", label, {});
    table.add("limit", limit, {.unit = "K", .minimum = 0});
    table.add("channels", channels, {.minimum = 1, .maximum = 15});
    table.add("factors", factors, {});
    table.add_choice("mode", mode,
                     std::vector<std::pair<std::string, Mode>>{{"fast", Mode::fast}, {"careful", Mode::careful}}, {});
  }
  Sample(const Sample&) = delete;
};

// What reading `text` as [sample] says; empty where all is well.
std::string problems(const std::string& text, Sample& sample) {
  Result<Configuration> file = Configuration::parse(text, "c.toml");
  if (!file) return file.error().message;
  file->read_section("sample", sample.table);
  const Result<void> done = file->finish();
  return done ? "" : done.error().message;
}

std::string problems(const std::string& text) {
  Sample sample;
  return problems(text, sample);
}

TEST(Configuration, StoresWhatIsThereAndLeavesTheRest) {
  Sample sample;
  EXPECT_EQ(
      problems("[sample]\nflag = true\ncount = 5\nsize_km = 100\nlimit = 0.5\nchannels = [5, 6]\nfactors = [1, 2.5]\n"
               "mode = 'careful'\n",
               sample),
      "");
  EXPECT_TRUE(sample.flag);
  EXPECT_EQ(sample.count, 5);
  EXPECT_EQ(sample.size_km, 100);
  EXPECT_EQ(sample.label, "none");
  EXPECT_EQ(sample.limit, 0.5);
  EXPECT_EQ(sample.channels, (std::vector<int>{5, 6}));
  EXPECT_EQ(sample.factors, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(sample.mode, Mode::careful);
}

TEST(Configuration, AnEmptyFileIsAllDefaults) {
  EXPECT_EQ(problems(""), "");
}

TEST(Configuration, NamesFileLineAndWhatWasMeant) {
  EXPECT_EQ(problems("[sample]\n\ncuont = 5\n"),
            "c.toml:3:1: unknown key \"cuont\" in [sample]; did you mean \"count\"?");
  EXPECT_EQ(problems("[smaple]\n"), "c.toml:1:2: unknown section [smaple]; did you mean [sample]?");
  EXPECT_EQ(problems("[sample]\nxyzzy_plugh = 1\n").substr(0, 67),
            "c.toml:2:1: unknown key \"xyzzy_plugh\" in [sample]; known are flag, ");
}

TEST(Configuration, NamesTheValueAndTheLimit) {
  EXPECT_EQ(problems("[sample]\ncount = 10\n"), "c.toml:2:9: sample.count must be at most 9, not 10");
  EXPECT_EQ(problems("[sample]\nsize_km = 0\n"), "c.toml:2:11: sample.size_km must be greater than 0 km, not 0");
  EXPECT_EQ(problems("[sample]\ncount = 'five'\n"), "c.toml:2:9: sample.count must be an integer, not text");
  EXPECT_EQ(problems("[sample]\nmode = 'slow'\n"),
            "c.toml:2:8: sample.mode must be one of fast, careful, not \"slow\"");
  EXPECT_EQ(problems("[sample]\nchannels = [5, 16]\n"),
            "c.toml:2:12: sample.channels element 2 must be at most 15, not 16");
  EXPECT_EQ(problems("[sample]\nsize_km = nan\n"), "c.toml:2:11: sample.size_km must be a finite number, not nan");
}

TEST(Configuration, ReportsAllProblemsInTheOrderOfTheFile) {
  EXPECT_EQ(problems("stray = 1\n[sample]\nflag = 1\ncount = 0\n"),
            "c.toml:1:1: \"stray\" stands outside of any section as a integer; sections are [sample]\n"
            "c.toml:3:8: sample.flag must be true or false, not an integer\n"
            "c.toml:4:9: sample.count must be at least 1, not 0");
}

TEST(Configuration, BrokenTomlNamesItsLine) {
  const Result<Configuration> file = Configuration::parse("[sample]\ncount = = 5\n", "c.toml");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::configuration);
  EXPECT_EQ(file.error().message.substr(0, 9), "c.toml:2:");
}

TEST(Configuration, AMissingFileIsAConfigurationError) {
  const Result<Configuration> file = Configuration::read("/nowhere/c.toml");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::configuration);
  EXPECT_NE(file.error().message.find("/nowhere/c.toml: No such file"), std::string::npos) << file.error().message;
  EXPECT_FALSE(Configuration::read("/tmp"));
}

TEST(Configuration, CanonicalTextForgetsLayout) {
  const auto a = Configuration::parse("[sample]\ncount = 5\nflag = true\n", "a");
  const auto b = Configuration::parse("# hello\n[sample]\nflag    = true # yes\ncount=5\n", "b");
  EXPECT_EQ(a->canonical_text(), b->canonical_text());
}

TEST(Options, KnowTheirDefaults) {
  Sample sample;
  sample.count = 7;
  EXPECT_EQ(sample.table.find("count")->default_value, "3");
  EXPECT_EQ(sample.table.find("count")->current_value(), "7");
  EXPECT_EQ(sample.table.find("limit")->default_value, "unset");
  EXPECT_EQ(sample.table.find("mode")->default_value, "\"fast\"");
  EXPECT_EQ(sample.table.find("factors")->default_value, "[1.5]");
}

TEST(Configuration, ListsOfSectionsAreReadOneByOne) {
  const std::string text = "[group]\ncount = 2\n[[group.part]]\ncount = 4\n[[group.part]]\ncoutn = 5\n";
  Result<Configuration> file = Configuration::parse(text, "c.toml");
  ASSERT_TRUE(file);
  ASSERT_EQ(file->list_size("group.part"), 2U);
  EXPECT_EQ(file->list_size("group.other"), 0U);
  Sample group, first, second;
  file->read_section("group", group.table);
  file->read_section("group.part[0]", first.table);
  file->read_section("group.part[1]", second.table);
  EXPECT_EQ(group.count, 2);
  EXPECT_EQ(first.count, 4);
  EXPECT_EQ(second.count, 3);
  const Result<void> done = file->finish();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "c.toml:6:1: unknown key \"coutn\" in [group.part[1]]; did you mean \"count\"?");
}

TEST(Options, ATableWithoutSomeLeavesTheRestOfTheSameFields) {
  Sample sample;
  const OptionTable rest = sample.table.without({"flag", "size_km"});
  EXPECT_EQ(rest.options().size(), sample.table.options().size() - 2);
  EXPECT_EQ(rest.find("flag"), nullptr);
  EXPECT_FALSE(rest.find("count")->assign(OptionValue(std::int64_t{7})));
  EXPECT_EQ(sample.count, 7);
}

TEST(Options, PhrasesHaveAGrammarOfTheirOwn) {
  std::vector<std::string> phrases = {"3"};
  OptionTable table;
  table.add_phrases("edges", phrases, {}, [](const std::vector<std::string>& list) -> std::optional<std::string> {
    return list.size() > 2 ? std::optional<std::string>("is too long") : std::nullopt;
  });
  const auto read = [&](const std::string& text) {
    auto file = Configuration::parse("[sample]\nedges = " + text + "\n", "c.toml");
    file->read_section("sample", table);
    const Result<void> good = file->finish();
    return good ? table.find("edges")->current_value() : good.error().message;
  };
  EXPECT_EQ(read("5"), "[5]");
  EXPECT_EQ(read("\"mhs 9\""), "[\"mhs 9\"]");
  EXPECT_EQ(read("[1, 2]"), "[1, 2]");
  EXPECT_EQ(read("[\"1\", \"mhs 9\"]"), "[1, \"mhs 9\"]");
  EXPECT_EQ(read("[1, 2, 3]"), "c.toml:2:9: sample.edges is too long");
  EXPECT_EQ(read("[1.5]"), "c.toml:2:9: sample.edges must be a list of texts or integers, not a list of numbers");
  EXPECT_EQ(phrases, (std::vector<std::string>{"1", "mhs 9"})) << "what was good last";
}

TEST(Options, TextsAreTakenApartWhole) {
  EXPECT_EQ(words_of("  amsua 5, 6\t7 "), (std::vector<std::string>{"amsua", "5", "6", "7"}));
  EXPECT_TRUE(words_of(" , ").empty());
  EXPECT_EQ(whole_number("-12"), -12);
  EXPECT_EQ(finite_number("1.5e-3"), 1.5e-3);
  for (const char* text : {"", "1x", " 1", "x"}) EXPECT_FALSE(whole_number(text)) << text;
  for (const char* text : {"", "1.5K", "inf", "nan"}) EXPECT_FALSE(finite_number(text)) << text;
}

}  // namespace
}  // namespace thin
