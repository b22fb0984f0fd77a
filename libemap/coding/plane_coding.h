#pragma once

// Base planes as eight whole numbers each (thesis, 4.2: side information): two of the normal, one of the turn around
// it, three of the origin, and the columns and rows of the map. The surface is sampled over the plane that these
// numbers give, so that their coarseness costs nothing but a slightly larger map.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "libemap/coding/range_coder.h"
#include "libemap/elevation/elevation_map.h"
#include "libemap/surface/bounding_box.h"

namespace emap {

// What all patches of a stream share. The box has single-precision corners, and holds the surface.
struct StreamFrame {
  BoundingBox box;
  std::uint32_t samples_per_diagonal = 1;

  double spacing() const { return box.diagonal() / samples_per_diagonal; }
};

constexpr std::uint32_t kNormalBits = 10;  // for each of the two numbers
constexpr std::uint32_t kTurnBits = 6;     // of a quarter turn
constexpr std::uint32_t kMostSamplesPerDiagonal = 1U << 16;

struct CodedPlane {
  std::uint32_t normal_x = 0, normal_y = 0;  // octahedral map of the unit sphere, each in [0, 2^kNormalBits)
  std::uint32_t turn = 0;                    // in [0, 2^kTurnBits)
  std::int32_t origin_u = 0, origin_v = 0, origin_n = 0;  // from the box's centre, in spacings along the plane's axes
  std::uint32_t columns = 0, rows = 0;

  bool operator==(const CodedPlane&) const = default;
};

BasePlane base_plane_of(const CodedPlane& coded, const StreamFrame& frame);

// Quantised so that the positions lie at u >= 0 and v >= 0 of the origin, and at elevations around 0. columns and rows
// stay 0: sampling tells them. `plane` gives normal and axes.
CodedPlane quantise_plane(const BasePlane& plane, std::span<const Eigen::Vector3d> positions, const StreamFrame& frame);

// Bits of one plane in the stream.
std::uint32_t plane_bits(const StreamFrame& frame);

// Writes `plane`, or reads it: every number with as many bits as its range needs, none more likely than another.
template <class Coder>
void code_plane(Coder& coder, CodedPlane& plane, const StreamFrame& frame);

// A whole number below 2^bits, highest bit first, no value more likely than another.
template <class Coder>
std::uint32_t code_uniform(Coder& coder, std::uint32_t value, std::uint32_t bits) {
  std::uint32_t read = 0;
  for (std::uint32_t bit = bits; bit-- > 0;)
    read = read << 1 | static_cast<std::uint32_t>(coder.code((value >> bit & 1) != 0, kProbabilityOne / 2));
  return read;
}

}  // namespace emap
