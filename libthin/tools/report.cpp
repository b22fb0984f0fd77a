#include "libthin/tools/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "libthin/foundation/version.h"
#include "libthin/observations/instruments.h"
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

std::size_t retained_of(const WindowOutcome& outcome, const Sounder& sounder) {
  const auto found = outcome.retained_by_sounder.find(sounder);
  return found == outcome.retained_by_sounder.end() ? 0 : found->second;
}

// The error of one sounder; nothing where none of its observations was thinned.
const EstimationError* error_of(const WindowOutcome& outcome, const Sounder& sounder) {
  const auto instrument = outcome.errors.find(sounder.second);
  if (instrument == outcome.errors.end()) return nullptr;
  const auto platform = instrument->second.platforms.find(sounder.first);
  return platform == instrument->second.platforms.end() ? nullptr : &platform->second;
}

// The channels of an instrument that are thinned by.
std::vector<int> channels_of(const WindowOutcome& outcome, Instrument instrument) {
  const ObservationSet& set = outcome.prepared.observations;
  std::vector<int> channels;
  for (std::size_t place = 0; place < set.channel_count(); ++place)
    if (set.channel_instrument.empty() || set.channel_instrument[place] == instrument)
      channels.push_back(set.channels[place]);
  return channels;
}

Json sounder_json(const Sounder& sounder, const SounderTally& tally, const WindowOutcome& outcome,
                  const ScreeningOptions& options) {
  Json screened = Json::object();
  for (const auto& [reason, count] : tally.screened) screened[name_of(reason, options)] = count;
  Json json = {{"number", sounder.first}, {"name", platform_name(sounder.first)}};
  if (sounder.second != Instrument::unknown) json["instrument"] = instrument_name(sounder.second);
  json["observations"] = tally.observations;
  json["duplicates"] = {{"of_the_same_field_of_view", tally.near_duplicates}, {"exact", tally.exact_duplicates}};
  json["screened"] = screened;
  json["prepared"] = tally.prepared;
  json["retained"] = retained_of(outcome, sounder);
  if (const EstimationError* error = error_of(outcome, sounder))
    json["estimation_error"] = error_json(*error, channels_of(outcome, sounder.second));
  return json;
}

Json thinned_error_json(const ThinnedError& error, const std::vector<int>& channels) {
  Json json = error_json(error.whole, channels);
  json["bandwidth_km"] = error.bandwidth_km;
  json["gme_level"] = error.level;
  return json;
}

// Channels and error: of the only instrument, or of each.
void add_errors(const WindowOutcome& outcome, Json& json) {
  if (outcome.errors.size() == 1) {
    const auto& [instrument, error] = *outcome.errors.begin();
    json["channels"] = channels_of(outcome, instrument);
    json["estimation_error"] = thinned_error_json(error, channels_of(outcome, instrument));
    return;
  }
  json["instruments"] = Json::array();
  for (const auto& [instrument, error] : outcome.errors)
    json["instruments"].push_back({{"name", instrument_name(instrument)},
                                   {"channels", channels_of(outcome, instrument)},
                                   {"estimation_error", thinned_error_json(error, channels_of(outcome, instrument))}});
}

Json steps_json(const Prepared& prepared) {
  std::size_t duplicates = 0, screened = 0;
  for (const auto& [sounder, tally] : prepared.sounders) {
    duplicates += tally.duplicates();
    screened += tally.screened_count();
  }
  return {{"outside_window", prepared.outside_window},
          {"duplicates", duplicates},
          {"screened", screened},
          {"surfaces_from_mask", prepared.surfaces_filled},
          {"bias_corrected", prepared.bias.corrected},
          {"bias_uncorrected", prepared.bias.uncorrected},
          {"first_guess",
           {{"innovations_as_they_came", prepared.first_guess.innovations},
            {"of_a_file", prepared.first_guess.given},
            {"scan_position_mean", prepared.first_guess.scan_position_mean},
            {"none", prepared.first_guess.none}}},
          {"prepared", prepared.observations.size()}};
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

std::string table_row(const std::string& name, const SounderTally& tally, std::size_t retained,
                      const EstimationError& error) {
  const double share = error.empty_mean_squared_k2 > 0 ? error.mean_squared_k2 / error.empty_mean_squared_k2 : 0;
  return fmt::format("{:<24} {:>12} {:>10} {:>9} {:>9} {:>12.4f} {:>10.4f} {:>9.1f}\n", name, tally.observations,
                     tally.duplicates(), tally.screened_count(), retained, error.mean_squared_k2, rms_k(error),
                     100 * share);
}

void add(const SounderTally& one, SounderTally& sum) {
  sum.observations += one.observations;
  sum.near_duplicates += one.near_duplicates;
  sum.exact_duplicates += one.exact_duplicates;
  sum.prepared += one.prepared;
}

// What all satellites of an instrument have together.
std::string sum_row(const WindowOutcome& outcome, Instrument instrument, const EstimationError& error) {
  SounderTally sum;
  std::size_t retained = 0;
  const bool is_only = outcome.errors.size() == 1;
  for (const auto& [sounder, tally] : outcome.prepared.sounders) {
    if (!is_only && sounder.second != instrument) continue;
    add(tally, sum);
    retained += retained_of(outcome, sounder);
  }
  return table_row(is_only ? "all" : fmt::format("all {}", instrument_name(instrument)), sum, retained, error);
}

}  // namespace

std::string report_json(const WindowOutcome& outcome, const Settings& settings) {
  const Prepared& prepared = outcome.prepared;
  Json json = {{"program", "thin"}, {"version", kVersion}};
  json["window"] = {{"begin", time_json(outcome.window.begin_ms)}, {"end", time_json(outcome.window.end_ms)}};
  for (const auto& [name, value] : settings.resolved) json["configuration"][name] = value;
  json["observations"] = steps_json(prepared);
  json["observations"]["retained"] = outcome.retained.size();
  json["values"] =
      prepared.observations.value_kind == ValueKind::innovation ? "innovations" : "brightness temperatures";
  add_errors(outcome, json);
  json["satellites"] = Json::array();
  for (const auto& [sounder, tally] : prepared.sounders)
    json["satellites"].push_back(sounder_json(sounder, tally, outcome, settings.preparation.screening));
  json["files"] = Json::array();
  for (const FileOutcome& file : outcome.files) json["files"].push_back(file_json(file));
  json["refused"] = Json::array();
  for (const RefusedFile& file : outcome.refused)
    json["refused"].push_back({{"name", file.name}, {"reason", file.reason}});
  json["notes"] = outcome.prepared.notes;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string report_table(const WindowOutcome& outcome) {
  std::string table = fmt::format("{:<24} {:>12} {:>10} {:>9} {:>9} {:>12} {:>10} {:>9}\n", "satellite", "observations",
                                  "duplicates", "screened", "retained", "E, K^2", "rms, K", "lost, %");
  for (const auto& [sounder, tally] : outcome.prepared.sounders) {
    const EstimationError* error = error_of(outcome, sounder);
    table += table_row(sounder_name(sounder), tally, retained_of(outcome, sounder), error ? *error : EstimationError{});
  }
  for (const auto& [instrument, error] : outcome.errors) table += sum_row(outcome, instrument, error.whole);
  for (const auto& [instrument, error] : outcome.errors)
    table += fmt::format(
        "E: mean squared difference of the Gaussian estimates (h = {:g} km) from the prepared and the "
        "retained, over channels {}; lost: its share of the E of retaining nothing\n",
        error.bandwidth_km, fmt::join(channels_of(outcome, instrument), " "));
  table += "seconds:";
  for (const auto& [step, seconds] : outcome.seconds) table += fmt::format("  {} {:.3f}", step, seconds);
  return table + "\n";
}

}  // namespace thin
