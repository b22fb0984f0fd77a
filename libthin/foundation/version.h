#pragma once

namespace thin {

// Of the product: part of every report and every reason file, for results depend on inputs, configuration and version.
inline constexpr const char* kVersion = THIN_VERSION;

}  // namespace thin
