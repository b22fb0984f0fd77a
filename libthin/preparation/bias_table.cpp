#include "libthin/preparation/bias_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "libthin/foundation/options.h"
#include "libthin/observations/platforms.h"

namespace thin {
namespace {

using Fields = std::vector<std::string>;
using Problem = std::optional<std::string>;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

Fields fields_of(const std::string& line) {
  Fields fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(trimmed(field));
  if (line.ends_with(',')) fields.emplace_back();
  return fields;
}

// Calls `take` with the fields of every line behind the one that names the columns.
Result<void> each_line(const std::string& text, const std::string& name, const Fields& columns,
                       const std::function<Problem(const Fields&)>& take) {
  const std::string wanted = fmt::format("{}", fmt::join(columns, ","));
  const auto wrong = [&](int line, const std::string& problem) {
    return Error{ErrorKind::configuration, fmt::format("{}:{}: {}", name, line, problem)};
  };
  std::istringstream stream(text);
  int number = 0;
  bool named = false;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (trimmed(line).empty() || trimmed(line).starts_with('#')) continue;
    const Fields fields = fields_of(line);
    if (!named && fields != columns)
      return wrong(number, fmt::format("the first line must name the columns, \"{}\", not \"{}\"", wanted, line));
    if (named && fields.size() != columns.size())
      return wrong(number, fmt::format("{} fields instead of {} ({})", fields.size(), columns.size(), wanted));
    if (named)
      if (const Problem problem = take(fields)) return wrong(number, *problem);
    named = true;
  }
  if (!named) return wrong(number, fmt::format("the line that names the columns, \"{}\", is missing", wanted));
  return {};
}

// The first three fields: satellite, instrument, channel.
Problem read_channel(const Fields& fields, SounderChannel& channel) {
  const std::optional<int> number = whole_number(fields[0]);
  const std::optional<std::int32_t> platform = number ? number : platform_number(fields[0]);
  if (!platform)
    return fmt::format("satellite \"{}\" is not known: write a name like \"NOAA-19\" or its WMO number", fields[0]);
  const std::optional<Instrument> instrument = find_instrument(fields[1]);
  if (!instrument)
    return fmt::format("instrument \"{}\" is not known: write amsua, amsub, mhs, hirs or atms", fields[1]);
  const std::optional<int> which = whole_number(fields[2]);
  if (!which || *which < 1) return fmt::format("channel \"{}\" must be a number from 1 on", fields[2]);
  channel = {{*platform, *instrument}, *which};
  return std::nullopt;
}

Problem read_number(const std::string& text, const char* column, double& number) {
  const std::optional<double> read = finite_number(text);
  if (!read) return fmt::format("{} \"{}\" must be a number", column, text);
  number = *read;
  return std::nullopt;
}

// "constant", "name" or "name^2".
Problem read_predictor(const std::string& text, BiasPredictor& predictor) {
  const std::size_t caret = text.find('^');
  predictor.variable = text.substr(0, caret);
  if (caret != std::string::npos) {
    const std::optional<int> power = whole_number(text.substr(caret + 1));
    if (!power || *power < 1 || *power > 9)
      return fmt::format("the power of predictor \"{}\" must be a number from 1 to 9", text);
    predictor.power = *power;
  }
  if (predictor.variable.empty()) return "the predictor is empty: write constant, or the name of a variable";
  if (predictor.variable == "constant") predictor.variable.clear();
  return std::nullopt;
}

}  // namespace

Result<BiasTable> BiasTable::parse(const std::string& text, const std::string& name) {
  BiasTable table;
  const auto take = [&](const Fields& fields) -> Problem {
    SounderChannel channel{};
    if (Problem problem = read_channel(fields, channel)) return problem;
    double bias_k = 0;
    if (Problem problem = read_number(fields[4], "bias_k", bias_k)) return problem;
    Entry& entry = table.entries_[channel];
    const std::optional<int> position = whole_number(fields[3]);
    if (fields[3] != "*" && (!position || *position < 1))
      return fmt::format("scan_position \"{}\" must be a number from 1 on, or *", fields[3]);
    const bool again = position ? !entry.bias_k.try_emplace(*position, bias_k).second : entry.elsewhere_k.has_value();
    if (again) return fmt::format("scan_position {} of this channel stands here for the second time", fields[3]);
    if (!position) entry.elsewhere_k = bias_k;
    return std::nullopt;
  };
  if (Result<void> read =
          each_line(text, name, {"satellite", "instrument", "channel", "scan_position", "bias_k"}, take);
      !read)
    return read.error();
  return table;
}

std::optional<double> BiasTable::Entry::at(int scan_position) const {
  const auto found = bias_k.find(scan_position);
  return found == bias_k.end() ? elsewhere_k : found->second;
}

const BiasTable::Entry* BiasTable::find(const SounderChannel& channel) const {
  const auto found = entries_.find(channel);
  return found == entries_.end() ? nullptr : &found->second;
}

Result<BiasPredictors> BiasPredictors::parse(const std::string& text, const std::string& name) {
  BiasPredictors predictors;
  const auto take = [&](const Fields& fields) -> Problem {
    SounderChannel channel{};
    if (Problem problem = read_channel(fields, channel)) return problem;
    BiasPredictor predictor;
    if (Problem problem = read_predictor(fields[3], predictor)) return problem;
    if (Problem problem = read_number(fields[4], "coefficient", predictor.coefficient)) return problem;
    std::vector<BiasPredictor>& of_channel = predictors.entries_[channel];
    const auto is_same = [&](const BiasPredictor& other) {
      return other.variable == predictor.variable && other.power == predictor.power;
    };
    if (std::any_of(of_channel.begin(), of_channel.end(), is_same))
      return fmt::format("predictor {} of this channel stands here for the second time", fields[3]);
    of_channel.push_back(std::move(predictor));
    return std::nullopt;
  };
  if (Result<void> read =
          each_line(text, name, {"satellite", "instrument", "channel", "predictor", "coefficient"}, take);
      !read)
    return read.error();
  return predictors;
}

const std::vector<BiasPredictor>* BiasPredictors::find(const SounderChannel& channel) const {
  const auto found = entries_.find(channel);
  return found == entries_.end() ? nullptr : &found->second;
}

}  // namespace thin
