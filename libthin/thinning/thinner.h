#pragma once

// A method with everything around it that is the same for all methods: how many to retain, categories that are thinned
// apart, priorities, several instruments, weights by observation error, time as a coordinate, least separation.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libthin/thinning/thinning_method.h"

namespace thin {

struct SelectionOptions {
  std::optional<std::int64_t> retain_count;
  std::optional<double> retain_fraction;
  std::optional<std::string> priority_variable;
  std::optional<std::string> category_variable;
  enum class Instruments { apart, joint };
  Instruments instruments = Instruments::apart;
  std::vector<double> observation_errors_k;  // of the channels in use, in their order; empty: all 1
  double time_scale_km_per_hour = 0;
  double min_separation_km = 0;
};

class Thinner {
 public:
  // REQUIRES: entry is of the registry
  explicit Thinner(const MethodEntry& entry);

  const std::string& method_name() const { return name_; }

  // The common options that make sense for the method, and its own.
  void declare_options(OptionTable& table);
  std::optional<ThinningMethod::Conflict> conflict() const;

  // For callers that thin the same observations to several numbers.
  void set_retain_count(std::int64_t count);
  bool stops_at_count() const { return traits_.stops_at_count; }
  bool makes_observations() const { return traits_.makes_observations; }

  // Chooses. `observations` are in canonical order. Categories share a retain_count by their sizes.
  // Errors: input, where a value that is measured is not finite; configuration, where an option names a variable that
  // these observations lack; and those of the method.
  Result<Choice> thin(const ObservationSet& observations) const;

 private:
  Result<Choice> thin_category(const ObservationSet& observations, const std::vector<double>& errors_k,
                               std::optional<std::size_t> retain_count) const;
  std::optional<std::size_t> total_count(std::size_t n) const;

  std::string name_;
  std::unique_ptr<ThinningMethod> method_;
  ThinningMethod::Traits traits_;
  SelectionOptions selection_;
};

// The number per observation that goes by this name: "platform", "instrument", "surface", "scan_line", "field_of_view",
// "latitude_deg", "longitude_deg", "time_s" (since 1970), or one of the set's variables.
// Error: configuration, where there is none, with the names that there are.
Result<std::vector<double>> number_named(const ObservationSet& observations, const std::string& name);

// `total` shared out in proportion to the sizes, none getting more than its size: whole shares first, then one each by
// descending remainder, then by place. REQUIRES: total <= sum of sizes
std::vector<std::size_t> shares_of(std::size_t total, const std::vector<std::size_t>& sizes);

}  // namespace thin
