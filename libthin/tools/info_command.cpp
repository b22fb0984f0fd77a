// thin info: what is in a file, for people or as JSON.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libthin/formats/file_summary.h"
#include "libthin/observations/platforms.h"
#include "libthin/observations/time.h"
#include "libthin/tools/commands.h"
#include "libthin/tools/outcome.h"

namespace thin {
namespace {

// A file damaged in a thousand places needs no thousand lines.
constexpr std::size_t kMostSkippedLines = 10;

template <class T>
std::string joined(const std::vector<T>& values) {
  return fmt::format("{}", fmt::join(values, ", "));
}

std::string kelvin(double value_k) {
  return std::isnan(value_k) ? "-" : fmt::format("{:.2f}", value_k);
}

std::string satellites(const FileSummary& summary) {
  std::vector<std::string> names;
  for (const PlatformSummary& platform : summary.platforms)
    names.push_back(fmt::format("{} ({}): {} observations", platform_name(platform.platform), platform.platform,
                                platform.observations));
  return fmt::format("{}", fmt::join(names, ", "));
}

// Counts where there are several.
std::string instruments(const FileSummary& summary) {
  if (summary.instruments.size() < 2) return summary.instrument;
  std::vector<std::string> names;
  for (const InstrumentSummary& one : summary.instruments)
    names.push_back(fmt::format("{}: {} observations", instrument_name(one.instrument), one.observations));
  return fmt::format("{}", fmt::join(names, ", "));
}

// "7"; "MHS 3" where a file has several instruments.
std::string channel_name(const ChannelSummary& channel) {
  if (channel.instrument == Instrument::unknown) return std::to_string(channel.channel);
  return fmt::format("{} {}", instrument_name(channel.instrument), channel.channel);
}

std::string skipped_lines(const FileSummary& summary) {
  std::string text;
  for (std::size_t i = 0; i < summary.skipped.size() && i < kMostSkippedLines; ++i)
    text += fmt::format("  skipped       at byte {}: {}\n", summary.skipped[i].offset, summary.skipped[i].reason);
  if (summary.skipped.size() > kMostSkippedLines)
    text += fmt::format("  skipped       {} more parts\n", summary.skipped.size() - kMostSkippedLines);
  return text;
}

std::string channel_table(const FileSummary& summary) {
  std::string text = fmt::format("  {:>9}  {:>8}  {:>8}  {:>8}  {:>8}  {:>8}", "channel", "present", "missing", "min K",
                                 "mean K", "max K");
  text += summary.has_first_guess ? "  innovation: mean K  deviation K\n" : "\n";
  for (const ChannelSummary& channel : summary.channels) {
    text += fmt::format("  {:>9}  {:>8}  {:>8}  {:>8}  {:>8}  {:>8}", channel_name(channel), channel.present,
                        channel.missing, kelvin(channel.minimum_k), kelvin(channel.mean_k), kelvin(channel.maximum_k));
    if (summary.has_first_guess)
      text +=
          fmt::format("  {:>18}  {:>11}", kelvin(channel.innovation_mean_k), kelvin(channel.innovation_deviation_k));
    text += "\n";
  }
  return text;
}

std::string table_of(const std::string& path, const FileSummary& summary) {
  const auto line = [](const char* name, const std::string& value) {
    return fmt::format("  {:<12}  {}\n", name, value);
  };
  std::string text = path + "\n";
  const bool has_messages = !summary.editions.empty();
  text += line("layout", summary.layout + (has_messages ? " edition " + joined(summary.editions) : ""));
  text += line("instrument", instruments(summary));
  if (has_messages)
    text += line("messages", fmt::format("{}, of which {} in use", summary.messages, summary.messages_in_use));
  text += skipped_lines(summary);
  if (has_messages)
    text += line("subsets", fmt::format("{}, of which {} usable", summary.subsets_in_use, summary.observations));
  if (has_messages) text += line("descriptors", joined(summary.descriptors));
  for (const std::string& note : summary.notes) text += line("note", note);
  text += line("satellites", satellites(summary));
  text += line("time", to_iso8601(summary.first_time_ms) + " to " + to_iso8601(summary.last_time_ms));
  text += line("scan lines", summary.scan_lines ? std::to_string(summary.scan_lines) : "unknown");
  text += line("latitude", fmt::format("{:.4f} to {:.4f}", summary.area.south_deg, summary.area.north_deg));
  text += line("longitude", fmt::format("{:.4f} to {:.4f}{}", summary.area.west_deg, summary.area.east_deg,
                                        summary.area.west_deg > summary.area.east_deg ? ", over the date line" : ""));
  return text + channel_table(summary);
}

nlohmann::ordered_json json_number(double value) {
  return std::isnan(value) ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(value);
}

nlohmann::ordered_json json_of(const FileSummary& summary) {
  nlohmann::ordered_json json = {{"layout", summary.layout},
                                 {"instrument", summary.instrument},
                                 {"editions", summary.editions},
                                 {"messages", summary.messages},
                                 {"messages_in_use", summary.messages_in_use},
                                 {"subsets_in_use", summary.subsets_in_use},
                                 {"observations", summary.observations},
                                 {"descriptors", summary.descriptors},
                                 {"first_time", to_iso8601(summary.first_time_ms)},
                                 {"last_time", to_iso8601(summary.last_time_ms)},
                                 {"scan_lines", summary.scan_lines},
                                 {"south_deg", summary.area.south_deg},
                                 {"north_deg", summary.area.north_deg},
                                 {"west_deg", summary.area.west_deg},
                                 {"east_deg", summary.area.east_deg}};
  json["satellites"] = nlohmann::ordered_json::array();
  for (const PlatformSummary& platform : summary.platforms)
    json["satellites"].push_back({{"number", platform.platform},
                                  {"name", platform_name(platform.platform)},
                                  {"observations", platform.observations}});
  json["instruments"] = nlohmann::ordered_json::array();
  for (const InstrumentSummary& one : summary.instruments)
    json["instruments"].push_back({{"name", instrument_name(one.instrument)}, {"observations", one.observations}});
  json["channels"] = nlohmann::ordered_json::array();
  for (const ChannelSummary& channel : summary.channels)
    json["channels"].push_back(
        {{"channel", channel.channel},
         {"instrument",
          channel.instrument == Instrument::unknown ? summary.instrument : instrument_name(channel.instrument)},
         {"present", channel.present},
         {"missing", channel.missing},
         {"minimum_k", json_number(channel.minimum_k)},
         {"mean_k", json_number(channel.mean_k)},
         {"maximum_k", json_number(channel.maximum_k)},
         {"innovation_mean_k", json_number(channel.innovation_mean_k)},
         {"innovation_deviation_k", json_number(channel.innovation_deviation_k)}});
  json["notes"] = summary.notes;
  json["skipped"] = nlohmann::ordered_json::array();
  for (const SkippedPart& part : summary.skipped)
    json["skipped"].push_back({{"message", part.message}, {"offset", part.offset}, {"reason", part.reason}});
  return json;
}

// A cut file is as unusable as a wrong one to who asks now; only the machine's own failures ask for another try.
int exit_code_of(const Error& error) {
  return error.kind == ErrorKind::incomplete ? exit_code(ErrorKind::input) : exit_code(error.kind);
}

int show_files(const std::vector<std::string>& paths, bool as_json) {
  int worst = 0;
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const std::string& path : paths) {
    const Result<FileSummary> summary = summarise_file(path);
    if (!summary) worst = std::max(worst, exit_code_of(summary.error()));
    nlohmann::ordered_json entry = {{"file", path}, {"usable", summary.ok()}};
    if (as_json && summary)
      entry.update(json_of(*summary));
    else if (as_json)
      entry["reason"] = without_path(summary.error(), path).message;
    else if (summary)
      std::fputs(table_of(path, *summary).c_str(), stdout);
    else
      std::fputs(fmt::format("{}\n  cannot be used: {}\n", path, without_path(summary.error(), path).message).c_str(),
                 stdout);
    files.push_back(std::move(entry));
  }
  // Names and reasons may hold any bytes; JSON holds UTF-8 only.
  if (as_json)
    std::fputs((files.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n").c_str(), stdout);
  return std::fflush(stdout) == 0 ? worst : exit_code(ErrorKind::temporary);
}

}  // namespace

void add_info_command(CLI::App& program, Action& action) {
  struct Arguments {
    std::vector<std::string> paths;
    bool as_json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("info", "what is in files of soundings, or why they cannot be used");
  command->add_option("files", arguments->paths, "Files to look into")->required()->type_name("FILE");
  command->add_flag("--json", arguments->as_json, "One JSON array, one object a file");
  command->callback(
      [arguments, &action] { action = [arguments] { return show_files(arguments->paths, arguments->as_json); }; });
}

}  // namespace thin
