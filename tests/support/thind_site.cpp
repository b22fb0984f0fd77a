#include "tests/support/thind_site.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

namespace thin::test {

namespace fs = std::filesystem;

bool wait_until(const std::function<bool()>& condition, std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "thind-test-XXXXXX").string();
  path_ = ::mkdtemp(pattern.data());
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_content(const fs::path& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file << content;
}

std::map<std::string, std::string> files_below(const fs::path& folder) {
  std::map<std::string, std::string> files;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file()) files[fs::relative(entry->path(), folder).string()] = content_of(entry->path());
  return files;
}

Process::Process(const std::vector<std::string>& arguments, const fs::path& output) {
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  number_ = ::fork();
  if (number_ != 0) return;
  const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  ::dup2(file, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
  ::execv(pointers[0], pointers.data());
  ::_exit(127);
}

Process::Process(Process&& other) noexcept : number_(other.number_), status_(other.status_) {
  other.number_ = -1;
}

Process::~Process() {
  if (number_ < 0 || has_ended()) return;
  signal(SIGKILL);
  ::waitpid(number_, nullptr, 0);
}

void Process::signal(int signal) const {
  ::kill(number_, signal);
}

bool Process::has_ended() {
  int status = 0;
  if (!status_ && ::waitpid(number_, &status, WNOHANG) == number_)
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  return status_.has_value();
}

int Process::wait() {
  if (!wait_until([&] { return has_ended(); })) {
    ADD_FAILURE() << "process " << number_ << " does not end";
    signal(SIGKILL);
    wait_until([&] { return has_ended(); });
  }
  return status_.value_or(-1);
}

Site::Site(const std::string& worker) {
  for (const char* folder : {"inbox", "outbox"}) fs::create_directories(path(folder));
  daemon = {{"root", "\".\""},         {"worker", "\"" + worker + "\""}, {"settle_seconds", "0.05"},
            {"retry_seconds", "0.05"}, {"rescan_seconds", "0.2"},        {"worker_memory_megabytes", "0"}};
  window = {{"quiet_seconds", "0.1"}};
}

void Site::write_config() const {
  std::ostringstream text;
  text << "[daemon]\n";
  for (const auto& [key, value] : daemon) text << key << " = " << value << "\n";
  text << "[window]\n";
  for (const auto& [key, value] : window) text << key << " = " << value << "\n";
  write_content(path("thind.toml"), text.str() + rest);
}

void Site::deliver(const std::string& name, const std::string& content) const {
  write_content(path("inbox/." + name), content);
  fs::rename(path("inbox/." + name), path("inbox/" + name));
}

Process Site::start(const std::vector<std::string>& options) const {
  write_config();
  std::vector<std::string> arguments = {THIND_PROGRAM, "-c", path("thind.toml").string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return {arguments, path("log")};
}

nlohmann::json Site::status() const {
  const std::string output = path("status").string();
  fs::remove(output);
  std::vector<std::string> arguments = {THIND_PROGRAM, "-c", path("thind.toml").string(), "--status", "--json"};
  Process(arguments, output).wait();
  const nlohmann::json said = nlohmann::json::parse(content_of(output), nullptr, false);
  return said.is_object() ? said : nlohmann::json();
}

int Site::file_count(const char* key) const {
  const nlohmann::json now = status();
  return now.is_object() && now.contains("files") ? now["files"].value(key, -1) : -1;
}

int Site::in_state(const std::string& state) const {
  const nlohmann::json now = status();
  return now.is_object() && now.contains("files") ? now["files"]["in_state"].value(state, -1) : -1;
}

int Site::published() const {
  return file_count("published");
}
int Site::quarantined() const {
  return file_count("quarantined");
}
int Site::pending() const {
  return file_count("pending");
}

bool Site::consistent() const {
  const nlohmann::json now = status();
  return now.is_object() && now.contains("files") && now["files"]["balanced"].get<bool>() && now["missing"].empty();
}

}  // namespace thin::test
