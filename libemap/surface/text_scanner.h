#pragma once

// Lines and numbers of text formats, with the line number that errors need.

#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace emap {

class TextScanner {
 public:
  explicit TextScanner(std::span<const std::uint8_t> bytes)
      : rest_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

  // The next line that holds more than blanks and a comment, without either; nothing at the end.
  std::optional<std::string_view> next_line() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_number_;
      line = trimmed(line.substr(0, std::min(line.find('#'), line.size())));
      if (!line.empty()) return line;
    }
    return std::nullopt;
  }

  std::size_t line_number() const { return line_number_; }  // of the line that next_line() returned; from 1
  std::string at_line() const { return "line " + std::to_string(line_number_); }
  std::size_t bytes_left() const { return rest_.size(); }

  static std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
  }

  // Takes the first word off the line; empty where there is none.
  static std::string_view take_word(std::string_view& line) {
    line = trimmed(line);
    const std::string_view word = line.substr(0, std::min(line.find_first_of(kBlanks), line.size()));
    line.remove_prefix(word.size());
    return word;
  }

  // Takes the first number off the line. Nothing, and the line as it was, where the first word is none.
  template <class Number>
  static std::optional<Number> take_number(std::string_view& line) {
    std::string_view rest = line;
    std::string_view word = take_word(rest);
    if (word.starts_with('+')) word.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    line = rest;
    return value;
  }

 private:
  static constexpr const char* kBlanks = " \t\r\v\f,";

  std::string_view rest_;
  std::size_t line_number_ = 0;
};

}  // namespace emap
