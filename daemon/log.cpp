#include "daemon/log.h"

#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/clock.h"
#include "libthin/observations/time.h"

namespace thind {
namespace {

LogSettings::Format current_format = LogSettings::Format::text;

spdlog::level::level_enum level_of(Level level) {
  switch (level) {
    case Level::debug:
      return spdlog::level::debug;
    case Level::information:
      return spdlog::level::info;
    case Level::warning:
      return spdlog::level::warn;
    case Level::error:
      return spdlog::level::err;
  }
  return spdlog::level::err;
}

// One event is one line, whatever a file name or a worker's words hold.
std::string one_line(const std::string& text) {
  std::string line = text;
  for (char& letter : line) {
    const auto code = static_cast<unsigned char>(letter);
    if (code < 0x20 || code == 0x7f) letter = ' ';
  }
  return line;
}

std::string json_line(Level level, const std::string& sentence, const Fields& fields) {
  nlohmann::ordered_json line;
  line["time"] = thin::to_iso8601(wall_clock_ms());
  line["level"] = spdlog::level::to_string_view(level_of(level)).data();
  line["text"] = sentence;
  for (const auto& [name, value] : fields) line[name] = value;
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

thin::Result<void> set_up_log(const LogSettings& settings) {
  try {
    spdlog::sink_ptr sink;
    if (settings.file.empty())
      sink = std::make_shared<spdlog::sinks::stderr_sink_st>();
    else
      sink = std::make_shared<spdlog::sinks::rotating_file_sink_st>(
          settings.file, static_cast<std::size_t>(settings.file_megabytes) << 20,
          static_cast<std::size_t>(settings.file_count));
    auto logger = std::make_shared<spdlog::logger>("thind", std::move(sink));
    logger->set_level(level_of(settings.level));
    logger->flush_on(spdlog::level::debug);
    current_format = settings.format;
    logger->set_pattern(settings.format == LogSettings::Format::json ? "%v" : "%Y-%m-%dT%H:%M:%S.%eZ %l: %v",
                        spdlog::pattern_time_type::utc);
    spdlog::set_default_logger(std::move(logger));
  } catch (const spdlog::spdlog_ex& error) {
    return Error{ErrorKind::configuration, std::string("daemon.log_file: ") + error.what()};
  }
  return {};
}

void log(Level level, const std::string& sentence, const Fields& fields) {
  if (!spdlog::should_log(level_of(level))) return;
  const bool json = current_format == LogSettings::Format::json;
  spdlog::log(level_of(level), "{}", json ? json_line(level, sentence, fields) : one_line(sentence));
}

}  // namespace thind
