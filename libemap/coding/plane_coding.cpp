#include "libemap/coding/plane_coding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace emap {
namespace {

using Eigen::Vector3d;

constexpr double kNormalSteps = (1U << kNormalBits) - 1;
constexpr double kTurnSteps = 1U << kTurnBits;

double sign_of(double x) {
  return x < 0 ? -1 : 1;
}

// Octahedral map: the sphere's upper half onto the diamond |x| + |y| <= 1, the lower half folded over its edges.
Vector3d normal_of(const CodedPlane& coded) {
  const double x = 2 * coded.normal_x / kNormalSteps - 1;
  const double y = 2 * coded.normal_y / kNormalSteps - 1;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z >= 0) return Vector3d(x, y, z).normalized();
  return Vector3d((1 - std::abs(y)) * sign_of(x), (1 - std::abs(x)) * sign_of(y), z).normalized();
}

void set_normal(CodedPlane& coded, const Vector3d& normal) {
  const Vector3d n = normal / normal.lpNorm<1>();
  const double x = n.z() >= 0 ? n.x() : (1 - std::abs(n.y())) * sign_of(n.x());
  const double y = n.z() >= 0 ? n.y() : (1 - std::abs(n.x())) * sign_of(n.y());
  coded.normal_x = static_cast<std::uint32_t>(std::lround((x + 1) / 2 * kNormalSteps));
  coded.normal_y = static_cast<std::uint32_t>(std::lround((y + 1) / 2 * kNormalSteps));
}

// A frame around a normal without a jump but at z = 0 (T. Duff and others, "Building an orthonormal basis, revisited").
BasePlane unturned(const Vector3d& n) {
  const double sign = sign_of(n.z());
  const double a = -1 / (sign + n.z());
  const double b = n.x() * n.y() * a;
  BasePlane plane;
  plane.normal = n;
  plane.axis_u = Vector3d(1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
  plane.axis_v = Vector3d(b, sign + n.y() * n.y() * a, -n.y());
  return plane;
}

BasePlane axes_of(const CodedPlane& coded) {
  BasePlane plane = unturned(normal_of(coded));
  const double angle = std::numbers::pi / 2 * coded.turn / kTurnSteps;
  const Vector3d u = plane.axis_u, v = plane.axis_v;
  plane.axis_u = std::cos(angle) * u + std::sin(angle) * v;
  plane.axis_v = std::cos(angle) * v - std::sin(angle) * u;
  return plane;
}

// Turns by quarters change the map's rows to columns, no more.
std::uint32_t turn_of(const BasePlane& plane, const BasePlane& unturned_plane) {
  const double angle = std::atan2(plane.axis_u.dot(unturned_plane.axis_v), plane.axis_u.dot(unturned_plane.axis_u));
  const double quarters = angle / (std::numbers::pi / 2);
  return static_cast<std::uint32_t>(std::lround((quarters - std::floor(quarters)) * kTurnSteps)) % (1U << kTurnBits);
}

// Every coordinate from the centre is within half the diagonal; one more for rounding.
std::int32_t farthest(const StreamFrame& frame) {
  return static_cast<std::int32_t>(frame.samples_per_diagonal / 2) + 2;
}

std::uint32_t origin_bits(const StreamFrame& frame) {
  return static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint32_t>(2 * farthest(frame))));
}

std::uint32_t size_bits(const StreamFrame& frame) {
  return static_cast<std::uint32_t>(std::bit_width(frame.samples_per_diagonal + 2));
}

template <class Coder>
void code_origin(Coder& coder, std::int32_t& value, const StreamFrame& frame) {
  const std::int32_t offset = farthest(frame);
  value =
      static_cast<std::int32_t>(code_uniform(coder, static_cast<std::uint32_t>(value + offset), origin_bits(frame))) -
      offset;
}

}  // namespace

BasePlane base_plane_of(const CodedPlane& coded, const StreamFrame& frame) {
  BasePlane plane = axes_of(coded);
  const Vector3d centre = (frame.box.minimum + frame.box.maximum) / 2;
  const Vector3d offset = coded.origin_u * plane.axis_u + coded.origin_v * plane.axis_v + coded.origin_n * plane.normal;
  plane.origin = centre + frame.spacing() * offset;
  return plane;
}

CodedPlane quantise_plane(const BasePlane& plane, std::span<const Vector3d> positions, const StreamFrame& frame) {
  CodedPlane coded;
  set_normal(coded, plane.normal);
  coded.turn = turn_of(plane, axes_of(coded));
  const BasePlane axes = axes_of(coded);
  const Vector3d centre = (frame.box.minimum + frame.box.maximum) / 2;
  Vector3d least = Vector3d::Constant(std::numeric_limits<double>::max()), most = -least;
  for (const Vector3d& position : positions) {
    const Vector3d from_centre = (position - centre) / frame.spacing();
    const Vector3d local(from_centre.dot(axes.axis_u), from_centre.dot(axes.axis_v), from_centre.dot(axes.normal));
    least = least.cwiseMin(local);
    most = most.cwiseMax(local);
  }
  const auto whole = [&](double x) {
    return std::clamp(static_cast<std::int32_t>(std::floor(x)), -farthest(frame), farthest(frame));
  };
  coded.origin_u = whole(least.x());
  coded.origin_v = whole(least.y());
  coded.origin_n = whole((least.z() + most.z()) / 2);
  return coded;
}

std::uint32_t plane_bits(const StreamFrame& frame) {
  return 2 * kNormalBits + kTurnBits + 3 * origin_bits(frame) + 2 * size_bits(frame);
}

template <class Coder>
void code_plane(Coder& coder, CodedPlane& plane, const StreamFrame& frame) {
  plane.normal_x = code_uniform(coder, plane.normal_x, kNormalBits);
  plane.normal_y = code_uniform(coder, plane.normal_y, kNormalBits);
  plane.turn = code_uniform(coder, plane.turn, kTurnBits);
  code_origin(coder, plane.origin_u, frame);
  code_origin(coder, plane.origin_v, frame);
  code_origin(coder, plane.origin_n, frame);
  plane.columns = code_uniform(coder, plane.columns, size_bits(frame));
  plane.rows = code_uniform(coder, plane.rows, size_bits(frame));
}

template void code_plane(RangeEncoder&, CodedPlane&, const StreamFrame&);
template void code_plane(RangeDecoder&, CodedPlane&, const StreamFrame&);
template void code_plane(BitCounter&, CodedPlane&, const StreamFrame&);

}  // namespace emap
