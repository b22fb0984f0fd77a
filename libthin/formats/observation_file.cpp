#include "libthin/formats/observation_file.h"

#include <algorithm>
#include <string_view>

#include "libthin/formats/bufr_extraction.h"
#include "libthin/formats/bufr_file.h"
#include "libthin/foundation/file_bytes.h"
#include "libthin/formats/file_layout.h"

namespace thin {

void OutputOptions::declare(OptionTable& table) {
  table.add_choice("gts_headers", gts_headers, {{"keep", GtsHeaders::keep}, {"drop", GtsHeaders::drop}},
                   {.explanation = "bulletin headings around messages: keep them, their length made right, or write "
                                   "bare messages"});
  table.add_choice("other_messages", other_messages, {{"keep", OtherMessages::keep}, {"drop", OtherMessages::drop}},
                   {.explanation = "messages of kinds that are not thinned: keep them as they are, or leave them out"});
}

Result<ReadObservations> read_observations(const std::string& path) {
  const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(path);
  if (!bytes) return bytes.error();
  switch (layout_of(*bytes)) {
    case FileLayout::bufr:
      return read_bufr(*bytes, path);
    default:
      return refusal(layout_of(*bytes), *bytes, path);
  }
}

Result<ExtractionSummary> extract_observations(const std::string& original_path,
                                               std::span<const SourceReference> retained,
                                               const std::string& output_path, const OutputOptions& options) {
  const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(original_path);
  if (!bytes) return bytes.error();
  switch (layout_of(*bytes)) {
    case FileLayout::bufr:
      return extract_bufr(*bytes, original_path, retained, output_path, options);
    default:
      return refusal(layout_of(*bytes), *bytes, original_path);
  }
}

}  // namespace thin
