#pragma once

// A place with an inbox and an outbox for tests that run thind itself, and things to wait for. Nothing here sleeps for
// a fixed time: wait_until() looks again and again until a condition holds, or the test fails.

#include <gtest/gtest.h>
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace thin::test {

inline constexpr std::chrono::seconds kPatience{60};

// False where the condition did not come to hold.
bool wait_until(const std::function<bool()>& condition, std::chrono::milliseconds patience = kPatience);

// A folder that is removed with it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string content_of(const std::filesystem::path& path);
void write_content(const std::filesystem::path& path, const std::string& content);

// All files below, by path relative to it, with their content.
std::map<std::string, std::string> files_below(const std::filesystem::path& folder);

// A process that is killed with it.
class Process {
 public:
  Process(const std::vector<std::string>& arguments, const std::filesystem::path& output);
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;
  ~Process();

  pid_t number() const { return number_; }
  void signal(int signal) const;
  bool has_ended();
  // Exit code, or 1000 + signal. Kills it, and fails the test, where it does not end.
  int wait();

 private:
  pid_t number_ = -1;
  std::optional<int> status_;
};

class Site {
 public:
  // worker: path of the program that plays `thin`. The sections are added to a configuration that is quick.
  explicit Site(const std::string& worker);

  std::filesystem::path path(const std::string& name = "") const { return folder_.path() / name; }

  // Replaces keys of [daemon] and [window], or adds them; `rest` are further sections. Takes effect with
  // write_config().
  std::map<std::string, std::string> daemon, window;
  std::string rest;
  void write_config() const;

  // The file appears in the inbox at once, as by a sender who renames.
  void deliver(const std::string& name, const std::string& content) const;

  Process start(const std::vector<std::string>& options = {}) const;
  int run_once() const { return start({"--once"}).wait(); }

  // thind --status --json; null where there is no journal yet.
  nlohmann::json status() const;
  int published() const;
  int quarantined() const;
  int pending() const;
  int in_state(const std::string& state) const;
  // Whether seen = published + quarantined + pending, and all pending files are there.
  bool consistent() const;

  std::map<std::string, std::string> outbox() const { return files_below(path("outbox")); }
  std::string log() const { return content_of(path("log")); }
  bool log_says(const std::string& words) const { return log().find(words) != std::string::npos; }

 private:
  int file_count(const char* key) const;
  TemporaryFolder folder_;
};

}  // namespace thin::test
