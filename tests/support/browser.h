#pragma once

// A real browser without a window: Chromium, told what to do through a pipe (its DevTools protocol,
// --remote-debugging-pipe). Pictures are drawn by its own software renderer; the network is out of its reach.

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace emap::test {

class Browser {
 public:
  // Where the browser is; nothing where this machine has none (Debian's package chromium).
  static std::optional<std::string> installed();

  // further_flags: of the command line. REQUIRES: installed(). Throws std::runtime_error, as all that follows, where
  // the browser does not start or does not answer for 100 seconds.
  explicit Browser(const std::vector<std::string>& further_flags = {});
  ~Browser();
  Browser(const Browser&) = delete;

  // Opens an address in a view of so many pixels and waits until it is loaded.
  void open(const std::string& address, int width, int height);

  // What an expression in JavaScript comes to (a promise: what it is fulfilled with). Throws with the script's own
  // words where the script does.
  nlohmann::json evaluate(const std::string& expression);

  // A command of the protocol, and its result.
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters = nlohmann::json::object());

  // Addresses that the page asked for since it was opened, its own among them.
  std::vector<std::string> addresses_asked_for() const;

 private:
  void start(const std::vector<std::string>& flags);
  void end();
  void send(const std::string& message) const;
  nlohmann::json receive(std::chrono::steady_clock::time_point deadline);
  template <class Accepts>
  nlohmann::json wait_for(const Accepts& accepts);

  std::string profile_;  // folder
  pid_t process_ = -1;
  int to_browser_ = -1, from_browser_ = -1;
  std::string received_;
  std::string session_;
  int last_id_ = 0;
  std::vector<nlohmann::json> events_;
};

std::string base64_of(const std::vector<std::uint8_t>& bytes);
std::vector<std::uint8_t> bytes_of_base64(const std::string& text);

}  // namespace emap::test
