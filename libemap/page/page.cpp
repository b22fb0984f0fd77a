#include "libemap/page/page.h"

#include <array>
#include <cassert>
#include <utility>

#include "libemap/page/page_sources.h"

namespace emap {
namespace {

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  return html;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = i; j < i + 3; ++j) three = three << 8 | (j < bytes.size() ? bytes[j] : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += i + j <= bytes.size() ? kDigits[three >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

}  // namespace

std::string web_page(std::string_view title, std::span<const std::uint8_t> stream) {
  const std::array<std::pair<std::string_view, std::string>, 5> parts = {{{"title", escaped(title)},
                                                                          {"style", std::string(kPageStyle)},
                                                                          {"decoder", std::string(kPageDecoder)},
                                                                          {"viewer", std::string(kPageViewer)},
                                                                          {"stream", base64(stream)}}};
  std::string page;
  std::string_view rest = kPageDocument;
  for (std::size_t begin; (begin = rest.find("{{")) != rest.npos;) {
    const std::size_t end = rest.find("}}", begin);
    const std::string_view name = rest.substr(begin + 2, end - begin - 2);
    page += rest.substr(0, begin);
    for (const auto& [part, text] : parts)
      if (part == name) page += text;
    rest.remove_prefix(end + 2);
  }
  return page.append(rest);
}

}  // namespace emap
