#pragma once

// Names of satellites by their number in WMO common code table C-5 ("Satellite identifier").

#include <cstdint>
#include <optional>
#include <string>

namespace thin {

// "Metop-A" for 4, "NOAA-19" for 223; "satellite 999" where the table here has no name;
// "unknown satellite" for a negative number.
std::string platform_name(std::int32_t platform);

// The number of a name as platform_name gives it, any case.
std::optional<std::int32_t> platform_number(const std::string& name);

}  // namespace thin
