#include "libthin/observations/time.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <regex>

namespace thin {
namespace {

constexpr std::int64_t kDayMs = 86'400'000;

}  // namespace

std::optional<std::int64_t> to_time_ms(const CivilTime& civil) {
  const std::chrono::year_month_day date(std::chrono::year(civil.year),
                                         std::chrono::month(static_cast<unsigned>(civil.month)),
                                         std::chrono::day(static_cast<unsigned>(civil.day)));
  const bool clock_ok = civil.hour >= 0 && civil.hour <= 23 && civil.minute >= 0 && civil.minute <= 59 &&
                        civil.second >= 0 && civil.second < 61;
  if (civil.month < 1 || civil.month > 12 || civil.day < 1 || civil.day > 31 || !date.ok() || !clock_ok)
    return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return days * kDayMs + (civil.hour * 60 + civil.minute) * std::int64_t{60'000} + std::llround(civil.second * 1000);
}

CivilTime to_civil(std::int64_t time_ms) {
  const std::chrono::sys_time<std::chrono::milliseconds> instant{std::chrono::milliseconds(time_ms)};
  const auto day = std::chrono::floor<std::chrono::days>(instant);
  const std::chrono::year_month_day date(day);
  const std::int64_t rest_ms = (instant - day).count();
  return {static_cast<int>(date.year()),
          static_cast<int>(static_cast<unsigned>(date.month())),
          static_cast<int>(static_cast<unsigned>(date.day())),
          static_cast<int>(rest_ms / 3'600'000),
          static_cast<int>(rest_ms / 60'000 % 60),
          static_cast<double>(rest_ms % 60'000) / 1000};
}

std::string to_iso8601(std::int64_t time_ms) {
  const CivilTime t = to_civil(time_ms);
  const auto whole = static_cast<int>(t.second);
  const auto fraction_ms = static_cast<int>(std::lround((t.second - whole) * 1000));
  const std::string fraction = fraction_ms ? fmt::format(".{:03}", fraction_ms) : "";
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}{}Z", t.year, t.month, t.day, t.hour, t.minute, whole,
                     fraction);
}

std::string to_compact_iso8601(std::int64_t time_ms) {
  const CivilTime t = to_civil(time_ms);
  return fmt::format("{:04}{:02}{:02}T{:02}{:02}{:02}Z", t.year, t.month, t.day, t.hour, t.minute,
                     static_cast<int>(t.second));
}

std::optional<std::int64_t> from_iso8601(const std::string& text) {
  CivilTime t;
  int used = 0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2d%n", &t.year, &t.month, &t.day, &used) != 3) return std::nullopt;
  std::string rest = text.substr(static_cast<std::size_t>(used));
  if (!rest.empty() && rest.back() == 'Z') rest.pop_back();
  if (!rest.empty()) {
    used = 0;
    if (std::sscanf(rest.c_str(), "T%2d:%2d%n", &t.hour, &t.minute, &used) != 2) return std::nullopt;
    rest = rest.substr(static_cast<std::size_t>(used));
  }
  if (!rest.empty()) {
    used = 0;
    if (std::sscanf(rest.c_str(), ":%lf%n", &t.second, &used) != 1 || static_cast<std::size_t>(used) != rest.size())
      return std::nullopt;
  }
  return to_time_ms(t);
}

std::optional<std::int64_t> duration_ms_from_iso8601(const std::string& text) {
  static const std::regex form(R"(P(?:(\d{1,6})D)?(?:T(?=\d)(?:(\d{1,6})H)?(?:(\d{1,6})M)?(?:(\d{1,9})S)?)?)");
  constexpr std::int64_t unit_ms[] = {86'400'000, 3'600'000, 60'000, 1'000};
  std::smatch parts;
  if (!std::regex_match(text, parts, form) || text == "P") return std::nullopt;
  std::int64_t sum_ms = 0;
  for (std::size_t i = 0; i < std::size(unit_ms); ++i)
    if (parts[i + 1].matched) sum_ms += unit_ms[i] * std::stoll(parts[i + 1].str());
  return sum_ms;
}

}  // namespace thin
