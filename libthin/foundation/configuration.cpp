#include "libthin/foundation/configuration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cerrno>
#include <fstream>
#include <set>
#include <sstream>

namespace thin {
namespace {

struct Problem {
  std::uint32_t line;
  std::uint32_t column;
  std::string text;
};

std::string kind_of(const toml::node& node) {
  std::ostringstream text;
  text << node.type();
  return text.str();
}

template <class T>
std::optional<OptionValue> list_of(const toml::array& array) {
  std::vector<T> list;
  for (const toml::node& node : array) {
    const auto value = node.value<T>();
    if (!value) return std::nullopt;
    list.push_back(*value);
  }
  return list;
}

std::optional<OptionValue> option_value(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::boolean:
      return OptionValue(**node.as_boolean());
    case toml::node_type::integer:
      return OptionValue(**node.as_integer());
    case toml::node_type::floating_point:
      return OptionValue(**node.as_floating_point());
    case toml::node_type::string:
      return OptionValue(**node.as_string());
    case toml::node_type::array: {
      const toml::array& array = *node.as_array();
      if (array.empty() || array.is_homogeneous(toml::node_type::string)) return list_of<std::string>(array);
      if (array.is_homogeneous(toml::node_type::integer)) return list_of<std::int64_t>(array);
      if (array.is_homogeneous(toml::node_type::boolean)) return std::nullopt;
      return list_of<double>(array);
    }
    default:
      return std::nullopt;
  }
}

}  // namespace

struct Configuration::Content {
  std::string name;
  toml::table root;
  std::set<std::string> known_sections;
  std::set<std::string> known_lists;
  std::vector<Problem> problems;

  const toml::table* section(const std::string& section) const { return toml::at_path(root, section).as_table(); }

  void add_problem(const toml::source_region& where, std::string text) {
    problems.push_back({where.begin.line, where.begin.column, std::move(text)});
  }
};

Result<Configuration> Configuration::read(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  // Streaming nothing sets the stream's fail bit, so an empty file (a configuration of defaults) is told by errno.
  if (file) text << file.rdbuf();
  if (errno != 0) {
    Error error = system_error("read the configuration", path, errno);
    if (error.kind == ErrorKind::internal) error.kind = ErrorKind::configuration;
    return error;
  }
  return parse(text.str(), path);
}

Result<Configuration> Configuration::parse(const std::string& text, const std::string& name) {
  auto content = std::make_shared<Content>();
  content->name = name;
  try {
    content->root = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const auto& where = error.source().begin;
    return Error{ErrorKind::configuration,
                 fmt::format("{}:{}:{}: {}", name, where.line, where.column, error.description())};
  }
  return Configuration(std::move(content));
}

const std::string& Configuration::name() const {
  return content_->name;
}

bool Configuration::has_section(const std::string& section) const {
  return content_->section(section) != nullptr;
}

std::size_t Configuration::list_size(const std::string& section) {
  content_->known_lists.insert(section);
  const toml::array* list = toml::at_path(content_->root, section).as_array();
  return list && list->is_homogeneous(toml::node_type::table) ? list->size() : 0;
}

std::optional<std::string> Configuration::peek_text(const std::string& section, const std::string& key) const {
  const toml::table* table = content_->section(section);
  return table ? (*table)[key].value_exact<std::string>() : std::nullopt;
}

void Configuration::read_section(const std::string& section, OptionTable& options) {
  content_->known_sections.insert(section);
  const toml::table* table = content_->section(section);
  if (!table) return;
  for (const auto& [toml_key, node] : *table) {
    const std::string key(toml_key.str());
    if (const std::string path = section + "." + key; content_->known_lists.contains(path)) {
      if (!node.is_array_of_tables())
        content_->add_problem(toml_key.source(), fmt::format("{0} is a list of sections: write [[{0}]]", path));
      continue;
    }
    const Option* option = options.find(key);
    if (!option) {
      std::vector<std::string> known;
      for (const Option& each : options.options()) known.push_back(each.name);
      const auto meant = likely_meant(key, known);
      content_->add_problem(toml_key.source(),
                            fmt::format("unknown key \"{}\" in [{}]; {}", key, section,
                                        meant ? fmt::format("did you mean \"{}\"?", *meant)
                                              : fmt::format("known are {}", fmt::join(known, ", "))));
      continue;
    }
    const auto value = option_value(node);
    const auto problem =
        value ? option->assign(*value) : fmt::format("must be {}, not {}", option->type, kind_of(node));
    if (problem) content_->add_problem(node.source(), fmt::format("{}.{} {}", section, key, *problem));
  }
}

void Configuration::ignore_section(const std::string& section) {
  content_->known_sections.insert(section);
}

void Configuration::add_problem(const std::string& section, const std::string& key, const std::string& problem) {
  const toml::table* table = content_->section(section);
  const toml::node* node = table ? table->get(key) : nullptr;
  const toml::source_region where = node ? node->source() : table ? table->source() : toml::source_region{};
  content_->add_problem(where, fmt::format("{}.{} {}", section, key, problem));
}

Result<void> Configuration::finish() const {
  std::vector<Problem> problems = content_->problems;
  const std::vector<std::string> known(content_->known_sections.begin(), content_->known_sections.end());
  for (const auto& [key, node] : content_->root) {
    const std::string name(key.str());
    if (!node.is_table()) {
      problems.push_back({key.source().begin.line, key.source().begin.column,
                          fmt::format("\"{}\" stands outside of any section as a {}; sections are [{}]", name,
                                      kind_of(node), fmt::join(known, "], ["))});
    } else if (!content_->known_sections.contains(name)) {
      const auto meant = likely_meant(name, known);
      problems.push_back({key.source().begin.line, key.source().begin.column,
                          fmt::format("unknown section [{}]; {}", name,
                                      meant ? fmt::format("did you mean [{}]?", *meant)
                                            : fmt::format("known are [{}]", fmt::join(known, "], [")))});
    }
  }
  if (problems.empty()) return {};
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
  std::vector<std::string> lines;
  for (const Problem& problem : problems) {
    const std::string where = problem.line ? fmt::format(":{}:{}", problem.line, problem.column) : "";
    lines.push_back(fmt::format("{}{}: {}", content_->name, where, problem.text));
  }
  return Error{ErrorKind::configuration, fmt::format("{}", fmt::join(lines, "\n"))};
}

std::string Configuration::canonical_text() const {
  std::ostringstream text;  // toml::table keeps its keys sorted, so layout and comments fall away here
  text << toml::toml_formatter(content_->root);
  return text.str();
}

}  // namespace thin
