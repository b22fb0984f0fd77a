#include "libemap/coding/stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "libemap/coding/mask_coding.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

constexpr std::array<std::uint8_t, 4> kMagic = {'E', 'M', 'A', 'P'};
constexpr std::size_t kCheckOffset = 7;
constexpr std::uint8_t kFromPoints = 1;
constexpr double kStepsPerOctave = 64;
constexpr std::uint32_t kMostPatches = 1U << 20;

// ---- bytes
// -----------------------------------------------------------------------------------------------------------

void append_number(std::vector<std::uint8_t>& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

// Seven bits to a byte, lowest first; the highest bit says that more follow.
void append_varint(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (; value >= 128; value >>= 7) bytes.push_back(static_cast<std::uint8_t>(value | 128));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

class HeaderBytes {
 public:
  explicit HeaderBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint64_t number(int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) value |= std::uint64_t{byte()} << 8 * i;
    return value;
  }
  double single() { return std::bit_cast<float>(static_cast<std::uint32_t>(number(4))); }
  std::uint32_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const std::uint8_t next = byte();
      value |= std::uint64_t{next & 127U} << shift;
      if (next < 128) break;
    }
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(value, std::numeric_limits<std::uint32_t>::max()));
  }
  bool past_end() const { return past_end_; }
  std::size_t position() const { return next_; }

 private:
  std::uint8_t byte() {
    if (next_ < bytes_.size()) return bytes_[next_++];
    past_end_ = true;
    return 0;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
  bool past_end_ = false;
};

// CRC-16/CCITT-FALSE over all bytes but the check itself.
std::uint16_t check_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFF;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i == kCheckOffset || i == kCheckOffset + 1) continue;
    crc ^= static_cast<std::uint32_t>(bytes[i]) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ (crc & 0x8000 ? 0x1021U : 0U);
    crc &= 0xFFFF;
  }
  return static_cast<std::uint16_t>(crc);
}

float rounded_down(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest <= x ? nearest : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

// ---- header
// ----------------------------------------------------------------------------------------------------------

std::vector<std::uint8_t> header_bytes(const StreamHeader& header) {
  std::vector<std::uint8_t> bytes(kMagic.begin(), kMagic.end());
  bytes.push_back(kStreamVersion);
  bytes.push_back(header.coder);
  bytes.push_back(header.from_points ? kFromPoints : 0);
  append_number(bytes, 0, 2);
  for (const Eigen::Vector3d* corner : {&header.frame.box.minimum, &header.frame.box.maximum})
    for (const double x : *corner) append_number(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)), 4);
  append_number(bytes, header.step_code, 2);
  append_varint(bytes, header.frame.samples_per_diagonal);
  append_varint(bytes, header.patch_count);
  return bytes;
}

struct HeaderAndSize {
  StreamHeader header;
  std::size_t bytes;
};

Result<HeaderAndSize> parse_header(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
    return Error{ErrorKind::input, "this is no .emap stream: it does not begin with EMAP"};
  HeaderBytes reader(bytes.subspan(kMagic.size()));
  StreamHeader header;
  const auto version = static_cast<std::uint8_t>(reader.number(1));
  if (bytes.size() > kMagic.size() && version != kStreamVersion)
    return Error{ErrorKind::input,
                 fmt::format("the stream has version {}; this program reads version {}: {}", version, kStreamVersion,
                             version > kStreamVersion ? "use a newer one" : "encode the surface again")};
  header.coder = static_cast<std::uint8_t>(reader.number(1));
  header.from_points = (reader.number(1) & kFromPoints) != 0;
  reader.number(2);
  for (Eigen::Vector3d* corner : {&header.frame.box.minimum, &header.frame.box.maximum})
    for (double& x : *corner) x = reader.single();
  header.step_code = static_cast<std::uint16_t>(reader.number(2));
  header.frame.samples_per_diagonal = reader.varint();
  header.patch_count = reader.varint();
  if (reader.past_end()) return Error{ErrorKind::incomplete, "the stream ends within its header: it was cut"};

  const double diagonal = header.frame.box.diagonal();
  const bool box_is_good = header.frame.box.minimum.allFinite() && header.frame.box.maximum.allFinite() &&
                           (header.frame.box.minimum.array() <= header.frame.box.maximum.array()).all() && diagonal > 0;
  if (!box_is_good) return Error{ErrorKind::input, "the bounding box is not one: the stream is damaged"};
  if (header.frame.samples_per_diagonal < 1 || header.frame.samples_per_diagonal > kMostSamplesPerDiagonal)
    return Error{ErrorKind::input, fmt::format("{} samples to a diagonal, which may be 1 to {}: the stream is damaged",
                                               header.frame.samples_per_diagonal, kMostSamplesPerDiagonal)};
  return HeaderAndSize{header, kMagic.size() + reader.position()};
}

Error cut_within(const char* part) {
  return {ErrorKind::incomplete, fmt::format("the stream ends within the {}: it was cut or is damaged", part)};
}

// Planes and the sizes of maps, with all limits checked before anything is allocated by them.
Result<std::vector<CodedPlane>> read_planes(RangeDecoder& decoder, const StreamHeader& header, std::size_t bytes) {
  if (std::uint64_t{header.patch_count} * plane_bits(header.frame) > 8 * (std::uint64_t{bytes} + 8) ||
      header.patch_count > kMostPatches)
    return Error{ErrorKind::input,
                 fmt::format("{} patches do not fit into {} bytes: the stream is damaged", header.patch_count, bytes)};
  std::vector<CodedPlane> planes(header.patch_count);
  std::uint64_t spanned = 0;
  for (CodedPlane& plane : planes) {
    code_plane(decoder, plane, header.frame);
    spanned += std::uint64_t{plane.columns} * plane.rows;
  }
  if (decoder.exhausted()) return cut_within("planes");
  if (spanned > most_samples_spanned(bytes))
    return Error{
        ErrorKind::input,
        fmt::format("maps of {} samples are more than {} bytes may hold: the stream is damaged", spanned, bytes)};
  return planes;
}

std::optional<Error> read_masks(RangeDecoder& decoder, const std::vector<CodedPlane>& planes, const StreamFrame& frame,
                                ElevationMaps& maps) {
  MaskCoding coding;
  for (const CodedPlane& plane : planes) {
    ElevationPatch patch;
    patch.plane = base_plane_of(plane, frame);
    patch.columns = plane.columns;
    patch.rows = plane.rows;
    patch.mask.resize(std::size_t{plane.columns} * plane.rows);
    coding.code(decoder, patch.columns, patch.rows, patch.mask);
    if (decoder.exhausted()) return cut_within("masks");
    maps.patches.push_back(std::move(patch));
  }
  return std::nullopt;
}

}  // namespace

double StreamHeader::step() const {
  return frame.box.diagonal() * std::exp2(-step_code / kStepsPerOctave);
}

std::uint16_t step_code_of(double step, double diagonal) {
  const double octaves = std::log2(diagonal / step);
  return static_cast<std::uint16_t>(std::clamp(std::lround(octaves * kStepsPerOctave), 0L, 65535L));
}

StreamFrame stream_frame(const BoundingBox& box, std::uint32_t samples_per_diagonal) {
  StreamFrame frame;
  for (int axis = 0; axis < 3; ++axis) {
    frame.box.minimum[axis] = rounded_down(box.minimum[axis]);
    frame.box.maximum[axis] = -rounded_down(-box.maximum[axis]);
  }
  frame.samples_per_diagonal = samples_per_diagonal;
  return frame;
}

std::uint64_t most_samples_spanned(std::uint64_t stream_bytes) {
  return std::min<std::uint64_t>((std::uint64_t{1} << 22) + 1024 * stream_bytes, std::uint64_t{1} << 28);
}

StreamWriter::StreamWriter(const ElevationCoder& coder, const StreamFrame& frame, std::vector<CodedPlane> planes,
                           ElevationMaps maps, bool from_points, BitDistribution distribution)
    : coder_(coder), planes_(std::move(planes)), maps_(std::move(maps)) {
  assert(planes_.size() == maps_.patches.size());
  header_.coder = coder.number;
  header_.from_points = from_points;
  header_.frame = frame;
  header_.patch_count = static_cast<std::uint32_t>(planes_.size());
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    planes_[i].columns = maps_.patches[i].columns;
    planes_[i].rows = maps_.patches[i].rows;
  }
  elevations_ = coder.writer(maps_, distribution);
}

std::vector<std::uint8_t> StreamWriter::write(double step) {
  header_.step_code = step_code_of(step, header_.frame.box.diagonal());
  RangeEncoder encoder;
  for (CodedPlane plane : planes_) code_plane(encoder, plane, header_.frame);
  MaskCoding masks;
  std::uint64_t spanned = 0;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    std::vector<std::uint8_t> mask = maps_.patches[i].mask;
    masks.code(encoder, planes_[i].columns, planes_[i].rows, mask);
    spanned += mask.size();
  }
  elevations_->write(header_.step(), encoder);

  std::vector<std::uint8_t> stream = header_bytes(header_);
  const std::vector<std::uint8_t> payload = encoder.finish();
  stream.insert(stream.end(), payload.begin(), payload.end());
  while (spanned > most_samples_spanned(stream.size()) &&
         most_samples_spanned(stream.size()) < most_samples_spanned(-1))
    stream.push_back(0);
  set_stream_check(stream);
  return stream;
}

void set_stream_check(std::vector<std::uint8_t>& stream) {
  const std::uint16_t check = check_of(stream);
  stream[kCheckOffset] = static_cast<std::uint8_t>(check);
  stream[kCheckOffset + 1] = static_cast<std::uint8_t>(check >> 8);
}

Result<StreamHeader> read_stream_header(std::span<const std::uint8_t> bytes) {
  Result<HeaderAndSize> parsed = parse_header(bytes);
  if (!parsed) return parsed.error();
  return parsed->header;
}

Result<DecodedStream> read_stream(std::span<const std::uint8_t> bytes) {
  const Result<HeaderAndSize> parsed = parse_header(bytes);
  if (!parsed) return parsed.error();
  const StreamHeader& header = parsed->header;
  if (check_of(bytes) != (bytes[kCheckOffset] | bytes[kCheckOffset + 1] << 8))
    return Error{ErrorKind::input, "the stream's check does not match its bytes: it was cut or changed on its way"};
  const ElevationCoder* coder = find_elevation_coder(header.coder);
  if (!coder)
    return Error{ErrorKind::input, fmt::format("the stream was written by coder number {}, which this program does not "
                                               "know: use a newer one",
                                               header.coder)};

  DecodedStream decoded;
  decoded.header = header;
  decoded.maps.spacing = header.frame.spacing();
  decoded.maps.diagonal = header.frame.box.diagonal();
  decoded.maps.box_minimum = header.frame.box.minimum;
  RangeDecoder decoder(bytes.subspan(parsed->bytes));
  const Result<std::vector<CodedPlane>> planes = read_planes(decoder, header, bytes.size());
  if (!planes) return planes.error();
  decoded.parts.header = parsed->bytes;
  decoded.parts.planes = decoder.bytes_read();
  if (const auto error = read_masks(decoder, *planes, header.frame, decoded.maps)) return *error;
  decoded.parts.masks = decoder.bytes_read() - decoded.parts.planes;
  if (const Result<void> read = coder->read(decoder, header.step(), decoded.maps); !read) return read.error();
  decoded.parts.elevations = bytes.size() - decoded.parts.header - decoded.parts.planes - decoded.parts.masks;
  return decoded;
}

}  // namespace emap
