#include "libthin/foundation/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

namespace thin {
namespace {

std::string quoted(const std::string& text) {
  return "\"" + text + "\"";
}

std::string written(bool value) {
  return value ? "true" : "false";
}
std::string written(std::int64_t value) {
  return std::to_string(value);
}
std::string written(int value) {
  return std::to_string(value);
}
std::string written(double value) {
  return fmt::format("{}", value);
}
std::string written(const std::string& value) {
  return quoted(value);
}

template <class T>
std::string written(const std::vector<T>& values) {
  std::vector<std::string> parts;
  parts.reserve(values.size());
  for (const T& value : values) parts.push_back(written(value));
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

// Phrases: whole numbers stand bare.
std::string written_phrases(const std::vector<std::string>& phrases) {
  std::vector<std::string> parts;
  parts.reserve(phrases.size());
  for (const std::string& phrase : phrases) parts.push_back(whole_number(phrase) ? phrase : quoted(phrase));
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

template <class T>
std::string written(const std::optional<T>& value) {
  return value ? written(*value) : "unset";
}

std::optional<std::string> outside_limits(double value, const std::string& text, const OptionFacts& facts) {
  const std::string unit = facts.unit.empty() ? "" : " " + facts.unit;
  if (!std::isfinite(value)) return fmt::format("must be a finite number, not {}", text);
  if (facts.above && !(value > *facts.above))
    return fmt::format("must be greater than {}{}, not {}", *facts.above, unit, text);
  if (facts.minimum && value < *facts.minimum)
    return fmt::format("must be at least {}{}, not {}", *facts.minimum, unit, text);
  if (facts.maximum && value > *facts.maximum)
    return fmt::format("must be at most {}{}, not {}", *facts.maximum, unit, text);
  return std::nullopt;
}

std::optional<std::string> not_a_choice(const std::string& value, const OptionFacts& facts) {
  if (facts.choices.empty() || std::find(facts.choices.begin(), facts.choices.end(), value) != facts.choices.end())
    return std::nullopt;
  return fmt::format("must be one of {}, not {}", fmt::join(facts.choices, ", "), quoted(value));
}

std::string kind_of(const OptionValue& value) {
  static const char* const kinds[] = {"a boolean",       "an integer",         "a number",         "text",
                                      "a list of texts", "a list of integers", "a list of numbers"};
  return kinds[value.index()];
}

std::string must_be(const std::string& wanted, const OptionValue& value) {
  return "must be " + wanted + ", not " + kind_of(value);
}

// One converter per kind of field: stores the value, or returns what is wrong with it.
using Problem = std::optional<std::string>;

Problem convert(const OptionValue& value, const OptionFacts&, bool& field) {
  const auto* boolean = std::get_if<bool>(&value);
  if (!boolean) return must_be("true or false", value);
  field = *boolean;
  return std::nullopt;
}

Problem convert(const OptionValue& value, const OptionFacts& facts, std::int64_t& field) {
  const auto* integer = std::get_if<std::int64_t>(&value);
  if (!integer) return must_be("an integer", value);
  if (Problem problem = outside_limits(static_cast<double>(*integer), written(*integer), facts)) return problem;
  field = *integer;
  return std::nullopt;
}

Problem convert(const OptionValue& value, const OptionFacts& facts, int& field) {
  std::int64_t wide = 0;
  if (Problem problem = convert(value, facts, wide)) return problem;
  if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max())
    return fmt::format("is out of range: {}", wide);
  field = static_cast<int>(wide);
  return std::nullopt;
}

Problem convert(const OptionValue& value, const OptionFacts& facts, double& field) {
  double number = 0;
  if (const auto* real = std::get_if<double>(&value))
    number = *real;
  else if (const auto* integer = std::get_if<std::int64_t>(&value))
    number = static_cast<double>(*integer);
  else
    return must_be("a number", value);
  if (Problem problem = outside_limits(number, written(number), facts)) return problem;
  field = number;
  return std::nullopt;
}

Problem convert(const OptionValue& value, const OptionFacts& facts, std::string& field) {
  const auto* text = std::get_if<std::string>(&value);
  if (!text) return must_be("text", value);
  if (Problem problem = not_a_choice(*text, facts)) return problem;
  field = *text;
  return std::nullopt;
}

template <class T>
Problem convert(const OptionValue& value, const OptionFacts& facts, std::optional<T>& field) {
  T inner{};
  if (Problem problem = convert(value, facts, inner)) return problem;
  field = std::move(inner);
  return std::nullopt;
}

// The elements of any list; nothing where the value is not a list.
std::optional<std::vector<OptionValue>> elements_of(const OptionValue& value) {
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value))
    return std::vector<OptionValue>(texts->begin(), texts->end());
  if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&value))
    return std::vector<OptionValue>(integers->begin(), integers->end());
  if (const auto* numbers = std::get_if<std::vector<double>>(&value))
    return std::vector<OptionValue>(numbers->begin(), numbers->end());
  return std::nullopt;
}

// The phrases of a list, or of one text or number alone.
std::optional<std::vector<std::string>> phrases_of(const OptionValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return std::vector{*text};
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::vector{written(*integer)};
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) return *texts;
  const auto* integers = std::get_if<std::vector<std::int64_t>>(&value);
  if (!integers) return std::nullopt;
  std::vector<std::string> phrases;
  for (const std::int64_t integer : *integers) phrases.push_back(written(integer));
  return phrases;
}

template <class T>
Problem convert(const OptionValue& value, const OptionFacts& facts, std::vector<T>& field) {
  const auto elements = elements_of(value);
  if (!elements) return must_be("a list", value);
  std::vector<T> list(elements->size());
  for (std::size_t i = 0; i < list.size(); ++i)
    if (Problem problem = convert((*elements)[i], facts, list[i])) return fmt::format("element {} {}", i + 1, *problem);
  field = std::move(list);
  return std::nullopt;
}

template <class T>
auto assigner(T& field, const OptionFacts& facts) {
  return [&field, facts](const OptionValue& value) { return convert(value, facts, field); };
}

template <class T>
auto writer(const T& field) {
  return [&field] { return written(field); };
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

void OptionTable::add_option(std::string name, std::string type, OptionFacts facts,
                             std::function<std::optional<std::string>(const OptionValue&)> assign,
                             std::function<std::string()> current_value) {
  assert(!find(name) && "an option is declared once");
  std::string default_value = current_value();
  options_.push_back({std::move(name), std::move(type), std::move(default_value), std::move(facts), std::move(assign),
                      std::move(current_value)});
}

void OptionTable::add(std::string name, bool& field, const OptionFacts& facts) {
  add_option(std::move(name), "boolean", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, int& field, const OptionFacts& facts) {
  add_option(std::move(name), "integer", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, std::int64_t& field, const OptionFacts& facts) {
  add_option(std::move(name), "integer", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, double& field, const OptionFacts& facts) {
  add_option(std::move(name), "number", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, std::string& field, const OptionFacts& facts) {
  add_option(std::move(name), "text", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, std::optional<std::int64_t>& field, const OptionFacts& facts) {
  add_option(std::move(name), "integer", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, std::optional<double>& field, const OptionFacts& facts) {
  add_option(std::move(name), "number", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, std::optional<std::string>& field, const OptionFacts& facts) {
  add_option(std::move(name), "text", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, std::vector<std::string>& field, const OptionFacts& facts) {
  add_option(std::move(name), "list of texts", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, std::vector<int>& field, const OptionFacts& facts) {
  add_option(std::move(name), "list of integers", facts, assigner(field, facts), writer(field));
}
void OptionTable::add(std::string name, std::vector<double>& field, const OptionFacts& facts) {
  add_option(std::move(name), "list of numbers", facts, assigner(field, facts), writer(field));
}

void OptionTable::add_phrases(std::string name, std::vector<std::string>& field, const OptionFacts& facts,
                              const Understand& understand) {
  auto assign = [&field, understand](const OptionValue& value) -> Problem {
    auto phrases = phrases_of(value);
    if (!phrases) return must_be("a list of texts or integers", value);
    if (Problem problem = understand(*phrases)) return problem;
    field = std::move(*phrases);
    return std::nullopt;
  };
  add_option(std::move(name), "list of texts or integers", facts, std::move(assign),
             [&field] { return written_phrases(field); });
}

void OptionTable::add_text_option(std::string name, OptionFacts facts, std::function<void(const std::string&)> store,
                                  std::function<std::string()> load) {
  auto assign = [facts, store = std::move(store)](const OptionValue& value) -> std::optional<std::string> {
    std::string text;
    if (Problem problem = convert(value, facts, text)) return problem;
    store(text);
    return std::nullopt;
  };
  auto current = [load = std::move(load)] { return quoted(load()); };
  add_option(std::move(name), "text", std::move(facts), std::move(assign), std::move(current));
}

const Option* OptionTable::find(const std::string& name) const {
  const auto found = std::find_if(options_.begin(), options_.end(), [&](const Option& o) { return o.name == name; });
  return found == options_.end() ? nullptr : &*found;
}

OptionTable OptionTable::without(const std::vector<std::string>& names) const {
  OptionTable rest;
  for (const Option& option : options_)
    if (std::find(names.begin(), names.end(), option.name) == names.end()) rest.options_.push_back(option);
  return rest;
}

std::vector<std::string> words_of(const std::string& phrase) {
  std::vector<std::string> words(1);
  for (const char letter : phrase) {
    if (letter != ' ' && letter != ',' && letter != '\t')
      words.back() += letter;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::optional<int> whole_number(const std::string& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return number;
}

std::optional<double> finite_number(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty() || !std::isfinite(number))
    return std::nullopt;
  return number;
}

std::optional<std::string> likely_meant(const std::string& name, const std::vector<std::string>& known) {
  const std::string* best = nullptr;
  std::size_t best_distance = name.size() / 3 + 2;  // more than every third letter wrong: something else was meant
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best_distance) best = &candidate, best_distance = distance;
  }
  return best ? std::optional(*best) : std::nullopt;
}

}  // namespace thin
