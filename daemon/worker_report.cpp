#include "daemon/worker_report.h"

#include <fmt/format.h>
#include <signal.h>

#include <array>
#include <cstring>
#include <nlohmann/json.hpp>

namespace thind {
namespace {

using Json = nlohmann::json;

constexpr std::array kOutcomes = {"done", "unusable", "incomplete", "temporary", "configuration", "stopped", "failed"};

Json parse_object(const std::string& text) {
  Json body = Json::parse(text, nullptr, false);
  return body.is_object() ? body : Json();
}

std::string text_at(const Json& body, const char* key) {
  const auto found = body.is_object() ? body.find(key) : body.end();
  return body.is_object() && found != body.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) return "";
  const std::size_t begin = text.find_last_of('\n', end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? -1 : begin));
}

Outcome outcome_of(const WorkerExit& exit, const std::string& said) {
  if (exit.stopped || exit.exit_code == 128 + SIGTERM || exit.signal == SIGTERM) return Outcome::stopped;
  if (!exit.exit_code) return Outcome::failed;
  switch (*exit.exit_code) {
    case 0:
      return Outcome::done;
    case 2:
      return Outcome::configuration;
    case 3:
      return Outcome::unusable;
    case 75:
      return said == "incomplete" ? Outcome::incomplete : Outcome::temporary;
    case kExitNotStarted:
      return Outcome::temporary;
    default:
      return Outcome::failed;
  }
}

// Fills in what all reports have in common; returns the body where the worker says that it is done.
Json read_common(WorkerExit exit, WorkerReport& report) {
  Json body = parse_object(exit.output);
  report.outcome = outcome_of(exit, text_at(body, "outcome"));
  report.reason = text_at(body, "reason");
  if (report.outcome != Outcome::done && report.reason.empty()) report.reason = last_line(exit.last_errors);
  if (report.outcome == Outcome::failed || report.reason.empty())
    report.reason = "the worker " + describe(exit) + (report.reason.empty() ? "" : ": " + report.reason);
  if (report.outcome == Outcome::done) report.reason.clear();
  report.exit = std::move(exit);
  return body;
}

void refuse(WorkerReport& report, const std::string& why) {
  report.outcome = Outcome::failed;
  report.reason = "the worker exited with 0, but its report can't be understood: " + why;
}

}  // namespace

const char* name_of(Outcome outcome) {
  return kOutcomes[static_cast<std::size_t>(outcome)];
}

std::string describe(const WorkerExit& exit) {
  if (exit.timed_out) return fmt::format("ran longer than allowed and was ended after {:.1f} s", exit.seconds);
  if (exit.stopped) return "was stopped together with the daemon";
  if (exit.signal) return fmt::format("was ended by signal {} ({})", *exit.signal, ::strsignal(*exit.signal));
  if (exit.exit_code == kExitNotStarted) return "could not be started";
  return fmt::format("exited with {}", exit.exit_code.value_or(-1));
}

IngestReport read_ingest_report(WorkerExit exit) {
  IngestReport report;
  const Json body = read_common(std::move(exit), report);
  if (report.outcome != Outcome::done) return report;
  try {
    report.staged.observations = body.at("observations").get<std::int64_t>();
    report.staged.first_ms = body.at("time_begin_ms").get<std::int64_t>();
    report.staged.last_ms = body.at("time_end_ms").get<std::int64_t>();
    for (const Json& platform : body.at("platforms"))
      report.staged.platforms.push_back(platform.at("number").get<int>());
    if (const auto skipped = body.find("skipped"); skipped != body.end())
      report.skipped = static_cast<std::int64_t>(skipped->size());
    if (report.staged.last_ms < report.staged.first_ms) refuse(report, "its times end before they begin");
    if (report.staged.observations <= 0) refuse(report, "it has no observations");
  } catch (const Json::exception& error) {
    refuse(report, error.what());
  }
  return report;
}

WindowReport read_window_report(WorkerExit exit) {
  WindowReport report;
  const Json body = read_common(std::move(exit), report);
  if (report.outcome != Outcome::done) return report;
  try {
    report.observations = body.at("observations").get<std::int64_t>();
    report.retained = body.at("retained").get<std::int64_t>();
    for (const Json& output : body.at("outputs"))
      report.outputs.push_back({output.at("name").get<std::string>(), output.at("bytes").get<std::int64_t>(),
                                output.value("retained", std::int64_t{0})});
    report.report = body.at("report").get<std::string>();
    report.seconds = body.value("seconds", Json::object()).dump();
  } catch (const Json::exception& error) {
    refuse(report, error.what());
  }
  return report;
}

}  // namespace thind
