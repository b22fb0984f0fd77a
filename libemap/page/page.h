#pragma once

// An .emap stream as a web page that needs nothing else: the stream's bytes, a decoder in JavaScript (decoder/, written
// from docs/emap-format.md) that runs beside the page, and a viewer by WebGL 2 (viewer/). The page asks the network for
// nothing, and forbids itself to.
//
// Behind the page's address, #azimuth=A&elevation=E&distance=D&shading=lighting|reflection|patches sets the first view:
// degrees, and diagonals of the bounding box, as in `emap render --camera`.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace emap {

// title: plain text, UTF-8. The stream is not looked at.
std::string web_page(std::string_view title, std::span<const std::uint8_t> stream);

}  // namespace emap
