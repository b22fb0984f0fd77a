#include "libthin/formats/bufr_extraction.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "libthin/formats/bufr_amsua.h"
#include "libthin/formats/bufr_file.h"
#include "libthin/formats/ecmwf_section2.h"
#include "libthin/foundation/file_bytes.h"
#include "libthin/formats/gts_bulletin.h"

namespace thin {
namespace {

using Bytes = std::span<const std::uint8_t>;

// The retained subsets of each message, ascending.
Result<std::vector<std::vector<std::uint32_t>>> by_message(std::span<const SourceReference> retained,
                                                           const BufrScan& scan, const std::string& name) {
  std::vector<std::vector<std::uint32_t>> subsets(scan.messages.size());
  for (const SourceReference& reference : retained) {
    if (reference.message >= subsets.size() ||
        reference.subset >= static_cast<std::uint32_t>(scan.messages[reference.message].header.subset_count))
      return Error{ErrorKind::input, name + ": there is no subset " + std::to_string(reference.subset) +
                                         " in message " + std::to_string(reference.message) +
                                         ": the file has changed since it was read. Read it again."};
    subsets[reference.message].push_back(reference.subset);
  }
  for (std::vector<std::uint32_t>& list : subsets) {
    std::sort(list.begin(), list.end());
    assert(std::adjacent_find(list.begin(), list.end()) == list.end());
  }
  return subsets;
}

// One original, on its way out.
class Extraction {
 public:
  Extraction(Bytes original, const std::string& name, const OutputOptions& options)
      : original_(original), name_(name), options_(options), scan_(scan_bufr(original)) {}

  Result<ExtractionSummary> run(std::span<const SourceReference> retained) {
    const auto subsets = by_message(retained, scan_, name_);
    if (!subsets) return subsets.error();
    for (const Bulletin& bulletin : scan_.bulletins)
      if (const Result<void> added = add_bulletin(bulletin, *subsets); !added) return added.error();
    if (summary_.messages > 0 && scan_.has_end_marker && keep_headers())
      output_.insert(output_.end(), kGtsLengthPrefixSize, '0');
    summary_.bytes = output_.size();
    return summary_;
  }

  const std::vector<std::uint8_t>& output() const { return output_; }
  std::uint64_t subsets_written() const { return subsets_written_; }
  const BufrScan& scan() const { return scan_; }

 private:
  bool keep_headers() const { return options_.gts_headers == OutputOptions::GtsHeaders::keep; }

  void append(Bytes bytes) { output_.insert(output_.end(), bytes.begin(), bytes.end()); }

  // The envelope is written around what is left of its messages; where nothing is, not at all.
  Result<void> add_bulletin(const Bulletin& bulletin, const std::vector<std::vector<std::uint32_t>>& subsets) {
    const std::size_t begin = output_.size();
    if (keep_headers()) append(original_.subspan(bulletin.heading_offset, bulletin.heading_size));
    const std::size_t messages_begin = output_.size();
    for (std::size_t i = 0; i < bulletin.message_count; ++i) {
      const std::size_t number = bulletin.first_message + i;
      if (Result<void> added = add_message(scan_.messages[number], subsets[number]); !added) return added;
    }
    if (output_.size() == messages_begin) {
      output_.resize(begin);
      return {};
    }
    if (keep_headers()) append(original_.subspan(bulletin.trailer_offset, bulletin.trailer_size));
    if (keep_headers() && bulletin.has_length_prefix) put_gts_length(std::span(output_).subspan(begin));
    return {};
  }

  Result<void> add_message(const BufrMessage& message, const std::vector<std::uint32_t>& subsets) {
    const Bytes bytes = original_.subspan(message.offset, message.length);
    if (subsets.size() == static_cast<std::size_t>(message.header.subset_count) && !subsets.empty()) {
      add_verbatim(message);
      summary_.subsets += subsets.size();
      return {};
    }
    AmsuAMessage amsua = open_amsua(bytes, message.header);
    if (subsets.empty()) {
      const bool keep = options_.other_messages == OutputOptions::OtherMessages::keep;
      if (amsua.state == AmsuAMessage::State::other_kind && keep) add_verbatim(message);
      return {};
    }
    if (amsua.state != AmsuAMessage::State::amsua)
      return Error{ErrorKind::input, where(message) + amsua.reason + ". The file has changed since it was read."};
    return add_subsets(message, *amsua.message, subsets);
  }

  void add_verbatim(const BufrMessage& message) {
    append(original_.subspan(message.offset, message.length));
    ++summary_.messages;
    subsets_written_ += static_cast<std::uint64_t>(message.header.subset_count);
  }

  Result<void> add_subsets(const BufrMessage& message, EccodesMessage& decoded,
                           const std::vector<std::uint32_t>& subsets) {
    Result<std::vector<std::uint8_t>> extracted = decoded.extract_subsets(subsets);
    if (!extracted) return Error{extracted.error().kind, where(message) + extracted.error().message};
    const Result<BufrHeader> header = parse_bufr_header(*extracted);
    if (!header || header->subset_count != static_cast<int>(subsets.size()))
      return Error{ErrorKind::internal, where(message) + "ecCodes extracted something else than the subsets asked for"};
    correct_ecmwf_section2(original_.subspan(message.offset, message.length), message.header, *extracted, *header);
    append(*extracted);
    ++summary_.messages;
    summary_.subsets += subsets.size();
    subsets_written_ += subsets.size();
    return {};
  }

  std::string where(const BufrMessage& message) const {
    return name_ + ": message at byte " + std::to_string(message.offset) + ": ";
  }

  Bytes original_;
  const std::string& name_;
  const OutputOptions& options_;
  BufrScan scan_;
  std::vector<std::uint8_t> output_;
  ExtractionSummary summary_;
  std::uint64_t subsets_written_ = 0;  // with those of other kinds
};

// Reads back what was written: the number of messages and subsets, and nothing between them.
Result<void> check_written(const std::string& path, const ExtractionSummary& summary, std::uint64_t subsets_expected) {
  const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(path);
  if (!bytes) return bytes.error();
  const BufrScan scan = scan_bufr(*bytes);
  std::uint64_t subsets = 0;
  for (const BufrMessage& message : scan.messages) subsets += static_cast<std::uint64_t>(message.header.subset_count);
  if (scan.messages.size() == summary.messages && subsets == subsets_expected && scan.unused.empty() &&
      !scan.cut_offset)
    return {};
  return Error{ErrorKind::internal, path + ": wrote " + std::to_string(summary.messages) + " messages and " +
                                        std::to_string(subsets_expected) + " subsets, but read back " +
                                        std::to_string(scan.messages.size()) + " and " + std::to_string(subsets)};
}

}  // namespace

Result<ExtractionSummary> extract_bufr(std::span<const std::uint8_t> bytes, const std::string& name,
                                       std::span<const SourceReference> retained, const std::string& output_path,
                                       const OutputOptions& options) {
  Extraction extraction(bytes, name, options);
  if (const Result<void> complete = check_complete(extraction.scan(), name); !complete) return complete.error();
  Result<ExtractionSummary> summary = extraction.run(retained);
  if (!summary || summary->messages == 0) return summary;
  if (const Result<void> written = write_file_bytes(output_path, extraction.output()); !written) return written.error();
  if (const Result<void> right = check_written(output_path, *summary, extraction.subsets_written()); !right)
    return right.error();
  return summary;
}

}  // namespace thin
