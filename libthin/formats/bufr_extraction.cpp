#include "libthin/formats/bufr_extraction.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "libthin/formats/bufr_file.h"
#include "libthin/formats/bufr_soundings.h"
#include "libthin/formats/bufr_subsets.h"
#include "libthin/formats/ecmwf_section2.h"
#include "libthin/formats/gts_bulletin.h"
#include "libthin/foundation/file_bytes.h"

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
    for (std::size_t number = 0; number < scan_.messages.size(); ++number) {
      Result<Part> part = part_of(scan_.messages[number], (*subsets)[number]);
      if (!part) return part.error();
      parts_.push_back(std::move(*part));
    }
    leave_out_tables_without_data();
    for (const Bulletin& bulletin : scan_.bulletins) add_bulletin(bulletin);
    if (summary_.messages > 0 && scan_.has_end_marker && keep_headers())
      output_.insert(output_.end(), kGtsLengthPrefixSize, '0');
    summary_.bytes = output_.size();
    return summary_;
  }

  const std::vector<std::uint8_t>& output() const { return output_; }
  std::uint64_t subsets_written() const { return subsets_written_; }
  const BufrScan& scan() const { return scan_; }

 private:
  // What is written of one message.
  struct Part {
    bool is_written = false;
    std::size_t retained = 0;          // subsets that were asked for
    std::size_t subsets = 0;           // that are written
    std::vector<std::uint8_t> packed;  // empty: the message as it came
  };

  bool keep_headers() const { return options_.gts_headers == OutputOptions::GtsHeaders::keep; }

  void append(Bytes bytes) { output_.insert(output_.end(), bytes.begin(), bytes.end()); }

  Bytes bytes_of(const BufrMessage& message) const { return original_.subspan(message.offset, message.length); }

  Result<Part> part_of(const BufrMessage& message, const std::vector<std::uint32_t>& subsets) {
    const auto count = static_cast<std::size_t>(message.header.subset_count);
    const Part as_it_came = {.is_written = true, .retained = subsets.size(), .subsets = count, .packed = {}};
    if (!is_tables(message) && subsets.size() == count && !subsets.empty()) {
      tables_.pass_data();
      return as_it_came;
    }
    const SoundingMessage soundings = open_soundings(bytes_of(message), message.header, tables_);
    // Tables that can't be read stay, too: without them others would be in force for the data behind.
    if (is_tables(message)) return as_it_came;
    if (subsets.empty()) {
      const bool keep = options_.other_messages == OutputOptions::OtherMessages::keep;
      return soundings.state == SoundingMessage::State::other_kind && keep ? as_it_came : Part{};
    }
    if (soundings.state != SoundingMessage::State::soundings)
      return Error{ErrorKind::input, where(message) + soundings.reason + ". The file has changed since it was read."};
    return some_subsets(message, soundings.data, subsets);
  }

  Result<Part> some_subsets(const BufrMessage& message, const BufrData& data,
                            const std::vector<std::uint32_t>& subsets) {
    Part part = {.is_written = true,
                 .retained = subsets.size(),
                 .subsets = subsets.size(),
                 .packed = extract_subsets(bytes_of(message), message.header, data, subsets)};
    const Result<BufrHeader> header = parse_bufr_header(part.packed);
    if (!header || header->subset_count != static_cast<int>(subsets.size()))
      return Error{ErrorKind::internal, where(message) + "something else was extracted than the subsets asked for"};
    correct_ecmwf_section2(bytes_of(message), message.header, part.packed, *header);
    return part;
  }

  // Tables are written for the data behind them, never alone. So no two sets of tables, whose data were all left out
  // between them, become one.
  void leave_out_tables_without_data() {
    bool has_data = false;
    bool behind_is_data = true;
    for (std::size_t i = parts_.size(); i-- > 0;) {
      const bool tables = is_tables(scan_.messages[i]);
      if (!tables && behind_is_data) has_data = has_data || parts_[i].is_written;
      if (!tables && !behind_is_data) has_data = parts_[i].is_written;
      if (tables) parts_[i].is_written = has_data;
      behind_is_data = !tables;
    }
  }

  // The envelope is written around what is left of its messages; where nothing is, not at all.
  void add_bulletin(const Bulletin& bulletin) {
    const std::size_t begin = output_.size();
    if (keep_headers()) append(original_.subspan(bulletin.heading_offset, bulletin.heading_size));
    const std::size_t messages_begin = output_.size();
    for (std::size_t i = 0; i < bulletin.message_count; ++i) add_part(bulletin.first_message + i);
    if (output_.size() == messages_begin) return output_.resize(begin);
    if (keep_headers()) append(original_.subspan(bulletin.trailer_offset, bulletin.trailer_size));
    if (keep_headers() && bulletin.has_length_prefix) put_gts_length(std::span(output_).subspan(begin));
  }

  void add_part(std::size_t number) {
    const Part& part = parts_[number];
    if (!part.is_written) return;
    append(part.packed.empty() ? bytes_of(scan_.messages[number]) : Bytes(part.packed));
    ++summary_.messages;
    summary_.subsets += part.retained;
    subsets_written_ += part.subsets;
  }

  static bool is_tables(const BufrMessage& message) { return message.header.data_category == kTablesCategory; }

  std::string where(const BufrMessage& message) const {
    return name_ + ": message at byte " + std::to_string(message.offset) + ": ";
  }

  Bytes original_;
  const std::string& name_;
  const OutputOptions& options_;
  BufrScan scan_;
  BufrFileTables tables_;
  std::vector<Part> parts_;  // of each message
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
