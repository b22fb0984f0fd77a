#include "libthin/formats/bufr_file.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <vector>

#include "libthin/formats/bufr_amsua.h"

namespace thin {
namespace {

// Why messages were of no use, counted for the one sentence that an unusable file gets.
class Refusals {
 public:
  void add(const std::string& reason, const std::string& remedy) {
    Entry& entry = entries_[reason];
    if (entry.count++ == 0) entry.remedy = remedy;
  }

  // "61 x HIRS (sensor 0), 3 x ...", most frequent first; three of them.
  Error error(const std::string& name) const {
    std::vector<std::pair<std::string, Entry>> sorted(entries_.begin(), entries_.end());
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.second.count > b.second.count; });
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, sorted.size()); ++i)
      list += (i ? "; " : "") + std::to_string(sorted[i].second.count) + " x " + sorted[i].first;
    if (sorted.size() > 3) list += "; and more";
    if (sorted.empty()) return {ErrorKind::input, name + ": no BUFR message in it. Send files of BUFR with AMSU-A."};
    const std::string remedy = " " + sorted.front().second.remedy;
    return {ErrorKind::input, name + ": nothing in it is AMSU-A. Its messages: " + list + "." + remedy};
  }

 private:
  struct Entry {
    int count = 0;
    std::string remedy;
  };
  std::map<std::string, Entry> entries_;
};

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

SkippedPart skipped_bytes(const BufrScan& scan, const UnusedBytes& part) {
  const auto message = static_cast<std::uint32_t>(std::min(part.message, scan.messages.size()));
  if (part.reason.empty()) return {message, part.offset, counted(part.size, "stray byte") + " between messages"};
  return {message, part.offset, "damaged message: " + part.reason};
}

void skip_unused_bytes(const BufrScan& scan, ReadObservations& contents, Refusals& refusals) {
  for (const UnusedBytes& part : scan.unused) {
    if (part.padding && part.reason.empty()) continue;
    contents.skipped.push_back(skipped_bytes(scan, part));
    if (!part.reason.empty()) refusals.add("damaged (" + part.reason + ")", "Ask the sender for it again.");
  }
}

void read_message(std::span<const std::uint8_t> bytes, const BufrMessage& message, std::uint32_t number,
                  ReadObservations& contents, Refusals& refusals) {
  const auto skip = [&](const std::string& reason, const std::string& remedy) {
    contents.skipped.push_back({number, message.offset, reason});
    refusals.add(reason, remedy);
  };
  const AmsuAMessage amsua = open_amsua(bytes.subspan(message.offset, message.length), message.header);
  if (amsua.state != AmsuAMessage::State::amsua) return skip(amsua.reason, amsua.remedy);

  const Result<std::uint32_t> left_out = append_soundings(amsua, message.header, number, contents.observations);
  if (!left_out) return skip(left_out.error().message, "It is damaged: ask the sender for it again.");
  if (*left_out > 0)
    skip(counted(*left_out, "subset") + " without usable position or time, or of another instrument",
         "Ask the sender for located soundings.");
}

}  // namespace

Result<void> check_complete(const BufrScan& scan, const std::string& name) {
  if (!scan.cut_offset) return {};
  const std::string where =
      name + ": the file is cut at its end, in the message that begins at byte " + std::to_string(*scan.cut_offset);
  return Error{ErrorKind::incomplete, where + ". Wait for the rest, or ask the sender for it again."};
}

Result<ReadObservations> read_bufr(std::span<const std::uint8_t> bytes, const std::string& name) {
  const BufrScan scan = scan_bufr(bytes);
  if (const Result<void> complete = check_complete(scan, name); !complete) return complete.error();
  ReadObservations contents;
  contents.layout = "bufr";
  contents.instrument = "AMSU-A";
  contents.message_count = static_cast<std::uint32_t>(scan.messages.size());
  contents.observations.channels.resize(kAmsuAChannelCount);
  std::iota(contents.observations.channels.begin(), contents.observations.channels.end(), 1);

  Refusals refusals;
  skip_unused_bytes(scan, contents, refusals);
  for (std::uint32_t number = 0; number < scan.messages.size(); ++number)
    read_message(bytes, scan.messages[number], number, contents, refusals);
  std::stable_sort(contents.skipped.begin(), contents.skipped.end(),
                   [](const SkippedPart& a, const SkippedPart& b) { return a.offset < b.offset; });
  if (contents.observations.size() == 0) return refusals.error(name);
  return contents;
}

}  // namespace thin
