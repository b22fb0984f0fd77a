#pragma once

// A whole file of BUFR messages: from bytes to observations.

#include <cstdint>
#include <span>
#include <string>

#include "libthin/formats/bufr_scanner.h"
#include "libthin/formats/observation_file.h"

namespace thin {

// Reads the soundings of every message; errors as read_observations. `name` stands for the file in messages. Where
// there are several instruments, the observations come instrument by instrument, each in the order of the file.
Result<ReadObservations> read_bufr(std::span<const std::uint8_t> bytes, const std::string& name,
                                   BufrTemperature temperature = BufrTemperature::brightness);

// The error that a file with a cut end is, or nothing.
Result<void> check_complete(const BufrScan& scan, const std::string& name);

}  // namespace thin
