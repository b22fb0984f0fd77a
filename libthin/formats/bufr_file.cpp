#include "libthin/formats/bufr_file.h"

#include <algorithm>
#include <map>
#include <vector>

#include "libthin/formats/bufr_observations.h"

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
    if (sorted.empty()) return {ErrorKind::input, name + ": no BUFR message in it. Send files of BUFR with soundings."};
    const std::string remedy = " " + sorted.front().second.remedy;
    return {ErrorKind::input, name + ": nothing in it can be thinned. Its messages: " + list + "." + remedy};
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

// Reads messages in the order of the file.
class MessageReader {
 public:
  MessageReader(std::span<const std::uint8_t> bytes, BufrTemperature temperature, ReadObservations& contents,
                Refusals& refusals)
      : bytes_(bytes), temperature_(temperature), contents_(contents), refusals_(refusals) {}

  void read(const BufrMessage& message, std::uint32_t number) {
    const auto skip = [&](const std::string& reason, const std::string& remedy) {
      contents_.skipped.push_back({number, message.offset, reason});
      refusals_.add(reason, remedy);
    };
    const SoundingMessage soundings =
        open_soundings(bytes_.subspan(message.offset, message.length), message.header, tables_);
    if (soundings.state == SoundingMessage::State::tables) {
      ++table_messages_;
      return;
    }
    if (soundings.state != SoundingMessage::State::soundings) return skip(soundings.reason, soundings.remedy);

    const std::uint32_t left_out = append_soundings(soundings, number, temperature_, sets_);
    if (left_out > 0)
      skip(counted(left_out, "subset") + " without usable position or time, or of another instrument",
           "Ask the sender for located soundings.");
  }

  // All instruments together.
  void finish() {
    if (table_messages_ > 0)
      contents_.notes.push_back("decoded with the tables that it brings, in " + counted(table_messages_, "message"));
    for (auto& [instrument, set] : sets_) {
      if (set.size() == 0) continue;
      contents_.instrument += (contents_.instrument.empty() ? "" : ", ") + std::string(instrument_name(instrument));
      if (contents_.observations.size() == 0)
        contents_.observations = std::move(set);
      else
        contents_.observations.append(set);
    }
  }

 private:
  std::span<const std::uint8_t> bytes_;
  BufrTemperature temperature_;
  ReadObservations& contents_;
  Refusals& refusals_;
  BufrFileTables tables_;
  std::size_t table_messages_ = 0;
  SoundingSets sets_;
};

}  // namespace

Result<void> check_complete(const BufrScan& scan, const std::string& name) {
  if (!scan.cut_offset) return {};
  const std::string where =
      name + ": the file is cut at its end, in the message that begins at byte " + std::to_string(*scan.cut_offset);
  return Error{ErrorKind::incomplete, where + ". Wait for the rest, or ask the sender for it again."};
}

Result<ReadObservations> read_bufr(std::span<const std::uint8_t> bytes, const std::string& name,
                                   BufrTemperature temperature) {
  const BufrScan scan = scan_bufr(bytes);
  if (const Result<void> complete = check_complete(scan, name); !complete) return complete.error();
  ReadObservations contents;
  contents.layout = kBufrLayout;
  contents.message_count = static_cast<std::uint32_t>(scan.messages.size());

  Refusals refusals;
  skip_unused_bytes(scan, contents, refusals);
  MessageReader reader(bytes, temperature, contents, refusals);
  for (std::uint32_t number = 0; number < scan.messages.size(); ++number) reader.read(scan.messages[number], number);
  reader.finish();
  std::stable_sort(contents.skipped.begin(), contents.skipped.end(),
                   [](const SkippedPart& a, const SkippedPart& b) { return a.offset < b.offset; });
  if (contents.observations.size() == 0) return refusals.error(name);
  return contents;
}

}  // namespace thin
