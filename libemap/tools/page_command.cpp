// emap page: an .emap file as a web page that decodes and draws it.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "libemap/page/page.h"
#include "libemap/tools/commands.h"
#include "libemap/tools/emap_file.h"
#include "libemap/tools/failure.h"
#include "libthin/foundation/file_bytes.h"

namespace emap {
namespace {

struct Arguments {
  std::string input, output, title;
};

int page(const Arguments& arguments) {
  // A page that can't draw its model is of no use: better said now than in the browser.
  if (const auto decoded = read_emap_file(arguments.input); !decoded) return fail(decoded.error());
  const thin::Result<std::vector<std::uint8_t>> stream = thin::read_file_bytes(arguments.input);
  if (!stream) return fail(stream.error());
  const std::string title =
      arguments.title.empty() ? std::filesystem::path(arguments.input).stem().string() : arguments.title;
  const std::string html = web_page(title, *stream);
  const auto written =
      thin::write_file_bytes(arguments.output, {reinterpret_cast<const std::uint8_t*>(html.data()), html.size()});
  if (!written) return fail(written.error());
  fmt::print("{}: {} bytes, of the model {}\n", arguments.output, html.size(), stream->size());
  return std::fflush(stdout) == 0 ? 0 : thin::exit_code(thin::ErrorKind::temporary);
}

}  // namespace

void add_page_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("page", "a web page that decodes and draws the surface by itself");
  command->add_option("input", arguments->input, "Compressed file")->required()->type_name("IN.emap");
  command->add_option("output", arguments->output, "One file, for any browser with WebGL 2")
      ->required()
      ->type_name("OUT.html");
  command->add_option("--title", arguments->title, "What the page calls the model [the input's name]");
  command->callback([arguments, &action] { action = [arguments] { return page(*arguments); }; });
}

}  // namespace emap
