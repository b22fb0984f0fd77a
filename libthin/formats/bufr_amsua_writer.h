#pragma once

// AMSU-A level 1C as WMO BUFR: edition 4, sequence 310009, compressed, master table version 13; as weather centres
// exchange it, and readable by any decoder. For synthetic soundings: what thinning emits is cut from the original
// messages instead (observation_file.h).

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "libthin/foundation/result.h"
#include "libthin/observations/scan_geometry.h"

namespace thin {

constexpr int kAmsuaChannels = 15;

struct AmsuaSounding {
  FieldOfView view;
  std::int32_t scan_line = 1;      // 0..8190
  std::int32_t field_of_view = 1;  // 1..30
  std::int32_t orbit_number = 0;
  std::array<double, kAmsuaChannels> brightness_temperature_k{};  // 0..655.34; NaN for missing
};

struct AmsuaWriterOptions {
  int lines_per_message = 10;  // at least 1; a message ends after so many changes of the scan line
  bool gts_envelopes = false;  // each message as a bulletin: length, SOH, heading INAX01 SYNT, ETX
};

struct AmsuaFileSummary {
  std::uint32_t messages = 0;
  std::uint64_t bytes = 0;
};

// One message. The originating centre is "missing", since no centre measured this. BUFR rounds: temperatures and angles
// to 0.01, positions to 1e-5 degrees, times to 1 ms, heights to 100 m.
// REQUIRES: 1 to 65535 soundings, each within the limits above
Result<std::string> encode_amsua_message(std::int32_t platform, std::span<const AmsuaSounding> soundings);

// All soundings as one file, in the order given, which appears whole or not at all (atomic_file.h). The same soundings
// give the same bytes.
// Errors: temporary or internal, where the file system fails.
Result<AmsuaFileSummary> write_amsua_file(const std::string& path, std::int32_t platform,
                                          std::span<const AmsuaSounding> soundings, const AmsuaWriterOptions& options);

}  // namespace thin
