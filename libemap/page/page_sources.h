#pragma once

// The files of this folder as text, put into the program when it is built (embed.cmake).

#include <string_view>

namespace emap {

extern const std::string_view kPageDocument;  // page.html: {{title}}, {{style}}, {{decoder}}, {{viewer}}, {{stream}}
extern const std::string_view kPageStyle;     // page.css
extern const std::string_view kPageDecoder;   // decoder/*.js
extern const std::string_view kPageViewer;    // viewer/*.js

}  // namespace emap
