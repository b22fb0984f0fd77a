// page_times FILE.emap...: how large the page of a file is and how long the browser takes to show it, beside the
// program's own decoder. Best of three each; a line of Markdown for each file.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "libemap/coding/stream.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/page/page.h"
#include "libthin/foundation/file_bytes.h"
#include "tests/support/browser.h"

namespace emap {
namespace {

constexpr int kRounds = 3;

struct Times {
  double decode = 1e9, shown = 1e9,
         closed = 1e9;  // seconds: the stream; until it can be drawn; until gaps are closed too

  void keep_best(const Times& other) {
    decode = std::min(decode, other.decode);
    shown = std::min(shown, other.shown);
    closed = std::min(closed, other.closed);
  }
};

Times in_browser(const std::filesystem::path& page) {
  test::Browser browser;
  browser.open("file://" + page.string(), 800, 600);
  browser.evaluate("opened");
  const nlohmann::json seconds = browser.evaluate(
      "[page.model.decode_seconds, page.model.decode_seconds + page.model.build_seconds, page.gaps.seconds]");
  return {seconds[0], seconds[1], seconds[1].get<double>() + seconds[2].get<double>()};
}

Times in_program(const std::vector<std::uint8_t>& stream) {
  const auto since = [begin = std::chrono::steady_clock::now()] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const DecodedStream decoded = std::move(read_stream(stream)).value();
  const double decode = since();
  const ClosedMesh closed = closed_mesh(decoded.maps);
  return {decode, decode, since()};
}

int measure(const std::string& file) {
  const auto stream = thin::read_file_bytes(file);
  const auto decoded = stream ? read_stream(*stream) : stream.error();
  if (!decoded) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), decoded.error().message.c_str());
    return 1;
  }
  std::size_t samples = 0;
  for (const ElevationPatch& patch : decoded->maps.patches)
    samples += static_cast<std::size_t>(std::count(patch.mask.begin(), patch.mask.end(), 1));
  const std::string html = web_page(file, *stream);
  const std::filesystem::path page = std::filesystem::temp_directory_path() /
                                     fmt::format("page_times_{}.html", std::filesystem::path(file).stem().string());
  if (!thin::write_file_bytes(page, {reinterpret_cast<const std::uint8_t*>(html.data()), html.size()})) return 1;
  Times browser, program;
  for (int round = 0; round < kRounds; ++round) {
    browser.keep_best(in_browser(page));
    program.keep_best(in_program(*stream));
  }
  std::filesystem::remove(page);
  fmt::print("| {} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n",
             std::filesystem::path(file).stem().string(), samples, stream->size(), html.size(), browser.decode,
             browser.shown, browser.closed, program.decode, program.closed);
  return 0;
}

}  // namespace
}  // namespace emap

int main(int argc, char** argv) {
  if (!emap::test::Browser::installed()) {
    std::fputs("page_times: no chromium on this machine\n", stderr);
    return 1;
  }
  std::puts(
      "| file | samples | bytes | bytes of the page | browser: decode s | shown s | gaps closed s | program: decode s "
      "| "
      "gaps closed s |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
  int failed = 0;
  for (int i = 1; i < argc; ++i) failed += emap::measure(argv[i]);
  return failed == 0 ? 0 : 1;
}
