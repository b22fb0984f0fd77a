#include "daemon/publication.h"

#include <gtest/gtest.h>

#include "tests/support/thind_site.h"

namespace thind {
namespace {

using thin::test::content_of;
using thin::test::files_below;
using thin::test::write_content;

class PublicationTest : public testing::Test {
 protected:
  PublicationTest() {
    std::filesystem::create_directory(outbox());
    report_.outputs = {{"a.bufr", 3, 1}};
    report_.report = "report.json";
    make();
  }
  std::string outbox() const { return (folder_.path() / "outbox").string(); }
  std::string made() const { return outbox() + "/.tmp-made"; }
  void make(const std::string& content = "aaa") const {
    std::filesystem::create_directory(made());
    write_content(made() + "/a.bufr", content);
    write_content(made() + "/report.json", "{}");
  }
  static std::string name(int version) { return "window.v" + std::to_string(version); }
  std::map<std::string, std::string> published() const { return files_below(outbox()); }

  thin::test::TemporaryFolder folder_;
  WindowReport report_;
};

TEST_F(PublicationTest, AcceptsExactlyWhatIsReported) {
  EXPECT_TRUE(validate_outputs(made(), report_));
}

TEST_F(PublicationTest, RefusesAMissingOutput) {
  std::filesystem::remove(made() + "/a.bufr");
  EXPECT_NE(validate_outputs(made(), report_).error().message.find("a.bufr is missing"), std::string::npos);
}

TEST_F(PublicationTest, RefusesAnotherSize) {
  write_content(made() + "/a.bufr", "aaaa");
  EXPECT_NE(validate_outputs(made(), report_).error().message.find("has 4 bytes, not 3"), std::string::npos);
}

TEST_F(PublicationTest, RefusesWhatIsNotListed) {
  write_content(made() + "/b.bufr", "");
  EXPECT_NE(validate_outputs(made(), report_).error().message.find("b.bufr is not listed"), std::string::npos);
}

TEST_F(PublicationTest, RefusesLinksAndFolders) {
  std::filesystem::remove(made() + "/a.bufr");
  std::filesystem::create_symlink("/etc/passwd", made() + "/a.bufr");
  EXPECT_NE(validate_outputs(made(), report_).error().message.find("is no file"), std::string::npos);
}

TEST_F(PublicationTest, RefusesAMissingReport) {
  std::filesystem::remove(made() + "/report.json");
  EXPECT_FALSE(validate_outputs(made(), report_));
  report_.report.clear();
  EXPECT_FALSE(validate_outputs(made(), report_));
}

TEST_F(PublicationTest, AFolderAppearsUnderItsName) {
  EXPECT_EQ(*publish_folder(made(), outbox(), 1, name), 1);
  EXPECT_EQ(published(),
            (std::map<std::string, std::string>{{"window.v1/a.bufr", "aaa"}, {"window.v1/report.json", "{}"}}));
}

TEST_F(PublicationTest, TheSameAgainIsTheSame) {
  ASSERT_TRUE(publish_folder(made(), outbox(), 1, name));
  const auto before = published();
  make();
  EXPECT_EQ(*publish_folder(made(), outbox(), 1, name), 1);
  EXPECT_EQ(published(), before);
}

TEST_F(PublicationTest, WhatWasPublishedIsNeverReplaced) {
  ASSERT_TRUE(publish_folder(made(), outbox(), 1, name));
  make("bbb");
  EXPECT_EQ(*publish_folder(made(), outbox(), 1, name), 2);
  EXPECT_EQ(published().at("window.v1/a.bufr"), "aaa");
  EXPECT_EQ(published().at("window.v2/a.bufr"), "bbb");
}

TEST_F(PublicationTest, AFileAppearsWithItsReport) {
  EXPECT_EQ(*publish_file(made(), outbox(), report_), "a.bufr");
  EXPECT_EQ(published(), (std::map<std::string, std::string>{{"a.bufr", "aaa"}, {"reports/a.bufr.json", "{}"}}));
  make();
  EXPECT_EQ(*publish_file(made(), outbox(), report_), "a.bufr") << "again after a crash";
  EXPECT_EQ(published().size(), 2U);
}

TEST_F(PublicationTest, AnotherFileOfTheNameGetsAnother) {
  ASSERT_TRUE(publish_file(made(), outbox(), report_));
  make("bbb");
  const std::string name = *publish_file(made(), outbox(), report_);
  EXPECT_EQ(name, with_hash("a.bufr", sha256_of("bbb")));
  EXPECT_EQ(published().at("a.bufr"), "aaa");
  EXPECT_EQ(published().at(name), "bbb");
  EXPECT_EQ(published().count("reports/" + name + ".json"), 1U);
}

}  // namespace
}  // namespace thind
