#include "libthin/tools/twin_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "libthin/analysis/confidence.h"
#include "libthin/foundation/version.h"
#include "libthin/tools/interval_text.h"
#include "libthin/tools/variant_json.h"

namespace thin {
namespace {

using Json = nlohmann::ordered_json;

// Per cent less than the uniform set of the same number has; nothing where there is none.
std::vector<double> gains(const TwinScore& score, const Twin& twin) {
  const std::vector<double> own = tuned_errors(score, twin.scores.front());
  for (const TwinScore& other : twin.scores) {
    if (other.label != "farthest_point" || other.asked != score.asked) continue;
    std::vector<double> gain = tuned_errors(other, twin.scores.front());
    for (std::size_t i = 0; i < gain.size(); ++i) gain[i] = 100 * (1 - own[i] / gain[i]);
    return gain;
  }
  return {};
}

Json score_json(const TwinScore& score, const Twin& twin, const TwinOptions& options) {
  Json factors = Json::array();
  for (const std::size_t factor : tuned_factors(score)) factors.push_back(options.error_factors[factor]);
  return {{"set", score.label},
          {"asked", score.asked ? Json(*score.asked) : Json()},
          {"retained", score.retained},
          {"nominal", nominal_errors(score, twin.scores.front(), options)},
          {"tuned", tuned_errors(score, twin.scores.front())},
          {"tuned_factor", std::move(factors)},
          {"retained_error_k", score.retained_error_k},
          {"outlier_share", score.outlier_share},
          {"mean_squared_k2", score.mean_squared_k2},
          {"with_fresh_errors_k2", score.with_fresh_errors}};
}

// Consecutive cycles are alike: the interval is taken over blocks of `block` cycles.
std::vector<double> block_means(const std::vector<double>& numbers, std::size_t block) {
  std::vector<double> means;
  for (std::size_t begin = 0; begin + block <= numbers.size(); begin += block) {
    double sum = 0;
    for (std::size_t i = begin; i < begin + block; ++i) sum += numbers[i];
    means.push_back(sum / static_cast<double>(block));
  }
  return means.empty() ? numbers : means;
}

double mean_of(const std::vector<double>& numbers) {
  return numbers.empty() ? 0 : mean_with_interval(numbers).mean;
}

}  // namespace

std::string twin_json(const Twin& twin, const TwinSettings& settings) {
  Json json = {{"program", "thin"}, {"version", kVersion}};
  for (const auto& [name, value] : settings.resolved) json["configuration"][name] = value;
  json["observations"] = twin.observations;
  json["error_factors"] = settings.twin.error_factors;
  json["variants"] = Json::array();
  for (const Variant& variant : settings.variants) json["variants"].push_back(variant_json(variant));
  json["scores"] = Json::array();
  for (const TwinScore& score : twin.scores) json["scores"].push_back(score_json(score, twin, settings.twin));
  json["failures"] = failures_json(twin.failures, settings.variants);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string cycles_json(const TwinCycles& cycles, const TwinSettings& settings) {
  Json json = {{"program", "thin"}, {"version", kVersion}};
  for (const auto& [name, value] : settings.resolved) json["configuration"][name] = value;
  json["truth_deviation_k"] = cycles.truth_deviation_k;
  json["variants"] = Json::array();
  for (const Variant& variant : settings.variants) json["variants"].push_back(variant_json(variant));
  json["sets"] = Json::array();
  for (const CycledSet& set : cycles.sets)
    json["sets"].push_back(
        {{"set", set.label},
         {"retained", mean_of(set.retained)},
         {"variogram_length_km", mean_of(set.length_km)},
         {"analysis_error_k", set.analysis_error_k},
         {"background_error_k", set.background_error_k},
         {"anomaly_correlation", {{"northern", set.northern}, {"southern", set.southern}, {"global", set.global}}}});
  json["failures"] = failures_json(cycles.failures, settings.variants);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string cycles_table(const TwinCycles& cycles, const TwinSettings& settings) {
  const auto block = static_cast<std::size_t>(std::max(48 / settings.cycle.hours, 1));  // two days
  std::size_t width = 14;
  for (const Variant& variant : settings.variants) width = std::max(width, variant.label.size());
  std::string table = fmt::format("{:<{}} {:>9} {:>18} {:>18} {:>9} {:>34}\n", "set", width, "retained", "analysis, K",
                                  "background, K", "L, km", "anomaly correlation by day");
  for (const CycledSet& set : cycles.sets) {
    if (set.analysis_error_k.empty()) continue;
    table += fmt::format("{:<{}} {:>9.0f} {:>18} {:>18} {:>9.0f} ", set.label, width, mean_of(set.retained),
                         with_interval(block_means(set.analysis_error_k, block), 1, 4),
                         with_interval(block_means(set.background_error_k, block), 1, 4), mean_of(set.length_km));
    for (const auto& day : set.global) table += fmt::format(" {:.4f}", mean_of(day));
    table += "\n";
  }
  table += fmt::format(
      "errors: root mean square over the Earth, the truth's anomaly being {:.2f} K; +-: 95 % over blocks of two days; "
      "L: by "
      "the variogram of the innovations; the anomaly correlation is global, lead times in days from 0\n",
      cycles.truth_deviation_k);
  return table;
}

std::string twin_table(const Twin& twin, const TwinSettings& settings) {
  std::size_t width = 14;
  for (const Variant& variant : settings.variants) width = std::max(width, variant.label.size());
  std::string table = fmt::format("{:<{}} {:>7} {:>9} {:>18} {:>18} {:>16} {:>9} {:>9}\n", "set", width, "asked",
                                  "retained", "error, R nominal", "error, R tuned", "gain, %", "errors, K", "outliers");
  for (const TwinScore& score : twin.scores) {
    const std::vector<double> gain = gains(score, twin);
    table += fmt::format("{:<{}} {:>7} {:>9.0f} {:>18} {:>18} {:>16} {:>9.3f} {:>9.3f}\n", score.label, width,
                         score.asked ? fmt::format("{}", *score.asked) : "-", mean_with_interval(score.retained).mean,
                         with_interval(nominal_errors(score, twin.scores.front(), settings.twin), 1, 4),
                         with_interval(tuned_errors(score, twin.scores.front()), 1, 4),
                         gain.empty() ? "-" : with_interval(gain, 1, 1),
                         mean_with_interval(score.retained_error_k).mean, mean_with_interval(score.outlier_share).mean);
  }
  table += fmt::format(
      "error: root mean square of the analysis errors over the background's; gain: less than farthest_point, R tuned; "
      "+-: "
      "95 % over {} cases; errors: observation errors of the retained\n",
      settings.twin.cases);
  return table;
}

}  // namespace thin
