#include "tests/support/browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace emap::test {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{100};  // a loaded machine is slow
constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

[[noreturn]] void give_up(const std::string& what) {
  throw std::runtime_error("browser: " + what);
}

std::array<int, 2> new_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) give_up(std::strerror(errno));
  return ends;
}

}  // namespace

std::optional<std::string> Browser::installed() {
  for (const char* path : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"})
    if (::access(path, X_OK) == 0) return path;
  return std::nullopt;
}

Browser::Browser(const std::vector<std::string>& further_flags) {
  std::string pattern = std::filesystem::temp_directory_path() / "emap_browser_XXXXXX";
  if (!::mkdtemp(pattern.data())) give_up(std::strerror(errno));
  profile_ = pattern;
  std::vector<std::string> flags = {installed().value(),
                                    "--headless",
                                    "--no-sandbox",  // root has none
                                    "--disable-dev-shm-usage",
                                    "--no-first-run",
                                    "--disable-background-networking",
                                    "--host-resolver-rules=MAP * ~NOTFOUND",
                                    "--use-angle=swiftshader",
                                    "--enable-unsafe-swiftshader",
                                    "--remote-debugging-pipe",
                                    "--user-data-dir=" + profile_};
  flags.insert(flags.end(), further_flags.begin(), further_flags.end());
  start(flags);
  const json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}})["sessionId"];
  for (const char* domain : {"Page.enable", "Runtime.enable", "Network.enable"}) call(domain);
}

Browser::~Browser() {
  if (process_ > 0) end();
  ::close(to_browser_);
  ::close(from_browser_);
  std::error_code ignored;  // a dying helper process may still write there
  std::filesystem::remove_all(profile_, ignored);
}

// Asked to, it ends its helper processes before itself.
void Browser::end() {
  session_.clear();
  try {
    call("Browser.close");
    wait_for([](const json&) { return false; });
  } catch (const std::runtime_error&) {
    // "it ended", or it hangs: gone it is behind the next line.
  }
  ::kill(-process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void Browser::start(const std::vector<std::string>& flags) {
  ::signal(SIGPIPE, SIG_IGN);  // a browser that died is told of by errno
  const auto [command_out, command_in] = new_pipe();
  const auto [answer_out, answer_in] = new_pipe();
  std::vector<char*> words;
  for (const std::string& flag : flags) words.push_back(const_cast<char*>(flag.c_str()));
  words.push_back(nullptr);
  process_ = ::fork();
  if (process_ < 0) give_up(std::strerror(errno));
  if (process_ == 0) {
    ::setpgid(0, 0);
    // The browser reads commands from 3 and writes answers to 4; neither end may be overwritten on its way there.
    const int commands = ::fcntl(command_out, F_DUPFD, 10), answers = ::fcntl(answer_in, F_DUPFD, 10);
    const int nowhere = ::open("/dev/null", O_RDWR);
    if (::dup2(commands, 3) < 0 || ::dup2(answers, 4) < 0 || ::dup2(nowhere, 1) < 0 || ::dup2(nowhere, 2) < 0)
      ::_exit(126);
    ::close(commands);
    ::close(answers);
    ::execv(words[0], words.data());
    ::_exit(127);
  }
  ::setpgid(process_, process_);
  ::close(command_out);
  ::close(answer_in);
  to_browser_ = command_in;
  from_browser_ = answer_out;
}

void Browser::open(const std::string& address, int width, int height) {
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
  events_.clear();
  call("Page.navigate", {{"url", address}});
  for (const json& event : events_)
    if (event["method"] == "Page.loadEventFired") return;
  wait_for([](const json& message) { return message.value("method", "") == "Page.loadEventFired"; });
}

json Browser::evaluate(const std::string& expression) {
  const json result =
      call("Runtime.evaluate", {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
  if (result.contains("exceptionDetails")) {
    const json& details = result["exceptionDetails"];
    give_up(details.contains("exception") ? details["exception"].value("description", details.dump()) : details.dump());
  }
  return result["result"].value("value", json());
}

json Browser::call(const std::string& method, const json& parameters) {
  const int id = ++last_id_;
  json message = {{"id", id}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  send(message.dump());
  const json answer = wait_for([id](const json& received) { return received.value("id", 0) == id; });
  if (answer.contains("error")) give_up(method + ": " + answer["error"].dump());
  return answer["result"];
}

std::vector<std::string> Browser::addresses_asked_for() const {
  std::vector<std::string> addresses;
  for (const json& event : events_)
    if (event["method"] == "Network.requestWillBeSent") addresses.push_back(event["params"]["request"]["url"]);
  return addresses;
}

// What comes in between is kept as events.
template <class Accepts>
json Browser::wait_for(const Accepts& accepts) {
  const Clock::time_point deadline = Clock::now() + kPatience;
  for (;;) {
    json message = receive(deadline);
    if (message.contains("method")) events_.push_back(message);
    if (accepts(message)) return message;
  }
}

void Browser::send(const std::string& message) const {
  const std::string text = message + '\0';
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = ::write(to_browser_, text.data() + sent, text.size() - sent);
    if (count < 0 && errno != EINTR) give_up(std::strerror(errno));
    if (count > 0) sent += static_cast<std::size_t>(count);
  }
}

json Browser::receive(Clock::time_point deadline) {
  std::size_t searched = 0;
  for (;;) {
    const std::size_t end = received_.find('\0', searched);
    if (end != std::string::npos) {
      json message = json::parse(received_.substr(0, end));
      received_.erase(0, end + 1);
      return message;
    }
    searched = received_.size();
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd waiting{from_browser_, POLLIN, 0};
    if (left <= 0 || ::poll(&waiting, 1, static_cast<int>(left)) == 0) give_up("no answer");
    std::array<char, 1 << 16> buffer;
    const ssize_t count = ::read(from_browser_, buffer.data(), buffer.size());
    if (count == 0) give_up("it ended");
    if (count < 0 && errno != EINTR) give_up(std::strerror(errno));
    if (count > 0) received_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

std::string base64_of(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  std::uint32_t bits = 0;
  int count = 0;
  for (const std::uint8_t byte : bytes) {
    bits = bits << 8 | byte;
    for (count += 8; count >= 6; count -= 6) text += kDigits[bits >> (count - 6) & 63];
  }
  if (count > 0) text += kDigits[bits << (6 - count) & 63];
  while (text.size() % 4 != 0) text += '=';
  return text;
}

std::vector<std::uint8_t> bytes_of_base64(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    const std::size_t digit = kDigits.find(letter);
    if (digit == std::string_view::npos) break;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count));
  }
  return bytes;
}

}  // namespace emap::test
