#include "libthin/tools/withholding_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "libthin/analysis/confidence.h"
#include "libthin/foundation/version.h"
#include "libthin/tools/interval_text.h"
#include "libthin/tools/variant_json.h"

namespace thin {
namespace {

using Json = nlohmann::ordered_json;

// The channel's number; null for all jointly, or their mean.
Json channel_json(std::optional<int> place, const ObservationSet& set) {
  return place ? Json(set.channels[static_cast<std::size_t>(*place)]) : Json();
}

// NaN is no JSON: null.
Json numbers_json(const std::vector<double>& numbers) {
  Json json = Json::array();
  for (const double number : numbers) json.push_back(std::isfinite(number) ? Json(number) : Json());
  return json;
}

Json score_json(const WithheldScore& score, const WithheldSet& set, const ObservationSet& observations) {
  return {{"set", set.label},
          {"asked", set.asked ? Json(*set.asked) : Json()},
          {"thinned_by", channel_json(score.thinned_by, observations)},
          {"predicted", channel_json(score.predicted, observations)},
          {"relative_rms", numbers_json(score.relative_rms)},
          {"explained", numbers_json(score.explained)},
          {"share_of_all", numbers_json(score.share_of_all)},
          {"retained_rms", numbers_json(score.retained_rms)},
          {"length_km", numbers_json(score.length_km)},
          {"error_ratio", numbers_json(score.error_ratio)}};
}

}  // namespace

std::string withholding_json(const Withholding& withholding, const EvaluationSettings& settings,
                             const ObservationSet& observations, const std::vector<std::string>& notes) {
  Json json = {{"program", "thin"}, {"version", kVersion}};
  for (const auto& [name, value] : settings.resolved) json["configuration"][name] = value;
  Json channels = Json::array();
  for (std::size_t c = 0; c < withholding.channels.size(); ++c) {
    const ChannelFacts& facts = withholding.channels[c];
    channels.push_back({{"channel", observations.channels[c]},
                        {"mean_k", facts.mean_k},
                        {"standard_deviation_k", facts.standard_deviation_k},
                        {"excess_kurtosis", facts.excess_kurtosis}});
  }
  json["observations"] = {{"count", observations.size()},
                          {"withheld", withholding.withheld_count},
                          {"thinned", withholding.rest_count},
                          {"channels", std::move(channels)}};
  json["variants"] = Json::array();
  for (const Variant& variant : settings.variants) json["variants"].push_back(variant_json(variant));
  json["scores"] = Json::array();
  for (const WithheldScore& score : withholding.scores)
    json["scores"].push_back(score_json(score, withholding.sets[score.set], observations));
  json["sets"] = Json::array();
  for (const WithheldSet& set : withholding.sets)
    json["sets"].push_back(
        {{"set", set.label}, {"asked", set.asked ? Json(*set.asked) : Json()}, {"retained", set.retained}});
  json["failures"] = failures_json(withholding.failures, settings.variants);
  json["notes"] = notes;
  for (const std::string& note : withholding.notes) json["notes"].push_back(note);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string withholding_table(const Withholding& withholding, const EvaluationSettings& settings,
                              const ObservationSet& observations) {
  std::size_t width = 14;
  for (const Variant& variant : settings.variants) width = std::max(width, variant.label.size());
  std::string table = fmt::format("{:<{}} {:>7} {:>8} {:>8} {:>18} {:>16} {:>9} {:>7} {:>6}\n", "set", width, "asked",
                                  "thinned", "channel", "RMS / deviation", "% of all's", "retained", "L, km", "rho");
  for (const WithheldScore& score : withholding.scores) {
    const WithheldSet& set = withholding.sets[score.set];
    const auto name = [&](std::optional<int> place, const char* other) {
      return place ? fmt::format("{}", observations.channels[static_cast<std::size_t>(*place)]) : std::string(other);
    };
    const auto mean = [](const std::vector<double>& numbers, int decimals) {
      return numbers.empty() ? std::string("-") : fmt::format("{:.{}f}", mean_with_interval(numbers).mean, decimals);
    };
    table += fmt::format("{:<{}} {:>7} {:>8} {:>8} {:>18} {:>16} {:>9} {:>7} {:>6}\n", set.label, width,
                         set.asked ? fmt::format("{}", *set.asked) : "-", name(score.thinned_by, "jointly"),
                         name(score.predicted, "mean"), with_interval(score.relative_rms, 1, 4),
                         with_interval(score.share_of_all, 100, 1), mean(score.retained_rms, 2),
                         mean(score.length_km, 0), mean(score.error_ratio, 2));
  }
  table += fmt::format(
      "{} of {} observations withheld and predicted from what is retained of the other {}; RMS of what remains over "
      "that "
      "of the withheld, and explained variance as a share of what all {} explain; +-: 95 % over {} draws (of places, "
      "not of "
      "weather). retained: RMS of the retained values over that of all\n",
      withholding.withheld_count, observations.size(), withholding.rest_count, withholding.rest_count,
      settings.withholding.draws);
  return table;
}

}  // namespace thin
