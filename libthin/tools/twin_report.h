#pragma once

// A twin experiment as text: JSON with every case's numbers, the same bytes each time, and a table for people.

#include <string>

#include "libthin/tools/twin_settings.h"

namespace thin {

std::string twin_json(const Twin& twin, const TwinSettings& settings);
std::string twin_table(const Twin& twin, const TwinSettings& settings);

std::string cycles_json(const TwinCycles& cycles, const TwinSettings& settings);
std::string cycles_table(const TwinCycles& cycles, const TwinSettings& settings);

}  // namespace thin
