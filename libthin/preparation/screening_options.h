#pragma once

// What is fit to be thinned, as the configuration says it ([preparation]).

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/observations/observation_set.h"

namespace thin {

struct GrossLimits {
  double minimum_k, maximum_k;
};

// Wide: nothing that the atmosphere or the surface emits lies outside. Microwave 70..340 K (hail below, hot desert
// above), infrared 150..380 K (sunlight in the short waves); 50..400 K where the instrument is unknown.
GrossLimits default_gross_limits(Instrument instrument);

// A variable that must be 0, or of which these bits must be 0. Where it is missing nothing was flagged.
struct FlagRule {
  std::string variable;
  std::optional<std::uint64_t> mask;
};

// Both limits are allowed values. Where the variable is missing the rule is not met.
struct VariableRule {
  std::string variable;
  double minimum, maximum;
};

struct ScreeningOptions {
  std::set<std::int32_t> platforms;                    // empty: all
  std::set<Instrument> instruments;                    // empty: all
  std::vector<int> channels;                           // of the only instrument; empty: all that are alive
  std::map<Instrument, std::vector<int>> channels_of;  // of an instrument by name, before `channels`
  double dead_channel_fraction = 0.5;  // missing in more than this share of a satellite's observations: dead there
  std::set<Surface> surfaces;          // empty: all
  int skip_edge = 0;                   // scan positions at each end of the line
  std::map<Instrument, int> skip_edge_of;
  double minimum_latitude_deg = -90;
  double maximum_latitude_deg = 90;
  std::optional<double> minimum_k;  // for all instruments that gross_limits does not name
  std::optional<double> maximum_k;
  std::map<Instrument, GrossLimits> gross_limits;
  std::vector<FlagRule> flags;
  std::vector<VariableRule> variables;

  GrossLimits limits_of(Instrument instrument) const;
  int skipped_edge_of(Instrument instrument) const;

  void declare(OptionTable& table);

 private:
  // As written in the configuration.
  struct Written {
    std::vector<std::string> platforms, instruments, channels, surfaces, skip_edge, gross_limits, flags, variables;
  };
  Written written_ = {{}, {}, {}, {}, {"0"}, {}, {}, {}};
};

// "sea", as the configuration spells it.
const char* surface_name(Surface surface);

}  // namespace thin
