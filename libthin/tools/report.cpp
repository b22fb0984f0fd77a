#include "libthin/tools/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "libthin/foundation/version.h"
#include "libthin/observations/platforms.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

using Json = nlohmann::ordered_json;

Json time_json(const std::optional<std::int64_t>& time_ms) {
  return time_ms ? Json(to_iso8601(*time_ms)) : Json();
}

Json error_json(const EstimationError& error, const std::vector<int>& channels) {
  Json rms;
  for (std::size_t c = 0; c < channels.size(); ++c)
    rms[std::to_string(channels[c])] = std::sqrt(error.per_channel_k2[c]);
  return {{"mean_squared_k2", error.mean_squared_k2},
          {"of_retaining_nothing_k2", error.empty_mean_squared_k2},
          {"evaluation_points", error.evaluation_point_count},
          {"rms_k_by_channel", rms}};
}

Json platform_json(std::int32_t platform, const PlatformTally& tally, const WindowOutcome& outcome) {
  Json screened = Json::object();
  for (const auto& [reason, count] : tally.screened) screened[name_of(reason)] = count;
  const auto retained = outcome.retained_by_platform.find(platform);
  Json json = {{"number", platform},
               {"name", platform_name(platform)},
               {"observations", tally.observations},
               {"screened", screened},
               {"prepared", tally.prepared},
               {"retained", retained == outcome.retained_by_platform.end() ? 0 : retained->second}};
  const auto error = outcome.error.platforms.find(platform);
  if (error != outcome.error.platforms.end())
    json["estimation_error"] = error_json(error->second, outcome.prepared.observations.channels);
  return json;
}

Json file_json(const FileOutcome& file) {
  Json json = {{"name", file.name}, {"observations", file.observations}, {"retained", file.retained}};
  json["output"] =
      file.output.messages == 0
          ? Json()
          : Json{{"messages", file.output.messages}, {"subsets", file.output.subsets}, {"bytes", file.output.bytes}};
  if (!file.notes.empty()) json["notes"] = file.notes;
  for (const SkippedPart& part : file.skipped)
    json["skipped"].push_back({{"message", part.message}, {"offset", part.offset}, {"reason", part.reason}});
  return json;
}

double rms_k(const EstimationError& error) {
  const auto channels = static_cast<double>(error.per_channel_k2.size());
  return channels > 0 ? std::sqrt(error.mean_squared_k2 / channels) : 0;
}

std::string table_row(const std::string& name, std::size_t observations, std::size_t screened, std::size_t retained,
                      const EstimationError& error) {
  const double share = error.empty_mean_squared_k2 > 0 ? error.mean_squared_k2 / error.empty_mean_squared_k2 : 0;
  return fmt::format("{:<14} {:>12} {:>9} {:>9} {:>12.4f} {:>10.4f} {:>9.1f}\n", name, observations, screened, retained,
                     error.mean_squared_k2, rms_k(error), 100 * share);
}

}  // namespace

std::string report_json(const WindowOutcome& outcome, const Settings& settings) {
  const ObservationSet& prepared = outcome.prepared.observations;
  Json json = {{"program", "thin"}, {"version", kVersion}};
  json["window"] = {{"begin", time_json(outcome.window.begin_ms)}, {"end", time_json(outcome.window.end_ms)}};
  for (const auto& [name, value] : settings.resolved) json["configuration"][name] = value;
  json["observations"] = {{"outside_window", outcome.prepared.outside_window},
                          {"prepared", prepared.size()},
                          {"retained", outcome.retained.size()}};
  json["channels"] = prepared.channels;
  json["values"] = prepared.value_kind == ValueKind::innovation ? "innovations" : "brightness temperatures";
  json["estimation_error"] = error_json(outcome.error.whole, prepared.channels);
  json["estimation_error"]["bandwidth_km"] = outcome.error.bandwidth_km;
  json["estimation_error"]["gme_level"] = outcome.error.level;
  json["satellites"] = Json::array();
  for (const auto& [platform, tally] : outcome.prepared.platforms)
    json["satellites"].push_back(platform_json(platform, tally, outcome));
  json["files"] = Json::array();
  for (const FileOutcome& file : outcome.files) json["files"].push_back(file_json(file));
  json["refused"] = Json::array();
  for (const RefusedFile& file : outcome.refused)
    json["refused"].push_back({{"name", file.name}, {"reason", file.reason}});
  json["notes"] = outcome.prepared.notes;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string report_table(const WindowOutcome& outcome) {
  std::string table = fmt::format("{:<14} {:>12} {:>9} {:>9} {:>12} {:>10} {:>9}\n", "satellite", "observations",
                                  "screened", "retained", "E, K^2", "rms, K", "lost, %");
  std::size_t observations = 0, prepared = 0;
  for (const auto& [platform, tally] : outcome.prepared.platforms) {
    observations += tally.observations;
    prepared += tally.prepared;
    const auto retained = outcome.retained_by_platform.find(platform);
    const auto error = outcome.error.platforms.find(platform);
    table += table_row(platform_name(platform), tally.observations, tally.observations - tally.prepared,
                       retained == outcome.retained_by_platform.end() ? 0 : retained->second,
                       error == outcome.error.platforms.end() ? EstimationError{} : error->second);
  }
  table += table_row("all", observations, observations - prepared, outcome.retained.size(), outcome.error.whole);
  table += fmt::format(
      "E: mean squared difference of the Gaussian estimates (h = {:g} km) from the prepared and the "
      "retained, over channels {}; lost: its share of the E of retaining nothing\n",
      outcome.error.bandwidth_km, fmt::join(outcome.prepared.observations.channels, " "));
  table += "seconds:";
  for (const auto& [step, seconds] : outcome.seconds) table += fmt::format("  {} {:.3f}", step, seconds);
  return table + "\n";
}

}  // namespace thin
