#include "libthin/thinning/eea.h"

#include <fmt/format.h>

#include "libthin/estimation/gme_grid.h"
#include "libthin/estimation/variogram.h"

namespace thin {
namespace {

// Insertion places its first observations as if each stood alone for all within its reach.
std::vector<std::string> warnings_of_insertion(const ThinningInput& input, double bandwidth_km) {
  const auto variogram = fitted_variogram(input.places, input.values, input.channel_count());
  if (!variogram || bandwidth_km <= variogram->correlation_length_km / 2) return {};
  return {
      fmt::format("the bandwidth of {:.0f} km exceeds half the signal's correlation length of {:.0f} km, too much "
                  "for insertion: choose a smaller bandwidth_km, or a method by removal",
                  bandwidth_km, variogram->correlation_length_km)};
}

}  // namespace

void Eea::declare_options(OptionTable& table) {
  bandwidth_.declare(table);
  if (points_ == EvaluationPoints::grid)
    table.add(
        "level", level_,
        {.unit = "subdivisions",
         .minimum = 0,
         .maximum = kMaximumGmeLevel,
         .explanation = "of the GME grid that the error is taken on: 10*4^level + 2 vertices, 6 is about 112 km"});
  table.add_choice(
      "update", update_, std::vector<std::pair<std::string, Update>>{{"full", Update::full}, {"lazy", Update::lazy}},
      {.explanation = "full: each step is the exact greedy choice; lazy: increments are recomputed only at "
                      "the front of the queue"});
  table.add("max_estimation_error", max_estimation_error_k2_,
            {.unit = "K^2",
             .minimum = 0,
             .explanation = "stop where E reaches this, summed over channels (in units of observation_errors, if "
                            "given); alone, or together with a number to retain"});
  refinement_.declare(table);
}

std::optional<ThinningMethod::Conflict> Eea::conflict() const {
  const auto conflict = bandwidth_.conflict();
  return conflict ? std::optional(Conflict{conflict->key, conflict->problem}) : std::nullopt;
}

Result<NeighbourhoodTable> Eea::table(const ThinningInput& input, double bandwidth_km) const {
  const GaussianFilter filter{bandwidth_km};
  if (points_ == EvaluationPoints::observations) return neighbourhood_table(input.places, filter);
  return neighbourhood_table(evaluation_places(gme_grid(level_), input.places, bandwidth_km), input.places, filter);
}

Result<Choice> Eea::choose(const ThinningInput& input) const {
  const Result<double> bandwidth = bandwidth_.choose(input.places, input.observations.values, input.channel_count());
  if (!bandwidth) return bandwidth.error();
  Result<NeighbourhoodTable> rows = table(input, *bandwidth);
  if (!rows) return rows.error();
  Choice choice;
  choice.bandwidth_km = *bandwidth;
  if (bandwidth_.rule != BandwidthOptions::Rule::fixed)
    choice.notes.push_back(fmt::format("the bandwidth chosen is {:.1f} km", *bandwidth));
  if (direction_ == Direction::insertion)
    for (std::string& warning : warnings_of_insertion(input, *bandwidth)) choice.notes.push_back(std::move(warning));

  const bool removal = direction_ == Direction::removal;
  EstimationSums sums(std::move(*rows), input.values, input.channel_count(),
                      removal ? EstimationSums::Start::with_all : EstimationSums::Start::with_none);
  const Separation separation(input.observations.position_km, input.min_separation_km);
  GreedyGoal goal{.retain_count = input.retain_count.value_or(removal ? 0 : input.size()),
                  .priority = input.priority,
                  .separation = &separation};
  if (max_estimation_error_k2_)
    goal.error_sum = *max_estimation_error_k2_ * static_cast<double>(sums.evaluation_point_count());
  if (removal)
    remove_greedily(sums, goal, update_);
  else
    insert_greedily(sums, goal, update_);
  refine(sums, {.priority = input.priority, .separation = &separation}, refinement_);
  choice.retained = sums.retained();
  return choice;
}

}  // namespace thin
