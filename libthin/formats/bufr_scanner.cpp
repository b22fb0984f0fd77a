#include "libthin/formats/bufr_scanner.h"

#include <algorithm>
#include <cstring>

#include "libthin/formats/gts_bulletin.h"

namespace thin {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::size_t kLongestSection1 = 4096;

std::optional<std::size_t> find_marker(Bytes bytes, std::size_t from) {
  if (from >= bytes.size()) return std::nullopt;
  const void* found = ::memmem(bytes.data() + from, bytes.size() - from, "BUFR", 4);
  if (!found) return std::nullopt;
  return static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - bytes.data());
}

// What stands at a "BUFR".
struct Candidate {
  enum class Kind { message, damaged, cut, chance } kind = Kind::chance;
  std::size_t length = 0;
  BufrHeader header;
  std::string reason;  // where damaged or cut
};

// Whether the bytes after "BUFR", as far as they are there, can be a BUFR header at all: text and chance seldom can.
bool looks_like_header(Bytes rest) {
  if (rest.size() < kBufrSection0Size) return true;
  if (rest[7] < 2 || rest[7] > 4 || big_endian(rest, 4, 3) < kBufrSection0Size + kBufrSection5Size) return false;
  if (rest.size() < kBufrSection0Size + 3) return true;
  const std::size_t section1_length = big_endian(rest, kBufrSection0Size, 3);
  return section1_length >= 17 && section1_length <= kLongestSection1;
}

Candidate examine(Bytes bytes, std::size_t offset) {
  const Bytes rest = bytes.subspan(offset);
  Candidate candidate;
  if (!looks_like_header(rest)) return candidate;
  candidate.kind = Candidate::Kind::cut;
  if (rest.size() < kBufrSection0Size) {
    candidate.reason = "the file ends within section 0 of this message";
    return candidate;
  }
  candidate.length = big_endian(rest, 4, 3);
  if (candidate.length > rest.size()) {
    candidate.reason = "its length field says " + std::to_string(candidate.length) + " bytes, but only " +
                       std::to_string(rest.size()) + " are left of the file";
    return candidate;
  }
  candidate.kind = Candidate::Kind::damaged;
  const Bytes message = rest.first(candidate.length);
  if (std::memcmp(message.last(kBufrSection5Size).data(), "7777", kBufrSection5Size) != 0) {
    candidate.reason = "no 7777 at the end of its " + std::to_string(candidate.length) + " bytes";
    return candidate;
  }
  Result<BufrHeader> header = parse_bufr_header(message);
  if (!header) {
    candidate.reason = header.error().message;
    return candidate;
  }
  candidate.kind = Candidate::Kind::message;
  candidate.header = std::move(*header);
  return candidate;
}

bool is_padding(Bytes bytes) {
  return std::all_of(bytes.begin(), bytes.end(),
                     [](std::uint8_t byte) { return byte == 0 || byte == ' ' || byte == '\r' || byte == '\n'; });
}

class Scanner {
 public:
  explicit Scanner(Bytes bytes) : bytes_(bytes) {}

  BufrScan scan() {
    for (std::optional<std::size_t> marker = find_marker(bytes_, 0); marker;) {
      Candidate candidate = examine(bytes_, *marker);
      std::size_t next = *marker + 4;
      if (candidate.kind == Candidate::Kind::message) {
        next = *marker + candidate.length;
        add_message(*marker, std::move(candidate));
      } else if (candidate.kind != Candidate::Kind::chance) {
        suspects_.push_back({*marker, std::move(candidate)});
      }
      marker = find_marker(bytes_, next);
    }
    finish();
    return std::move(scan_);
  }

 private:
  struct Suspect {
    std::size_t offset;
    Candidate candidate;
  };

  void add_message(std::size_t offset, Candidate candidate) {
    const GtsHeading heading = find_gts_heading(bytes_.subspan(done_, offset - done_));
    const std::size_t heading_offset = offset - heading.size;
    const bool follows = offset == done_ && !scan_.bulletins.empty() && scan_.bulletins.back().trailer_size == 0;
    close_gap(heading_offset);
    if (follows) {
      ++scan_.bulletins.back().message_count;
    } else {
      scan_.bulletins.push_back(
          {scan_.messages.size(), 1, heading_offset, heading.size, heading.has_length_prefix, 0, 0});
    }
    scan_.messages.push_back({offset, candidate.length, std::move(candidate.header)});
    done_ = offset + candidate.length;
    Bulletin& bulletin = scan_.bulletins.back();
    bulletin.trailer_offset = done_;
    bulletin.trailer_size = bulletin.heading_size > 0 ? gts_trailer_size(bytes_.subspan(done_)) : 0;
    done_ += bulletin.trailer_size;
  }

  // Accounts for the bytes from done_ to `end`: stray ones, then damaged messages, each up to the next.
  void close_gap(std::size_t end) {
    add_unused(suspects_.empty() ? end : std::min(end, suspects_.front().offset), "");
    for (std::size_t i = 0; i < suspects_.size(); ++i)
      add_unused(i + 1 < suspects_.size() ? suspects_[i + 1].offset : end, suspects_[i].candidate.reason);
    suspects_.clear();
    done_ = end;
  }

  void add_unused(std::size_t end, const std::string& reason) {
    if (end <= done_) return;
    const Bytes gap = bytes_.subspan(done_, end - done_);
    scan_.unused.push_back({scan_.messages.size(), done_, gap.size(), is_padding(gap), reason});
    done_ = end;
  }

  // The rest of the file after the last message.
  void finish() {
    // A cut message hides nothing behind it but its own bytes: what was suspected there is no damage of its own.
    const auto cut = std::find_if(suspects_.begin(), suspects_.end(), [](const Suspect& suspect) {
      return suspect.candidate.kind == Candidate::Kind::cut;
    });
    if (cut != suspects_.end()) {
      scan_.cut_offset = cut->offset;
      suspects_.erase(cut + 1, suspects_.end());
    }
    std::size_t stray_end = suspects_.empty() ? bytes_.size() : suspects_.front().offset;
    std::size_t stray_begin = done_;
    while (stray_begin < stray_end && is_padding(bytes_.subspan(stray_begin, 1))) ++stray_begin;
    const Bytes stray = bytes_.subspan(stray_begin, stray_end - stray_begin);
    if (!scan_.messages.empty() && is_gts_end_marker(stray)) {
      scan_.has_end_marker = true;
      done_ = stray_begin + kGtsLengthPrefixSize;
    } else if (!scan_.cut_offset && suspects_.empty() && is_cut_gts_heading(stray)) {
      scan_.cut_offset = stray_begin;
    }
    close_gap(bytes_.size());
  }

  Bytes bytes_;
  BufrScan scan_;
  std::vector<Suspect> suspects_;  // since the last message
  std::size_t done_ = 0;           // everything before it is accounted for
};

}  // namespace

BufrScan scan_bufr(std::span<const std::uint8_t> bytes) {
  return Scanner(bytes).scan();
}

}  // namespace thin
