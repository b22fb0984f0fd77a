#include "libthin/thinning/thinner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "libthin/observations/mean_observations.h"
#include "libthin/thinning/separation.h"

namespace thin {
namespace {

Result<void> require_finite_values(const ObservationSet& observations) {
  const std::size_t channels = observations.channel_count();
  for (std::size_t i = 0; i < observations.values.size(); ++i)
    if (!std::isfinite(observations.values[i]) && observations.measures(i / channels, i % channels))
      return Error{ErrorKind::input,
                   fmt::format("observation {} has no usable value in channel {}; screen it out before thinning "
                               "([preparation] channels, or leave the channel out)",
                               i / channels, observations.channels[i % channels])};
  return {};
}

// The values in units of the observation errors, 0 where not measured.
std::vector<double> weighted_values(const ObservationSet& observations, const std::vector<double>& errors_k) {
  const std::size_t channels = observations.channel_count();
  std::vector<double> values = observations.values_or_zero();
  if (!errors_k.empty())
    for (std::size_t i = 0; i < values.size(); ++i) values[i] /= errors_k[i % channels];
  return values;
}

// Indices per category, in the order of the categories; instruments apart first, if asked.
Result<std::vector<std::vector<std::uint32_t>>> categories_of(const ObservationSet& observations,
                                                              const SelectionOptions& selection) {
  std::vector<double> variable(observations.size(), 0.0);
  if (selection.category_variable) {
    Result<std::vector<double>> named = number_named(observations, *selection.category_variable);
    if (!named) return named.error();
    variable = std::move(*named);
  }
  const bool apart =
      !observations.channel_instrument.empty() && selection.instruments == SelectionOptions::Instruments::apart;
  // A missing number is a category of its own, before the others.
  std::map<std::tuple<Instrument, bool, double>, std::vector<std::uint32_t>> categories;
  for (std::uint32_t i = 0; i < observations.size(); ++i) {
    const bool known = !std::isnan(variable[i]);
    categories[{apart ? observations.instrument[i] : Instrument::unknown, known, known ? variable[i] : 0}].push_back(i);
  }
  std::vector<std::vector<std::uint32_t>> result;
  for (auto& [category, indices] : categories) result.push_back(std::move(indices));
  return result;
}

struct Category {
  ObservationSet observations;
  std::vector<double> errors_k;  // of its channels, or empty
};

// With the channels of other instruments left out, if no observation has them.
Category category_of(const ObservationSet& observations, const std::vector<std::uint32_t>& indices,
                     const std::vector<double>& errors_k) {
  Category category{observations.select(indices), errors_k};
  const ObservationSet& set = category.observations;
  if (set.channel_instrument.empty()) return category;
  const std::set<Instrument> instruments(set.instrument.begin(), set.instrument.end());
  std::vector<std::size_t> places;
  for (std::size_t c = 0; c < set.channel_count(); ++c)
    if (instruments.contains(set.channel_instrument[c])) places.push_back(c);
  category.errors_k.clear();
  if (!errors_k.empty())
    for (const std::size_t c : places) category.errors_k.push_back(errors_k[c]);
  category.observations = set.select_channels(places);
  if (instruments.size() < 2) category.observations.channel_instrument.clear();
  return category;
}

// What was chosen among the observations at `indices`.
void add(const Choice& choice, const std::vector<std::uint32_t>& indices, Choice& all) {
  for (const std::uint32_t p : choice.retained) all.retained.push_back(indices[p]);
  for (Retained members : choice.members) {
    for (std::uint32_t& p : members) p = indices[p];
    all.members.push_back(std::move(members));
  }
}

void sort(Choice& choice) {
  if (!choice.members.empty()) {
    std::vector<std::size_t> order(choice.retained.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return choice.retained[a] < choice.retained[b]; });
    std::vector<Retained> members;
    for (const std::size_t i : order) members.push_back(std::move(choice.members[i]));
    choice.members = std::move(members);
  }
  std::sort(choice.retained.begin(), choice.retained.end());
}

// Of two that stand too near to each other the later one goes, after those of lower priority.
Retained separated(const ThinningInput& input, const Retained& retained) {
  Retained order = retained;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return input.has_priority(a, b); });
  const Separation separation(input.observations.position_km, input.min_separation_km);
  std::vector<std::uint8_t> kept(input.size(), 0);
  for (const std::uint32_t p : order) {
    const auto near = separation.too_near_to(p);
    kept[p] = std::none_of(near.begin(), near.end(), [&](std::uint32_t other) { return kept[other]; });
  }
  Retained result;
  for (const std::uint32_t p : retained)
    if (kept[p]) result.push_back(p);
  return result;
}

}  // namespace

Thinner::Thinner(const MethodEntry& entry) : name_(entry.name), method_(entry.make()), traits_(method_->traits()) {}

void Thinner::declare_options(OptionTable& table) {
  if (traits_.stops_at_count) {
    table.add("retain_count", selection_.retain_count,
              {.unit = "observations", .minimum = 0, .explanation = "how many to retain; all, where there are fewer"});
    table.add("retain_fraction", selection_.retain_fraction,
              {.minimum = 0, .maximum = 1, .explanation = "share to retain of the observations left after screening"});
  }
  method_->declare_options(table);
  if (traits_.keeps_apart)
    table.add("min_separation_km", selection_.min_separation_km,
              {.unit = "km",
               .minimum = 0,
               .maximum = 20000,
               .explanation = "no two retained observations are nearer to each other than this; fewer may then be "
                              "retained than asked for"});
  if (traits_.uses_places)
    table.add("time_scale_km_per_hour", selection_.time_scale_km_per_hour,
              {.unit = "km/h",
               .minimum = 0,
               .maximum = 100000,
               .explanation = "an hour apart counts as so many km apart, for 4D assimilation; 0: time does not count"});
  if (traits_.uses_values) {
    table.add("observation_errors", selection_.observation_errors_k,
              {.unit = "K",
               .above = 0,
               .explanation = "of the channels in use, in their order: values are compared in units of them; "
                              "empty: all 1"});
    table.add_choice(
        "instruments", selection_.instruments,
        std::vector<std::pair<std::string, SelectionOptions::Instruments>>{
            {"apart", SelectionOptions::Instruments::apart}, {"joint", SelectionOptions::Instruments::joint}},
        {.explanation = "of several instruments in a window, thin each by itself, or let them compete for "
                        "the number to retain"});
  }
  if (traits_.takes_priority)
    table.add("priority_variable", selection_.priority_variable,
              {.explanation = "where there is a choice, observations with a higher number of this name are retained: "
                              "a variable of the files, or platform, instrument, surface, scan_line, field_of_view, "
                              "latitude_deg, longitude_deg, time_s"});
  table.add("category_variable", selection_.category_variable,
            {.explanation = "observations with different numbers of this name are thinned apart; names as for "
                            "priority_variable"});
}

std::optional<ThinningMethod::Conflict> Thinner::conflict() const {
  if (selection_.retain_count && selection_.retain_fraction)
    return ThinningMethod::Conflict{"retain_fraction", "and retain_count exclude each other; remove one"};
  const bool has_count = selection_.retain_count || selection_.retain_fraction;
  if (traits_.stops_at_count && traits_.needs_count && !has_count && !method_->stops_itself())
    return ThinningMethod::Conflict{
        "method", fmt::format("= \"{}\" needs retain_count or retain_fraction, how many to retain", name_)};
  return method_->conflict();
}

void Thinner::set_retain_count(std::int64_t count) {
  selection_.retain_count = count;
  selection_.retain_fraction.reset();
}

std::optional<std::size_t> Thinner::total_count(std::size_t n) const {
  if (selection_.retain_count) return std::min(n, static_cast<std::size_t>(*selection_.retain_count));
  if (!selection_.retain_fraction) return std::nullopt;
  // To the nearest, but at least one of any, unless none is wanted.
  const auto rounded = static_cast<std::size_t>(std::llround(*selection_.retain_fraction * static_cast<double>(n)));
  return *selection_.retain_fraction > 0 && n > 0 ? std::clamp<std::size_t>(rounded, 1, n) : 0;
}

Result<Choice> Thinner::thin(const ObservationSet& observations) const {
  if (Result<void> finite = require_finite_values(observations); !finite) return finite.error();
  const std::size_t errors = selection_.observation_errors_k.size();
  if (errors > 0 && errors != observations.channel_count())
    return Error{ErrorKind::configuration,
                 fmt::format("[thinning] observation_errors has {} numbers, but {} channels are in use ({}); give one "
                             "for each, in this order",
                             errors, observations.channel_count(), fmt::join(observations.channels, " "))};
  const auto categories = categories_of(observations, selection_);
  if (!categories) return categories.error();
  const std::optional<std::size_t> total = total_count(observations.size());

  std::vector<std::size_t> sizes;
  for (const auto& indices : *categories) sizes.push_back(indices.size());
  const std::vector<std::size_t> shares = total ? shares_of(*total, sizes) : sizes;
  Choice all;
  for (std::size_t i = 0; i < categories->size(); ++i) {
    const auto& indices = (*categories)[i];
    const Category category = category_of(observations, indices, selection_.observation_errors_k);
    Result<Choice> choice =
        thin_category(category.observations, category.errors_k, total ? std::optional(shares[i]) : std::nullopt);
    if (!choice) return choice;
    add(*choice, indices, all);
    for (std::string& note : choice->notes)
      if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end()) all.notes.push_back(std::move(note));
    if (!all.bandwidth_km) all.bandwidth_km = choice->bandwidth_km;
  }
  sort(all);
  return all;
}

Result<Choice> Thinner::thin_category(const ObservationSet& observations, const std::vector<double>& errors_k,
                                      std::optional<std::size_t> retain_count) const {
  ThinningInput input{.observations = observations,
                      .places = places_of(observations, selection_.time_scale_km_per_hour),
                      .values = weighted_values(observations, errors_k),
                      .priority = {},
                      .retain_count = retain_count,
                      .min_separation_km = selection_.min_separation_km};
  if (selection_.priority_variable) {
    Result<std::vector<double>> priority = number_named(observations, *selection_.priority_variable);
    if (!priority) return priority.error();
    input.priority = std::move(*priority);
    // Without one: after all others.
    for (double& p : input.priority)
      if (std::isnan(p)) p = -std::numeric_limits<double>::infinity();
  }
  Result<Choice> choice = method_->choose(input);
  if (choice && selection_.min_separation_km > 0) choice->retained = separated(input, choice->retained);
  return choice;
}

ObservationSet chosen_observations(const ObservationSet& observations, const Choice& choice) {
  return choice.members.empty() ? observations.select(choice.retained)
                                : mean_observations(observations, choice.members);
}

Result<std::vector<double>> number_named(const ObservationSet& set, const std::string& name) {
  const auto numbers = [&](const auto& column) {
    std::vector<double> result;
    result.reserve(set.size());
    for (const auto& number : column) result.push_back(static_cast<double>(number));
    return result;
  };
  if (name == "platform") return numbers(set.platform);
  if (name == "instrument") return numbers(set.instrument);
  if (name == "surface") return numbers(set.surface);
  if (name == "scan_line") return numbers(set.scan_line);
  if (name == "field_of_view") return numbers(set.field_of_view);
  if (name == "latitude_deg") return set.latitude_deg;
  if (name == "longitude_deg") return set.longitude_deg;
  if (name == "time_s") {
    std::vector<double> seconds = numbers(set.time_ms);
    for (double& s : seconds) s /= 1000;
    return seconds;
  }
  if (const auto found = set.variables.find(name); found != set.variables.end()) return found->second;
  std::vector<std::string> known = {"platform",      "instrument",   "surface",       "scan_line",
                                    "field_of_view", "latitude_deg", "longitude_deg", "time_s"};
  for (const auto& [variable, column] : set.variables) known.push_back(variable);
  const auto meant = likely_meant(name, known);
  return Error{ErrorKind::configuration,
               fmt::format("[thinning] names the variable \"{}\", which these observations lack; {}", name,
                           meant ? fmt::format("did you mean \"{}\"?", *meant)
                                 : fmt::format("they have {}", fmt::join(known, ", ")))};
}

std::vector<std::size_t> shares_of(std::size_t total, const std::vector<std::size_t>& sizes) {
  const std::size_t all = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  assert(total <= all);
  std::vector<std::size_t> shares, by_remainder(sizes.size());
  std::vector<std::uint64_t> remainders;
  std::size_t given = 0;
  for (const std::size_t size : sizes) {
    shares.push_back(all ? total * size / all : 0);
    remainders.push_back(all ? total * size % all : 0);
    given += shares.back();
  }
  std::iota(by_remainder.begin(), by_remainder.end(), std::size_t{0});
  std::stable_sort(by_remainder.begin(), by_remainder.end(),
                   [&](std::size_t a, std::size_t b) { return remainders[a] > remainders[b]; });
  for (std::size_t i = 0; given < total; ++i, ++given) ++shares[by_remainder[i]];
  return shares;
}

}  // namespace thin
