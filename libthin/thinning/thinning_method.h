#pragma once

// What a thinning method is: options, and a choice of observations. Methods know nothing of files or reports, nor of
// what is the same for all of them: categories, priorities, weights, how many to retain (thinner.h).
//
// A new method is one .h/.cpp pair that derives from ThinningMethod, one line in registry.cpp, one case file in
// tests/cases, one line in tests/bench and one row in docs/methods.md.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libthin/estimation/places.h"
#include "libthin/foundation/options.h"
#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

// Indices of the retained observations, ascending.
using Retained = std::vector<std::uint32_t>;

// The observations of one category, made ready for a method.
struct ThinningInput {
  const ObservationSet& observations;       // in canonical order
  Places places;                            // n, in the metric; in groups where instruments are thinned jointly
  std::vector<double> values;               // n x channels; in units of the observation error; 0 where not measured
  std::vector<double> priority;             // n, or empty: where there is a choice, a higher one is retained
  std::optional<std::size_t> retain_count;  // for methods that can be stopped at a number; never more than n
  double min_separation_km = 0;

  std::size_t size() const { return observations.size(); }
  std::size_t channel_count() const { return observations.channel_count(); }
  std::span<const double> values_of(std::size_t i) const {
    return std::span(values).subspan(i * channel_count(), channel_count());
  }
  // Whether a is to be retained rather than b, as far as their priorities go.
  bool has_priority(std::size_t a, std::size_t b) const { return !priority.empty() && priority[a] > priority[b]; }
};

struct Choice {
  Retained retained;
  // Of methods that make observations: the members of each, ascending, whose mean goes on in their place
  // (observations/mean_observations.h). Then retained[i] is the member nearest to the mean of members[i] and stands for
  // it where places are counted. Empty: the retained go on as they are.
  std::vector<Retained> members = {};
  std::vector<std::string> notes = {};      // what a user should know, a sentence each
  std::optional<double> bandwidth_km = {};  // h of the Gaussian filter, where the method has one
};

// What goes on by this choice to whatever uses observations: the retained, or the means that were made.
ObservationSet chosen_observations(const ObservationSet& observations, const Choice& choice);

class ThinningMethod {
 public:
  virtual ~ThinningMethod() = default;

  // Which of the common options (thinner.h) make sense for the method.
  struct Traits {
    bool stops_at_count = true;       // retain_count, retain_fraction
    bool needs_count = true;          // one of the two must be given; else they are one way of stopping among others
    bool uses_values = true;          // observation_errors, instruments = "joint"
    bool uses_places = true;          // time_scale_km_per_hour
    bool takes_priority = true;       // priority_variable
    bool keeps_apart = true;          // min_separation_km; what the method itself doesn't heed is seen to after it
    bool makes_observations = false;  // what goes on is not a subset: Choice::members
  };
  virtual Traits traits() const { return {}; }

  // Adds the method's own options, with their defaults, to the table of its configuration section.
  virtual void declare_options(OptionTable& table) = 0;

  // What is wrong with the options taken together (each by itself is checked by the table): the key and the problem.
  struct Conflict {
    std::string key;
    std::string problem;
  };
  virtual std::optional<Conflict> conflict() const { return std::nullopt; }

  // Whether the method's own options stop it, so that no count is needed.
  virtual bool stops_itself() const { return false; }

  // Chooses. Values are finite. Ties go to the smaller index, so that the choice depends neither on the order of the
  // input nor on the number of threads. n = 0 and 1 are allowed.
  // Errors: input, where the method needs what these observations do not have; configuration, where they do not fit
  // together with the options, or would take too much memory. The message names the remedy.
  virtual Result<Choice> choose(const ThinningInput& input) const = 0;
};

struct MethodEntry {
  std::string name;  // as in the configuration
  std::string summary;
  std::string source;  // equation or paper
  std::unique_ptr<ThinningMethod> (*make)();
};

// All methods, by name.
std::span<const MethodEntry> thinning_methods();

// The entry of that name, or nothing.
const MethodEntry* find_thinning_method(const std::string& name);

}  // namespace thin
