#pragma once

// Times are milliseconds since 1970-01-01T00:00:00Z, without leap seconds, in an std::int64_t called ..._ms.

#include <cstdint>
#include <optional>
#include <string>

namespace thin {

// A UTC date and time as BUFR holds it. second may be 60 (a leap second, or a rounded 59.9996) and counts on.
struct CivilTime {
  int year = 1970, month = 1, day = 1, hour = 0, minute = 0;
  double second = 0;
};

// Rounded to the nearest millisecond. Nothing where a field is out of range (month 13, 30 February, second > 60).
std::optional<std::int64_t> to_time_ms(const CivilTime& civil);
CivilTime to_civil(std::int64_t time_ms);

// "2004-07-21T22:30:00Z"; with milliseconds, "2004-07-21T22:30:00.250Z", only where they are not zero.
std::string to_iso8601(std::int64_t time_ms);

// "20040721T223000Z": for file names.
std::string to_compact_iso8601(std::int64_t time_ms);

// Reads "YYYY-MM-DDTHH:MM:SSZ" with optional fraction, seconds and Z, or a date alone (midnight).
std::optional<std::int64_t> from_iso8601(const std::string& text);

// Reads a duration of days, hours, minutes and seconds, all whole and in this order: "PT1H", "P1DT12H", "PT1M30S".
std::optional<std::int64_t> duration_ms_from_iso8601(const std::string& text);

}  // namespace thin
