#include "libthin/tools/outcome.h"

#include <spdlog/spdlog.h>

#include <cstdio>

namespace thin {
namespace {

const char* name_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::configuration:
      return "configuration";
    case ErrorKind::input:
      return "unusable";
    case ErrorKind::incomplete:
      return "incomplete";
    case ErrorKind::temporary:
      return "temporary";
    case ErrorKind::internal:
      return "error";
  }
  return "error";
}

}  // namespace

void print_outcome(const OutcomeJson& outcome) {
  // File names need not be UTF-8.
  const std::string text = outcome.dump(-1, ' ', false, OutcomeJson::error_handler_t::replace) + "\n";
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

int fail(const Error& error) {
  spdlog::error("{}", error.message);
  print_outcome({{"outcome", name_of(error.kind)}, {"reason", error.message}});
  return exit_code(error.kind);
}

int finished(const Result<int>& code) {
  if (code) return *code;
  spdlog::error("{}", code.error().message);
  return exit_code(code.error().kind);
}

Error without_path(Error error, const std::string& path) {
  const std::string prefix = path + ": ";
  if (error.message.starts_with(prefix)) error.message.erase(0, prefix.size());
  return error;
}

OutcomeJson seconds_json(const StepSeconds& seconds) {
  OutcomeJson json = OutcomeJson::object();
  for (const auto& [step, value] : seconds) json[step] = value;
  return json;
}

}  // namespace thin
