#include "libthin/tools/evaluation_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "libthin/foundation/version.h"
#include "libthin/tools/variant_json.h"

namespace thin {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMebibyte = 1024 * 1024;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

double median(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  const std::size_t middle = numbers.size() / 2;
  return numbers.size() % 2 ? numbers[middle] : (numbers[middle - 1] + numbers[middle]) / 2;
}

Json error_json(const EstimationError& error, double signal_to_noise_db) {
  return {{"mean_squared_k2", error.mean_squared_k2},
          {"per_channel_k2", error.per_channel_k2},
          {"signal_to_noise_db", signal_to_noise_db}};
}

Json separation_json(const SeparationStatistics& separation) {
  return {{"minimum", separation.minimum_km},
          {"mean", separation.mean_km},
          {"percentile_5", separation.percentile_5_km},
          {"percentile_25", separation.percentile_25_km},
          {"median", separation.median_km},
          {"percentile_75", separation.percentile_75_km},
          {"percentile_95", separation.percentile_95_km}};
}

Json boxes_json(const std::vector<BoxDifference>& boxes) {
  Json json = {{"latitude_deg", Json::array()},
               {"longitude_deg", Json::array()},
               {"observations", Json::array()},
               {"difference", Json::array()}};
  for (const BoxDifference& box : boxes) {
    json["latitude_deg"].push_back(box.latitude_deg);
    json["longitude_deg"].push_back(box.longitude_deg);
    json["observations"].push_back(box.observations);
    json["difference"].push_back(box.retained - box.reference);
  }
  return json;
}

Json result_json(const Evaluated& result, const EvaluationSettings& settings) {
  const EvaluationOptions& options = settings.evaluation;
  Json json = {{"variant", settings.variants[result.variant].label},
               {"asked", or_null(result.asked)},
               {"fitted_value", or_null(result.fitted_value)},
               {"retained", result.retained.size()}};
  if (options.errors) {
    json["error_at_observations"] = error_json(result.error.at_observations, result.signal_to_noise_observations_db);
    json["error_on_grid"] = error_json(result.error.on_grid, result.signal_to_noise_grid_db);
    json["signal_free_share"] = result.signal_free_share;
    json["true_signal_free_share"] = or_null(result.true_signal_free_share);
  }
  json["separation_km"] = separation_json(result.separation);
  json["mean_absolute_density_difference"] =
      result.boxes.empty() ? Json() : Json(mean_absolute_difference(result.boxes));
  if (options.list_boxes && !result.boxes.empty()) json["boxes"] = boxes_json(result.boxes);
  if (options.list_retained) json["retained_indices"] = result.retained;
  json["notes"] = result.notes;
  return json;
}

Json observations_json(const Evaluation& evaluation, const EvaluationSettings& settings, const ObservationSet& set) {
  Json json = {{"count", set.size()},
               {"channels", set.channels},
               {"values", set.value_kind == ValueKind::innovation ? "innovations" : "brightness temperatures"},
               {"mean_absolute_value_k", evaluation.mean_absolute_value_k}};
  if (settings.evaluation.errors && !evaluation.results.empty()) {
    const CommonError& error = evaluation.results.front().error;
    for (const auto& [name, part] : {std::pair("of_retaining_nothing_at_observations", &error.at_observations),
                                     {"of_retaining_nothing_on_grid", &error.on_grid}})
      json[name] = {{"mean_squared_k2", part->empty_mean_squared_k2},
                    {"evaluation_points", part->evaluation_point_count}};
    json["signal_free_share"] = evaluation.signal_free_share;
    json["true_signal_free_share"] = or_null(evaluation.true_signal_free_share);
  }
  if (settings.evaluation.list_retained) {
    json["latitude_deg"] = set.latitude_deg;
    json["longitude_deg"] = set.longitude_deg;
    Json first = Json::array();
    for (std::size_t i = 0; i < set.size(); ++i) first.push_back(set.values_of(i).front());
    json["first_channel_k"] = std::move(first);
  }
  return json;
}

std::string quoted(const std::string& text) {
  std::string doubled;
  for (const char letter : text) doubled += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return "\"" + doubled + "\"";
}

// Empty where there is none.
template <class T>
std::string field(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : "";
}

std::string reach_of(const EvaluationOptions& options, const Evaluation& evaluation) {
  const CommonError& error = evaluation.results.front().error;
  return fmt::format(
      "E: mean squared difference of the Gaussian estimates from all and from the retained, h = {:g} km, at {} "
      "observations and at {} vertices of the GME grid of level {}; of retaining nothing {:.5f} and {:.5f} K^2\n",
      options.bandwidth_km, error.at_observations.evaluation_point_count, error.on_grid.evaluation_point_count,
      options.level, error.at_observations.empty_mean_squared_k2, error.on_grid.empty_mean_squared_k2);
}

}  // namespace

std::string evaluation_json(const Evaluation& evaluation, const EvaluationSettings& settings, const ObservationSet& set,
                            const std::vector<std::string>& notes) {
  Json json = {{"program", "thin"}, {"version", kVersion}};
  for (const auto& [name, value] : settings.resolved) json["configuration"][name] = value;
  json["observations"] = observations_json(evaluation, settings, set);
  json["variants"] = Json::array();
  for (const Variant& variant : settings.variants) json["variants"].push_back(variant_json(variant));
  json["results"] = Json::array();
  for (const Evaluated& result : evaluation.results) json["results"].push_back(result_json(result, settings));
  json["failures"] = failures_json(evaluation.failures, settings.variants);
  json["notes"] = notes;
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string evaluation_csv(const Evaluation& evaluation, const EvaluationSettings& settings) {
  std::string csv =
      "variant,asked,retained,error_at_observations_k2,error_on_grid_k2,signal_to_noise_at_observations_db,"
      "signal_to_noise_on_grid_db,separation_minimum_km,separation_mean_km,separation_5_percent_km,"
      "separation_25_percent_km,separation_median_km,separation_75_percent_km,separation_95_percent_km,"
      "signal_free_share,true_signal_free_share,mean_absolute_density_difference\n";
  for (const Evaluated& result : evaluation.results) {
    csv += fmt::format("{},{},{}", quoted(settings.variants[result.variant].label), field(result.asked),
                       result.retained.size());
    csv += settings.evaluation.errors
               ? fmt::format(",{},{},{},{}", result.error.at_observations.mean_squared_k2,
                             result.error.on_grid.mean_squared_k2, result.signal_to_noise_observations_db,
                             result.signal_to_noise_grid_db)
               : ",,,,";
    const SeparationStatistics& s = result.separation;
    csv += fmt::format(",{},{},{},{},{},{},{}", s.minimum_km, s.mean_km, s.percentile_5_km, s.percentile_25_km,
                       s.median_km, s.percentile_75_km, s.percentile_95_km);
    csv += settings.evaluation.errors
               ? fmt::format(",{},{}", result.signal_free_share, field(result.true_signal_free_share))
               : ",,";
    csv += "," + (result.boxes.empty() ? "" : fmt::format("{}", mean_absolute_difference(result.boxes))) + "\n";
  }
  return csv;
}

std::string costs_csv(const Evaluation& evaluation, const std::vector<Variant>& variants) {
  std::string csv =
      "variant,asked,retained,repetitions,seconds_median,seconds_least,seconds_most,cpu_seconds_median,"
      "peak_memory_bytes\n";
  for (std::size_t i = 0; i < evaluation.results.size(); ++i) {
    const Evaluated& result = evaluation.results[i];
    const Cost& cost = evaluation.costs[i];
    const auto [least, most] = std::minmax_element(cost.seconds.begin(), cost.seconds.end());
    csv += fmt::format("{},{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{}\n", quoted(variants[result.variant].label),
                       field(result.asked), result.retained.size(), cost.seconds.size(), median(cost.seconds), *least,
                       *most, median(cost.cpu_seconds), field(cost.peak_memory_bytes));
  }
  return csv;
}

std::string evaluation_table(const Evaluation& evaluation, const EvaluationSettings& settings) {
  std::size_t width = 8;
  for (const Variant& variant : settings.variants) width = std::max(width, variant.label.size());
  std::string table = fmt::format("{:<{}} {:>8} {:>12} {:>12} {:>8} {:>9} {:>9} {:>8} {:>9} {:>9} {:>9}\n", "variant",
                                  width, "retained", "E obs, K^2", "E grid, K^2", "SNR, dB", "nearest,", "mean, km",
                                  "flat, %", "seconds", "CPU s", "MiB");
  for (std::size_t i = 0; i < evaluation.results.size(); ++i) {
    const Evaluated& result = evaluation.results[i];
    const Cost& cost = evaluation.costs[i];
    table += fmt::format("{:<{}} {:>8}", settings.variants[result.variant].label, width, result.retained.size());
    table += settings.evaluation.errors
                 ? fmt::format(" {:>12.5f} {:>12.5f} {:>8.2f}", result.error.at_observations.mean_squared_k2,
                               result.error.on_grid.mean_squared_k2, result.signal_to_noise_grid_db)
                 : fmt::format(" {:>12} {:>12} {:>8}", "-", "-", "-");
    table += fmt::format(" {:>9.1f} {:>9.1f}", result.separation.minimum_km, result.separation.mean_km);
    table += settings.evaluation.errors ? fmt::format(" {:>8.1f}", 100 * result.signal_free_share)
                                        : fmt::format(" {:>8}", "-");
    table += fmt::format(
        " {:>9.4f} {:>9.4f} {:>9}\n", median(cost.seconds), median(cost.cpu_seconds),
        cost.peak_memory_bytes ? fmt::format("{:.1f}", static_cast<double>(*cost.peak_memory_bytes) / kMebibyte) : "-");
  }
  if (settings.evaluation.errors && !evaluation.results.empty()) {
    table += reach_of(settings.evaluation, evaluation);
    table +=
        fmt::format("flat: share of the retained in areas free of signal, where {:.1f} % of all observations are\n",
                    100 * evaluation.signal_free_share);
  }
  return table;
}

}  // namespace thin
