#pragma once

// The variants that a section such as [evaluate] compares: its list `methods`, and [[evaluate.variant]].

#include <optional>
#include <string>
#include <vector>

#include "libthin/analysis/variant.h"
#include "libthin/foundation/configuration.h"

namespace thin {

// The keys of [[....variant]] beside those of its method.
struct VariantKeys {
  std::string method;
  std::string label;
  std::string fit = "auto";

  void declare(OptionTable& table);
};

// `count` is the list's size, asked for before the section was read (Configuration::list_size). Without methods and
// variants: all methods that there are. bandwidth_km: of every variant that has one and does not say otherwise;
// nothing: the methods' own. Problems are left to Configuration::finish().
std::vector<Variant> read_variants(Configuration& configuration, const std::string& section, std::size_t count,
                                   const std::vector<std::string>& methods, std::optional<double> bandwidth_km);

}  // namespace thin
