#include "daemon/settings.h"

#include <gtest/gtest.h>

#include "tests/support/thind_site.h"

namespace thind {
namespace {

class SettingsTest : public testing::Test {
 protected:
  Result<Settings> read(const std::string& text) {
    thin::test::write_content(folder_.path() / "thind.toml", text);
    return read_settings((folder_.path() / "thind.toml").string());
  }
  // All lines of the error, which must be one.
  std::string problems(const std::string& text) {
    const auto settings = read(text);
    EXPECT_FALSE(settings);
    if (settings) return "";
    EXPECT_EQ(settings.error().kind, ErrorKind::configuration);
    return settings.error().message;
  }
  std::string in_folder(const std::string& name) const { return (folder_.path() / name).string(); }

  thin::test::TemporaryFolder folder_;
};

const std::string kWorker = "[daemon]\nworker = \"/bin/true\"\n";

TEST_F(SettingsTest, PathsStartAtTheConfiguration) {
  const auto settings = read(kWorker + "root = \"data\"\ninbox = \"/abs/in/\"\noutbox = \"../out\"\n");
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->daemon.inbox, "/abs/in");
  EXPECT_EQ(settings->daemon.outbox, (folder_.path().parent_path() / "out").string());
  EXPECT_EQ(settings->daemon.archive, in_folder("data/archive"));
  EXPECT_EQ(settings->daemon.state, in_folder("data/state"));
}

TEST_F(SettingsTest, LeavesTheWorkersSectionsAlone) {
  EXPECT_TRUE(read(kWorker + "[thinning]\nmethod = \"no such\"\n[preparation]\nx = 1\n[output]\n[run]\n[input]\n"));
  EXPECT_NE(problems(kWorker + "[thining]\n").find("did you mean [thinning]?"), std::string::npos);
}

TEST_F(SettingsTest, NamesFileLineAndRemedy) {
  const std::string said = problems(kWorker + "settel_seconds = 3\nmax_attempts = 0\n[window]\nlate = \"never\"\n");
  EXPECT_NE(said.find("thind.toml:3:1: unknown key \"settel_seconds\" in [daemon]; did you mean \"settle_seconds\"?"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("thind.toml:4:"), std::string::npos) << said;
  EXPECT_NE(said.find("must be at least 1"), std::string::npos) << said;
  EXPECT_NE(said.find("thind.toml:6:"), std::string::npos) << said;
  EXPECT_NE(said.find("must be one of rethin, separate, drop, not \"never\""), std::string::npos) << said;
}

TEST_F(SettingsTest, FoldersMustDiffer) {
  EXPECT_NE(problems(kWorker + "inbox = \"a\"\noutbox = \"./a/\"\n").find("is the same folder as"), std::string::npos);
}

TEST_F(SettingsTest, TheWorkerMustBeThere) {
  EXPECT_NE(problems("[daemon]\nworker = \"/no/such\"\n").find("is not a program that can be run: /no/such"),
            std::string::npos);
}

TEST_F(SettingsTest, ReadsPlatformsByNameOrNumber) {
  const auto settings = read(kWorker + "[window]\nexpected_platforms = [\"metop-b\", \"223\"]\n");
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->window.expected_platform_numbers, (std::set<int>{3, 223}));
  EXPECT_NE(problems(kWorker + "[window]\nexpected_platforms = [\"Sputnik\"]\n").find("Sputnik"), std::string::npos);
}

TEST_F(SettingsTest, ReadsTheWindowGrid) {
  const auto settings = read(kWorker + "[window]\nlength_minutes = 360\nanchor_minutes = -180\ncutoff_minutes = 1.5\n");
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->window.grid().length_ms, 360 * 60'000);
  EXPECT_EQ(settings->window.grid().anchor_ms, -180 * 60'000);
  EXPECT_EQ(settings->window.closing_rule().cutoff_ms, 90'000);
}

TEST_F(SettingsTest, SaysWhatCannotChangeWhileItRuns) {
  const auto one = read(kWorker), same = read(kWorker + "settle_seconds = 9\n"),
             other = read(kWorker + "outbox = \"elsewhere\"\n");
  ASSERT_TRUE(one && same && other);
  EXPECT_FALSE(unchangeable_difference(*one, *same));
  EXPECT_NE(unchangeable_difference(*one, *other).value_or("").find("daemon.outbox"), std::string::npos);
}

// docs/operations.md has one row per option; where this fails, the rows to put there are in the message.
TEST_F(SettingsTest, TheDocumentationHasEveryOption) {
  const std::string documentation = thin::test::content_of(PROJECT_FOLDER "/docs/operations.md");
  Settings settings;
  thin::OptionTable daemon, window;
  settings.daemon.declare(daemon);
  settings.window.declare(window);
  for (const thin::OptionTable* table : {&daemon, &window})
    for (const thin::Option& option : table->options()) {
      const bool derived = option.default_value == "\"\"" || option.default_value == "unset";
      std::string choices;
      for (const std::string& choice : option.facts.choices) choices += (choices.empty() ? "; one of " : ", ") + choice;
      const std::string row = "| `" + option.name + "` | " + (derived ? "" : "`" + option.default_value + "`") + " | " +
                              option.facts.unit + " | " + option.facts.explanation + choices + " |\n";
      EXPECT_NE(documentation.find(row), std::string::npos) << row;
    }
}

TEST_F(SettingsTest, AMissingFileIsAConfigurationError) {
  const auto settings = read_settings(in_folder("nothing.toml"));
  ASSERT_FALSE(settings);
  EXPECT_EQ(settings.error().kind, ErrorKind::configuration);
  EXPECT_NE(settings.error().message.find("nothing.toml"), std::string::npos);
}

}  // namespace
}  // namespace thind
