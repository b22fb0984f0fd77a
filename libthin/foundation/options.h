#pragma once

// Options, each declared once: name, unit, default, limits, explanation. From that one declaration come the reading of
// the configuration (foundation/configuration.h), the errors, `thin methods` and the tables in docs/.
//
//   struct StepwiseOptions {
//     int step = 3;
//     void declare(OptionTable& table) {
//       table.add("step", step, {.unit = "lines and fields of view", .minimum = 1, .explanation = "keep every
//       step-th"});
//     }
//   };
//
// The table keeps references to the fields that it was given: it must not outlive them.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace thin {

// A value as a configuration file can hold it.
using OptionValue = std::variant<bool, std::int64_t, double, std::string, std::vector<std::string>,
                                 std::vector<std::int64_t>, std::vector<double>>;

struct OptionFacts {
  std::string unit = {};  // "km", "K", "s"; empty for none
  std::optional<double> minimum = {};
  std::optional<double> maximum = {};
  std::optional<double> above = {};  // exclusive lower limit
  std::vector<std::string> choices = {};
  std::string explanation = {};
};

struct Option {
  std::string name;
  std::string type;           // "number", "integer", "boolean", "text", "list of ..."
  std::string default_value;  // as it would be written in TOML; "unset" where there is none
  OptionFacts facts;
  // Stores the value in the field. Returns what is wrong with it, or nothing.
  std::function<std::optional<std::string>(const OptionValue&)> assign;
  std::function<std::string()> current_value;  // as default_value, but now
};

class OptionTable {
 public:
  void add(std::string name, bool& field, const OptionFacts& facts);
  void add(std::string name, int& field, const OptionFacts& facts);
  void add(std::string name, std::int64_t& field, const OptionFacts& facts);
  void add(std::string name, double& field, const OptionFacts& facts);
  void add(std::string name, std::string& field, const OptionFacts& facts);
  void add(std::string name, std::optional<std::int64_t>& field, const OptionFacts& facts);
  void add(std::string name, std::optional<double>& field, const OptionFacts& facts);
  void add(std::string name, std::optional<std::string>& field, const OptionFacts& facts);
  void add(std::string name, std::vector<std::string>& field, const OptionFacts& facts);
  void add(std::string name, std::vector<int>& field, const OptionFacts& facts);
  void add(std::string name, std::vector<double>& field, const OptionFacts& facts);

  // An enumeration, written in the configuration by the names given here.
  template <class Enumeration>
  void add_choice(const std::string& name, Enumeration& field,
                  const std::vector<std::pair<std::string, Enumeration>>& names, OptionFacts facts) {
    for (const auto& entry : names) facts.choices.push_back(entry.first);
    add_text_option(
        name, std::move(facts),
        [&field, names](const std::string& text) {
          for (const auto& [choice, value] : names)
            if (choice == text) field = value;
        },
        [&field, names] {
          for (const auto& [choice, value] : names)
            if (value == field) return choice;
          return std::string();
        });
  }

  // A list of texts or whole numbers, each kept as text ("5", "mhs 3 4 5"), with a grammar of its own: `understand` is
  // given the list and returns what is wrong with it, or nothing; `field` changes only where nothing is. One text or
  // number alone is a list of one.
  using Understand = std::function<std::optional<std::string>(const std::vector<std::string>&)>;
  void add_phrases(std::string name, std::vector<std::string>& field, const OptionFacts& facts,
                   const Understand& understand);

  const std::vector<Option>& options() const { return options_; }
  const Option* find(const std::string& name) const;

  // The table less the options of these names, for the same fields.
  OptionTable without(const std::vector<std::string>& names) const;

 private:
  void add_text_option(std::string name, OptionFacts facts, std::function<void(const std::string&)> store,
                       std::function<std::string()> load);
  void add_option(std::string name, std::string type, OptionFacts facts,
                  std::function<std::optional<std::string>(const OptionValue&)> assign,
                  std::function<std::string()> current_value);

  std::vector<Option> options_;
};

// The words of a phrase, parted by blanks or commas.
std::vector<std::string> words_of(const std::string& phrase);

// A whole number or a number, all of the text; nothing else, and no infinity.
std::optional<int> whole_number(const std::string& text);
std::optional<double> finite_number(const std::string& text);

// The known name most like `name`, where one is so like it that it was probably meant.
std::optional<std::string> likely_meant(const std::string& name, const std::vector<std::string>& known);

}  // namespace thin
