#pragma once

// Thinning methods by name and options, as a configuration would make them.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "libthin/thinning/thinner.h"

namespace thin::test {

// Options that the method does not have are passed over, so that one list serves several methods.
inline Thinner thinner(const std::string& method, const std::vector<std::pair<std::string, OptionValue>>& options) {
  Thinner thinner(*find_thinning_method(method));
  OptionTable table;
  thinner.declare_options(table);
  for (const auto& [name, value] : options)
    if (const Option* option = table.find(name)) {
      const auto problem = option->assign(value);
      EXPECT_FALSE(problem) << method << ": " << name << " " << *problem;
    }
  return thinner;
}

inline Retained retained(const Thinner& thinner, const ObservationSet& set) {
  const Result<Choice> choice = thinner.thin(set);
  EXPECT_TRUE(choice) << choice.error().message;
  return choice ? choice->retained : Retained{};
}

}  // namespace thin::test
