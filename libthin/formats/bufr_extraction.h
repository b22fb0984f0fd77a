#pragma once

// Writes a BUFR file again with fewer subsets.

#include <cstdint>
#include <span>
#include <string>

#include "libthin/formats/observation_file.h"

namespace thin {

// As extract_observations, from the original's bytes. What happens to each part of the original:
//
//   AMSU-A message, all subsets retained   byte for byte
//   AMSU-A message, some retained          ecCodes packs those subsets anew; every value, missing ones too, stays.
//   Section
//                                          1 stays; section 2 stays, but for ECMWF's counts (below); an uncompressed
//                                          message stays uncompressed
//   AMSU-A message, none retained          leaves the file
//   AMSU-A message that can't be decoded   leaves the file
//   message of another kind                options.other_messages: byte for byte, or leaves
//   GTS envelope                           options.gts_headers: stays, its length field made right, or leaves
//   stray bytes, padding, damage           leave
//
// ECMWF's section 2 (52 bytes) states the length of the message and the number of its observations: where they were
// right in the original they are made right again. Its corners of the area and its times describe the original message
// and stay: the retained observations lie within them.
Result<ExtractionSummary> extract_bufr(std::span<const std::uint8_t> bytes, const std::string& name,
                                       std::span<const SourceReference> retained, const std::string& output_path,
                                       const OutputOptions& options);

}  // namespace thin
