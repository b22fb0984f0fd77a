#pragma once

// A TOML file whose every key must be declared: reads sections into option tables, and names file, line, value and
// remedy for whatever does not fit.
//
//   Result<Configuration> file = Configuration::read("thind.toml");
//   file->read_section("thinning", table);   // may be called for any number of sections
//   Result<void> all_good = file->finish();  // the collected problems, and the sections that nobody asked for

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/foundation/result.h"

namespace thin {

class Configuration {
 public:
  // Errors: temporary or configuration, where the file can't be read or is no TOML (with line and column).
  static Result<Configuration> read(const std::string& path);
  // The same from memory; `name` stands for the path in messages.
  static Result<Configuration> parse(const std::string& text, const std::string& name);

  bool has_section(const std::string& section) const;

  // How many [[section]] there are, such as [[evaluate.variant]]; they are then read as "evaluate.variant[0]" and so
  // on. To be asked before the section around them is read.
  std::size_t list_size(const std::string& section);

  // Text at section.key, where it is there and is text: for choices that decide what else may be in the section.
  std::optional<std::string> peek_text(const std::string& section, const std::string& key) const;

  // Assigns every key of [section] to its option. Unknown keys and unfit values are collected for finish().
  // A section that is absent leaves the defaults.
  void read_section(const std::string& section, OptionTable& table);

  // Marks [section] as another program's: neither read nor complained of.
  void ignore_section(const std::string& section);

  // Adds a problem at section.key (or at the section, or the file, where the key is absent) for finish() to report.
  void add_problem(const std::string& section, const std::string& key, const std::string& problem);

  // Error kind configuration with one line per problem, in the order of the file; ok where there was none.
  Result<void> finish() const;

  // Every key = value as read, by section and key: what to hash or print when asking "was it the same configuration?"
  std::string canonical_text() const;

  const std::string& name() const;

 private:
  struct Content;
  explicit Configuration(std::shared_ptr<Content> content) : content_(std::move(content)) {}
  std::shared_ptr<Content> content_;
};

}  // namespace thin
