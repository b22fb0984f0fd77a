// Any bytes as a BUFR file, by the same functions as the worker calls: read, and the retained half extracted. What was
// extracted must be read again, with the same observations.

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "libthin/formats/bufr_extraction.h"
#include "libthin/formats/bufr_file.h"
#include "libthin/foundation/file_bytes.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using Bytes = std::span<const std::uint8_t>;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

void check_sound(const thin::ReadObservations& contents) {
  const thin::ObservationSet& set = contents.observations;
  require(set.size() > 0, "some observations");
  require(set.values.size() == set.size() * set.channels.size(), "a row of values for each observation");
  for (const auto& [name, column] : set.variables) require(column.size() == set.size(), "whole variables");
  for (std::size_t i = 0; i < set.size(); ++i) {
    require(std::abs(set.latitude_deg[i]) <= 90, "latitude");
    require(set.longitude_deg[i] >= -180 && set.longitude_deg[i] <= 360, "longitude");
    require(set.source[i].message < contents.message_count, "message number");
  }
}

void check_extraction(Bytes bytes, const thin::ObservationSet& set) {
  static const std::string path = "/dev/shm/thin.fuzz." + std::to_string(::getpid());
  std::vector<thin::SourceReference> retained;
  std::vector<std::uint32_t> places;
  for (std::uint32_t i = 0; i < set.size(); i += 2) {
    retained.push_back(set.source[i]);
    places.push_back(i);
  }
  const auto summary = thin::extract_bufr(bytes, "fuzz", retained, path, {});
  require(summary.ok(), "what was read can be extracted");
  const auto written = thin::read_file_bytes(path);
  require(written.ok() && written->size() == summary->bytes, "what was extracted is there");
  const auto again = thin::read_bufr(*written, "again");
  ::unlink(path.c_str());
  require(again.ok(), "what was extracted can be read");
  const thin::ObservationSet expected = set.select(places);
  require(again->observations.size() == expected.size(), "as many as were retained");
  require(again->observations.channels == expected.channels || !set.channel_instrument.empty(), "the same channels");
  if (again->observations.channels != expected.channels) return;
  require(again->observations.time_ms == expected.time_ms, "the same times");
  require(std::equal(expected.values.begin(), expected.values.end(), again->observations.values.begin(), same),
          "the same values");
}

std::uint32_t number_at(const std::uint8_t* bytes) {
  return static_cast<std::uint32_t>(bytes[0]) << 16 | static_cast<std::uint32_t>(bytes[1]) << 8 | bytes[2];
}

void put_number(std::uint8_t* bytes, std::size_t value) {
  for (int i = 2; i >= 0; --i, value >>= 8) bytes[i] = static_cast<std::uint8_t>(value);
}

// Makes the lengths of message and section 4 right again, so that a search gets past the first check.
void repair(std::uint8_t* data, std::size_t size) {
  for (std::uint8_t *begin = data, *const end = data + size; end - begin >= 30;) {
    begin = static_cast<std::uint8_t*>(::memmem(begin, static_cast<std::size_t>(end - begin), "BUFR", 4));
    if (!begin) return;
    auto* last = static_cast<std::uint8_t*>(::memmem(begin, static_cast<std::size_t>(end - begin), "7777", 4));
    if (!last) return;
    const auto length = static_cast<std::size_t>(last - begin);
    put_number(begin + 4, length + 4);
    std::size_t place = 8;
    const bool has_section2 = length > 18 && begin[begin[7] == 4 ? 17 : 15] & 0x80;
    for (int section = has_section2 ? 3 : 2; section > 0 && place + 3 < length; --section)
      place += number_at(begin + place);
    if (place + 4 <= length) put_number(begin + place, length - place);
    begin = last + 4;
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, max_size);
  if (seed % 4 != 0) repair(data, mutated);
  return mutated;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes bytes(data, size);
  const auto contents = thin::read_bufr(bytes, "fuzz");
  if (!contents) {
    require(!contents.error().message.empty(), "a reason");
    require(contents.error().kind == thin::ErrorKind::input || contents.error().kind == thin::ErrorKind::incomplete,
            "an error of the input's");
    return 0;
  }
  check_sound(*contents);
  check_extraction(bytes, contents->observations);
  return 0;
}
