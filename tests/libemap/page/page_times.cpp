// page_times FILE.emap...: how large the page of a file is, how long the browser takes to show it, beside the program's
// own decoder, how many pictures it draws in a second, and whether both decode the same. Best of three each; a line of
// Markdown for each file.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
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

  double pictures = 0;  // a second
  bool same = true;     // masks, elevations and the triangles in gaps as the program's

  void keep_best(const Times& other) {
    pictures = std::max(pictures, other.pictures);
    same = same && other.same;
    decode = std::min(decode, other.decode);
    shown = std::min(shown, other.shown);
    closed = std::min(closed, other.closed);
  }
};

// FNV-1a over 32-bit words.
std::uint32_t digest(std::uint32_t sum, const void* items, std::size_t bytes) {
  for (std::size_t i = 0; i + 4 <= bytes; i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, static_cast<const char*>(items) + i, 4);
    sum = (sum ^ word) * 16777619U;
  }
  return sum;
}

std::uint32_t digest_of(const ElevationMaps& maps) {
  std::uint32_t sum = 2166136261U;
  for (const ElevationPatch& patch : maps.patches) {
    const std::vector<std::uint32_t> mask(patch.mask.begin(), patch.mask.end());
    sum = digest(sum, mask.data(), 4 * mask.size());
    sum = digest(sum, patch.elevation.data(), sizeof(double) * patch.elevation.size());
  }
  const ClosedMesh closed = closed_mesh(maps);
  const std::size_t first = closed.mesh.triangles.size() - closed.filling.inserted;
  return digest(sum, closed.mesh.triangles.data() + first, 12 * closed.filling.inserted);
}

constexpr const char* kDigest = R"((() => {
  let sum = 2166136261;
  const add = (values) => {
    const words = new Uint32Array(values.buffer, values.byteOffset, values.byteLength / 4);
    for (let i = 0; i < words.length; ++i) sum = Math.imul(sum ^ words[i], 16777619) >>> 0;
  };
  const stream = decode_stream(stream_bytes(document.getElementById("stream")), () => {}), model = build_model(stream, () => {});
  for (const patch of stream.patches) {
    add(Uint32Array.from(patch.mask));
    add(Float64Array.from(patch.elevation));
  }
  add(Uint32Array.from(new GapFiller(surface_of(stream, model), stream.header.spacing, stream.header.least).fill().flat()));
  return sum;
})())";

// Each finished before the next begins.
constexpr const char* kPictures = R"((() => {
  const gl = page.renderer.gl, pixel = new Uint8Array(4);
  const draw = () => {
    page.draw();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  };
  draw();
  const begin = performance.now();
  let drawn = 0;
  for (; performance.now() - begin < 2000; ++drawn) draw();
  return (1000 * drawn) / (performance.now() - begin);
})())";

Times in_browser(const std::filesystem::path& page, std::uint32_t expected) {
  test::Browser browser;
  browser.open("file://" + page.string(), 800, 600);
  browser.evaluate("opened");
  const nlohmann::json seconds = browser.evaluate(
      "[page.model.decode_seconds, page.model.decode_seconds + page.model.build_seconds, page.gaps.seconds]");
  const double pictures = browser.evaluate(kPictures);
  const bool same = browser.evaluate(kDigest).get<std::uint32_t>() == expected;
  return {seconds[0], seconds[1], seconds[1].get<double>() + seconds[2].get<double>(), pictures, same};
}

Times in_program(const std::vector<std::uint8_t>& stream) {
  const auto since = [begin = std::chrono::steady_clock::now()] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const DecodedStream decoded = std::move(read_stream(stream)).value();
  const double decode = since();
  const ClosedMesh closed = closed_mesh(decoded.maps);
  return {decode, decode, since(), 0, true};
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
  const std::uint32_t expected = digest_of(decoded->maps);
  Times browser, program;
  for (int round = 0; round < kRounds; ++round) {
    browser.keep_best(in_browser(page, expected));
    program.keep_best(in_program(*stream));
  }
  std::filesystem::remove(page);
  fmt::print("| {} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} | {} |\n",
             std::filesystem::path(file).stem().string(), samples, stream->size(), html.size(), browser.decode,
             browser.shown, browser.closed, program.decode, program.closed, browser.pictures,
             browser.same ? "yes" : "no");
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
      "gaps closed s | pictures a second | the same |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
  int failed = 0;
  for (int i = 1; i < argc; ++i) failed += emap::measure(argv[i]);
  return failed == 0 ? 0 : 1;
}
