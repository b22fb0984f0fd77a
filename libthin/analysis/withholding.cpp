#include "libthin/analysis/withholding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "libthin/analysis/optimal_interpolation.h"
#include "libthin/analysis/uniform_subset.h"

namespace thin {
namespace {

using Progress = std::function<void(const std::string&)>;

constexpr double kManyOutliers = 10;       // excess kurtosis from which on the figures say little
constexpr double kTolerance = 1e-4;        // of the interpolation: its error is far below the noise of the withheld
constexpr double kLeastExplained = 0.005;  // below, a share of it is noise over noise

// One draw: what the methods see, and what they don't.
struct Draw {
  ObservationSet rest;              // the mean of each channel taken off
  std::vector<Vector3> places;      // of the withheld
  std::vector<double> values;       // withheld x channels, the same means taken off
  std::vector<double> deviation_k;  // of each channel of the rest
  std::uint64_t seed = 0;

  std::size_t channel_count() const { return rest.channel_count(); }
};

void subtract(std::vector<double>& values, const std::vector<double>& means) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= means[i % means.size()];
}

std::vector<double> root_mean_squares(std::span<const double> values, std::size_t channels) {
  std::vector<double> sums(channels, 0);
  for (std::size_t i = 0; i < values.size(); ++i) sums[i % channels] += values[i] * values[i];
  for (double& sum : sums) sum = std::sqrt(sum * static_cast<double>(channels) / static_cast<double>(values.size()));
  return sums;
}

Draw drawn(const ObservationSet& set, const WithholdingOptions& options, int number) {
  const std::vector<std::uint32_t> withheld = withheld_in_draw(set.size(), options.share, number, options.seed);
  std::vector<std::uint32_t> rest;
  for (std::uint32_t i = 0, next = 0; i < set.size(); ++i) {
    if (next < withheld.size() && withheld[next] == i)
      ++next;
    else
      rest.push_back(i);
  }
  Draw draw;
  draw.rest = set.select(rest);
  const ObservationSet hidden = set.select(withheld);
  draw.places = hidden.position_km;
  draw.values = hidden.values;
  std::vector<double> means(set.channel_count(), 0);
  for (std::size_t i = 0; i < draw.rest.values.size(); ++i) means[i % means.size()] += draw.rest.values[i];
  for (double& mean : means) mean /= static_cast<double>(rest.size());
  subtract(draw.rest.values, means);
  subtract(draw.values, means);
  draw.deviation_k = root_mean_squares(draw.rest.values, means.size());
  draw.seed = static_cast<std::uint64_t>(options.seed) * 1'000'003U + static_cast<std::uint64_t>(number);
  return draw;
}

// The observations that a channel, or all jointly, are thinned by.
ObservationSet thinned_by(const Draw& draw, std::optional<int> channel) {
  if (channel) return draw.rest.select_channels(std::vector<std::size_t>{static_cast<std::size_t>(*channel)});
  ObservationSet scaled = draw.rest;
  for (std::size_t i = 0; i < scaled.values.size(); ++i)
    if (const double deviation = draw.deviation_k[i % draw.channel_count()]; deviation > 0)
      scaled.values[i] /= deviation;
  return scaled;
}

// Of one channel, with the length and ratio that the other half of the withheld likes best.
struct Prediction {
  double remaining = 1;  // of the withheld's sum of squares
  double length_km = 0, error_ratio = 0;
};

// Sums of squares of each channel and half, for each pair of length and ratio.
struct Remaining {
  std::vector<double> sums;  // [pair][half][channel]
  std::size_t channels;
  double& at(std::size_t pair, std::size_t half, std::size_t channel) {
    return sums[(pair * 2 + half) * channels + channel];
  }
};

std::vector<Prediction> predict(const Draw& draw, const ObservationSet& chosen,
                                const std::vector<std::size_t>& channels, const WithholdingOptions& options) {
  const std::size_t k = channels.size(), all = draw.channel_count(), ratios = options.error_ratios.size();
  const std::vector<double> values = chosen.select_channels(channels).values;
  Remaining remaining{std::vector<double>(options.lengths_km.size() * ratios * 2 * k, 0), k};
  std::vector<double> half_sums(2 * k, 0);
  for (std::size_t l = 0; l < options.lengths_km.size(); ++l) {
    const OptimalInterpolation interpolation(chosen.position_km, draw.places, options.lengths_km[l]);
    const auto estimates = interpolation.estimates(values, k, options.error_ratios, kTolerance);
    for (std::size_t r = 0; r < ratios; ++r)
      for (std::size_t i = 0; i < draw.places.size(); ++i)
        for (std::size_t c = 0; c < k; ++c) {
          const double value = draw.values[i * all + channels[c]];
          remaining.at(l * ratios + r, i % 2, c) += std::pow(value - estimates[r][i * k + c], 2);
          if (l == 0 && r == 0) half_sums[(i % 2) * k + c] += value * value;
        }
  }
  std::vector<Prediction> predictions(k);
  for (std::size_t c = 0; c < k; ++c) {
    double missed = 0, length = 1, ratio = 1;
    for (std::size_t half = 0; half < 2; ++half) {
      std::size_t best = 0;
      for (std::size_t pair = 1; pair < options.lengths_km.size() * ratios; ++pair)
        if (remaining.at(pair, 1 - half, c) < remaining.at(best, 1 - half, c)) best = pair;
      missed += remaining.at(best, half, c);
      length *= options.lengths_km[best / ratios];
      ratio *= options.error_ratios[best % ratios];
    }
    predictions[c] = {missed / (half_sums[c] + half_sums[k + c]), std::sqrt(length), std::sqrt(ratio)};
  }
  return predictions;
}

double share(double explained, double of_all) {
  return of_all > kLeastExplained ? explained / of_all : std::numeric_limits<double>::quiet_NaN();
}

double mean_remaining(const std::vector<Prediction>& predictions) {
  double sum = 0;
  for (const Prediction& each : predictions) sum += each.remaining;
  return sum / static_cast<double>(predictions.size());
}

// Which channel or channels the sets are thinned by, in the order of the scores.
std::vector<std::optional<int>> thinnings(const ObservationSet& set, const WithholdingOptions& options) {
  using Channels = WithholdingOptions::Channels;
  std::vector<std::optional<int>> list;
  if (options.channels != Channels::joint)
    for (int c = 0; c < static_cast<int>(set.channel_count()); ++c) list.emplace_back(c);
  if (options.channels == Channels::joint || (options.channels == Channels::both && set.channel_count() > 1))
    list.emplace_back(std::nullopt);
  return list;
}

class CrossValidation {
 public:
  CrossValidation(const ObservationSet& set, const std::vector<Variant>& variants, const WithholdingOptions& options,
                  Withholding& result)
      : set_(set), variants_(variants), options_(options), thinnings_(thinnings(set, options)), result_(result) {}

  void add_set(const std::string& label, std::optional<std::size_t> variant, std::optional<std::int64_t> asked) {
    const std::size_t place = result_.sets.size();
    result_.sets.push_back({label, variant, asked, std::vector<double>(thinnings_.size(), 0)});
    for (const auto& by : thinnings_) {
      const auto add = [&](std::optional<int> predicted) {
        WithheldScore score;
        score.set = place, score.thinned_by = by, score.predicted = predicted;
        result_.scores.push_back(std::move(score));
      };
      if (by)
        add(by);
      else {
        for (int c = 0; c < static_cast<int>(set_.channel_count()); ++c) add(c);
        add(std::nullopt);
      }
    }
  }

  void run(int number, const Progress& progress) {
    const Draw draw = drawn(set_, options_, number);
    result_.withheld_count = draw.places.size(), result_.rest_count = draw.rest.size();
    std::vector<std::size_t> channels(draw.channel_count());
    std::iota(channels.begin(), channels.end(), 0U);
    progress(fmt::format("draw {} of {}: all {}", number + 1, options_.draws, draw.rest.size()));
    of_all_ = predict(draw, draw.rest, channels, options_);
    std::vector<ObservationSet> inputs;
    for (const auto& by : thinnings_) inputs.push_back(thinned_by(draw, by));
    next_score_ = 0;
    for (WithheldSet& set : result_.sets) {
      if (&set != &result_.sets.front())
        progress(fmt::format("draw {} of {}: {}", number + 1, options_.draws, set.label));
      std::vector<Choice> choices;
      for (const ObservationSet& input : inputs) {
        Result<Choice> one =
            choose_set(set.variant ? &variants_[*set.variant] : nullptr, set.label, input, set.asked, draw.seed);
        // A failure leaves an empty set, whose scores are taken out at the end.
        choices.push_back(one ? std::move(*one) : Choice{});
        if (!one && set.variant) fail(*set.variant, one.error().message);
      }
      score(draw, set, choices);
    }
  }

 private:
  void fail(std::size_t variant, const std::string& reason) {
    const bool known = std::any_of(result_.failures.begin(), result_.failures.end(),
                                   [&](const auto& failure) { return failure.variant == variant; });
    if (!known) result_.failures.push_back({variant, reason});
  }

  // Equal sets, as those of methods that don't look at values, are predicted from once.
  void score(const Draw& draw, WithheldSet& set, const std::vector<Choice>& choices) {
    std::map<Retained, std::vector<std::size_t>> wanted;  // channels
    std::map<Retained, ObservationSet> chosen;
    for (std::size_t t = 0; t < thinnings_.size(); ++t) {
      const Retained& retained = choices[t].retained;
      if (!chosen.contains(retained)) chosen[retained] = chosen_observations(draw.rest, choices[t]);
      std::vector<std::size_t>& channels = wanted[retained];
      if (thinnings_[t])
        channels.push_back(static_cast<std::size_t>(*thinnings_[t]));
      else
        for (std::size_t c = 0; c < draw.channel_count(); ++c) channels.push_back(c);
    }
    std::map<Retained, std::vector<Prediction>> predictions;
    for (auto& [subset, channels] : wanted) {
      std::sort(channels.begin(), channels.end());
      channels.erase(std::unique(channels.begin(), channels.end()), channels.end());
      const std::vector<Prediction> found = predict(draw, chosen[subset], channels, options_);
      std::vector<Prediction>& by_channel = predictions[subset];
      by_channel.resize(draw.channel_count());
      for (std::size_t c = 0; c < channels.size(); ++c) by_channel[channels[c]] = found[c];
    }
    for (std::size_t t = 0; t < thinnings_.size(); ++t) {
      const Retained& retained = choices[t].retained;
      set.retained[t] += static_cast<double>(retained.size()) / options_.draws;
      const std::vector<Prediction>& found = predictions[retained];
      if (thinnings_[t])
        add(draw, static_cast<std::size_t>(*thinnings_[t]), found, chosen[retained]);
      else {
        for (std::size_t c = 0; c < draw.channel_count(); ++c) add(draw, c, found, chosen[retained]);
        add_mean(found);
      }
    }
  }

  void add(const Draw& draw, std::size_t channel, const std::vector<Prediction>& found, const ObservationSet& chosen) {
    WithheldScore& score = result_.scores[next_score_++];
    const Prediction& one = found[channel];
    score.relative_rms.push_back(std::sqrt(one.remaining));
    score.explained.push_back(1 - one.remaining);
    score.share_of_all.push_back(share(1 - one.remaining, 1 - of_all_[channel].remaining));
    double squares = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) squares += std::pow(chosen.values_of(i)[channel], 2);
    score.retained_rms.push_back(std::sqrt(squares / static_cast<double>(std::max<std::size_t>(chosen.size(), 1))) /
                                 draw.deviation_k[channel]);
    score.length_km.push_back(one.length_km);
    score.error_ratio.push_back(one.error_ratio);
  }

  void add_mean(const std::vector<Prediction>& found) {
    WithheldScore& score = result_.scores[next_score_++];
    const double remaining = mean_remaining(found);
    score.relative_rms.push_back(std::sqrt(remaining));
    score.explained.push_back(1 - remaining);
    score.share_of_all.push_back(share(1 - remaining, 1 - mean_remaining(of_all_)));
  }

  const ObservationSet& set_;
  const std::vector<Variant>& variants_;
  const WithholdingOptions& options_;
  const std::vector<std::optional<int>> thinnings_;
  Withholding& result_;
  std::vector<Prediction> of_all_;
  std::size_t next_score_ = 0;
};

void add_facts(const ObservationSet& set, Withholding& result) {
  const auto n = static_cast<double>(set.size());
  for (std::size_t c = 0; c < set.channel_count(); ++c) {
    ChannelFacts facts;
    double second = 0, fourth = 0;
    for (std::size_t i = 0; i < set.size(); ++i) facts.mean_k += set.values_of(i)[c] / n;
    for (std::size_t i = 0; i < set.size(); ++i) {
      const double square = std::pow(set.values_of(i)[c] - facts.mean_k, 2);
      second += square / n, fourth += square * square / n;
    }
    facts.standard_deviation_k = std::sqrt(second);
    facts.excess_kurtosis = second > 0 ? fourth / (second * second) - 3 : 0;
    if (facts.excess_kurtosis > kManyOutliers)
      result.notes.push_back(
          fmt::format("channel {} has an excess kurtosis of {:.1f}: outliers are left in, and what adaptive methods "
                      "retain, and how "
                      "well it predicts, says little; screen them out first",
                      set.channels[c], facts.excess_kurtosis));
    if (std::abs(facts.mean_k) > 0.5 * facts.standard_deviation_k)
      result.notes.push_back(
          fmt::format("channel {} had a mean of {:.3f} K, {:.1f} standard deviations: an uncorrected "
                      "bias; it was taken off",
                      set.channels[c], facts.mean_k, facts.mean_k / facts.standard_deviation_k));
    result.channels.push_back(facts);
  }
}

// Failed variants have no results.
void remove_failures(Withholding& result) {
  const auto failed = [&](const WithheldScore& score) {
    const auto& variant = result.sets[score.set].variant;
    return variant && std::any_of(result.failures.begin(), result.failures.end(),
                                  [&](const auto& failure) { return failure.variant == *variant; });
  };
  std::erase_if(result.scores, failed);
}

}  // namespace

void WithholdingOptions::declare(OptionTable& table) {
  table.add(
      "withhold", share,
      {.minimum = 0,
       .maximum = 0.9,
       .explanation = "cross-validation instead of the above: this share of the observations is withheld from the "
                      "methods and predicted from what they retain; 0: none"});
  table.add("withhold_draws", draws, {.minimum = 1, .maximum = 1000, .explanation = "how often, for the intervals"});
  table.add("withhold_seed", seed, {.minimum = 0, .explanation = "of the choice of the withheld"});
  table.add("withhold_lengths_km", lengths_km,
            {.unit = "km", .above = 0, .explanation = "of the interpolation, L in exp(-d²/2L²); the best is found"});
  table.add("withhold_error_ratios", error_ratios,
            {.above = 0, .explanation = "observation error over background error; the best is found"});
  table.add_choice("withhold_channels", channels,
                   std::vector<std::pair<std::string, Channels>>{
                       {"each", Channels::each}, {"joint", Channels::joint}, {"both", Channels::both}},
                   {.explanation = "thin and predict each channel alone, or all by one joint set"});
}

std::vector<std::uint32_t> withheld_in_draw(std::size_t n, double withheld_share, int draw, int seed) {
  const auto count = static_cast<std::size_t>(std::floor(withheld_share * static_cast<double>(n)));
  const auto parts = std::max<std::size_t>(static_cast<std::size_t>(std::floor(1 / withheld_share + 1e-9)), 1);
  const std::size_t round = static_cast<std::size_t>(draw) / parts, part = static_cast<std::size_t>(draw) % parts;
  const std::vector<std::uint32_t> order =
      random_order(n, static_cast<std::uint64_t>(seed) * 1'000'033U + static_cast<std::uint64_t>(round));
  std::vector<std::uint32_t> withheld(order.begin() + static_cast<std::ptrdiff_t>(part * count),
                                      order.begin() + static_cast<std::ptrdiff_t>((part + 1) * count));
  std::sort(withheld.begin(), withheld.end());
  return withheld;
}

Result<Withholding> withhold(const ObservationSet& set, const std::vector<Variant>& variants,
                             const std::vector<int>& counts, const WithholdingOptions& options,
                             const Progress& progress) {
  const auto withheld_count = static_cast<std::size_t>(options.share * static_cast<double>(set.size()));
  if (withheld_count < 10)
    return Error{ErrorKind::input, fmt::format("{} observations are too few to withhold a share of {} of them",
                                               set.size(), options.share)};
  if (std::any_of(set.values.begin(), set.values.end(), [](double value) { return !std::isfinite(value); }))
    return Error{ErrorKind::input,
                 "cross-validation wants observations of one instrument with all channels; name them in [preparation]"};
  if (options.lengths_km.empty() || options.error_ratios.empty())
    return Error{ErrorKind::configuration, "withhold_lengths_km and withhold_error_ratios must not be empty"};
  Withholding result;
  add_facts(set, result);
  CrossValidation validation(set, variants, options, result);
  validation.add_set("all", std::nullopt, std::nullopt);
  std::vector<int> ascending = counts;
  std::sort(ascending.begin(), ascending.end());
  ascending.erase(std::unique(ascending.begin(), ascending.end()), ascending.end());
  for (const char* label : {"farthest_point", "random"})
    for (const int count : ascending) validation.add_set(label, std::nullopt, count);
  for (std::size_t v = 0; v < variants.size(); ++v)
    for (const auto& asked : numbers_for(variants[v], counts)) validation.add_set(variants[v].label, v, asked);
  for (int draw = 0; draw < options.draws; ++draw) validation.run(draw, progress);
  remove_failures(result);
  return result;
}

}  // namespace thin
