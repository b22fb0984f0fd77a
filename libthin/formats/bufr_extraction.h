#pragma once

// Writes a BUFR file again with fewer subsets.

#include <cstdint>
#include <span>
#include <string>

#include "libthin/formats/observation_file.h"

namespace thin {

// As extract_observations, from the original's bytes. What happens to each part of the original:
//
//   soundings, all subsets retained        byte for byte
//   soundings, some retained               those subsets, bit by bit (bufr_subsets.h). Section 1 stays; section 2
//   stays,
//                                          but for ECMWF's counts (below); an uncompressed message stays uncompressed
//   soundings, none retained               leave the file
//   soundings that can't be decoded        leave the file
//   tables of a tank                       byte for byte, where there is something else to write
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
