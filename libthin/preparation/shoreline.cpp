#include "libthin/preparation/shoreline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

constexpr std::size_t kStrips = 3600;
constexpr double kStripDeg = 0.1;
constexpr double kLongestPieceKm = 25;

// Brought to 0 <= x < 360; what is there already stays as it is, to the last bit.
double turned(double longitude_deg) {
  const double turned_deg = longitude_deg - 360 * std::floor(longitude_deg / 360);
  return turned_deg < 360 ? turned_deg : 0;
}

std::size_t strip_of(double longitude_deg) {
  return std::min(static_cast<std::size_t>(longitude_deg / kStripDeg), kStrips - 1);
}

Vector3 along(const Vector3& a, const Vector3& b, double share) {
  return {std::lerp(a.x, b.x, share), std::lerp(a.y, b.y, share), std::lerp(a.z, b.z, share)};
}

// Distance from a point to a straight piece.
double distance_km(const Vector3& p, const Vector3& from, const Vector3& to) {
  const Vector3 d{to.x - from.x, to.y - from.y, to.z - from.z};
  const double squared = d.x * d.x + d.y * d.y + d.z * d.z;
  const double dot = (p.x - from.x) * d.x + (p.y - from.y) * d.y + (p.z - from.z) * d.z;
  const double share = squared > 0 ? std::clamp(dot / squared, 0.0, 1.0) : 0;
  return chord_km(p, along(from, to, share));
}

}  // namespace

Shoreline::Shoreline(std::span<const ShoreEdge> edges) : middles_({}, 3) {
  std::vector<Span> spans;
  for (const ShoreEdge& edge : edges) {
    add_spans(edge, spans);
    if (edge.is_shore) add_pieces(edge);
  }
  sort_into_strips(spans);
  std::vector<double> coordinates;
  coordinates.reserve(3 * pieces_.size());
  for (const Piece& piece : pieces_) {
    const Vector3 middle = along(piece.from_km, piece.to_km, 0.5);
    coordinates.insert(coordinates.end(), {middle.x, middle.y, middle.z});
  }
  middles_ = KdTree(coordinates, 3);
}

// From west to east; in two where the edge crosses the meridian of 0. Ends are turned each by itself, so that edges
// which meet go on meeting. An edge along a meridian is never crossed by a line to the pole.
void Shoreline::add_spans(const ShoreEdge& edge, std::vector<Span>& spans) const {
  double west = turned(edge.from_longitude_deg), east = turned(edge.to_longitude_deg);
  double west_latitude = edge.from_latitude_deg, east_latitude = edge.to_latitude_deg;
  const bool crosses = std::abs(east - west) > 180;
  if ((west > east) != crosses) {
    std::swap(west, east);
    std::swap(west_latitude, east_latitude);
  }
  if (west == east) return;
  if (!crosses) return spans.push_back({west, east, west_latitude, east_latitude});
  const double latitude = std::lerp(west_latitude, east_latitude, (360 - west) / (360 - west + east));
  spans.push_back({west, 360, west_latitude, latitude});
  if (east > 0) spans.push_back({0, east, latitude, east_latitude});
}

void Shoreline::add_pieces(const ShoreEdge& edge) {
  double longitude_to = edge.to_longitude_deg;
  if (longitude_to - edge.from_longitude_deg < -180) longitude_to += 360;
  if (longitude_to - edge.from_longitude_deg > 180) longitude_to -= 360;
  const auto at = [&](double share) {
    return geocentric_km(std::lerp(edge.from_latitude_deg, edge.to_latitude_deg, share),
                         std::lerp(edge.from_longitude_deg, longitude_to, share));
  };
  // A long edge along a parallel is longer than the straight line between its ends.
  const double degrees = std::max(std::abs(edge.to_latitude_deg - edge.from_latitude_deg),
                                  std::abs(longitude_to - edge.from_longitude_deg));
  const double length_km = std::max(chord_km(at(0), at(1)), degrees > 10 ? degrees * 112 : 0);
  const auto count = std::max(1, static_cast<int>(std::ceil(length_km / kLongestPieceKm)));
  for (int piece = 0; piece < count; ++piece)
    pieces_.push_back({at(static_cast<double>(piece) / count), at(static_cast<double>(piece + 1) / count)});
}

void Shoreline::sort_into_strips(const std::vector<Span>& spans) {
  strip_begin_.assign(kStrips + 1, 0);
  const auto each_strip = [](const Span& span, const auto& body) {
    for (std::size_t strip = strip_of(span.west_deg); strip <= strip_of(span.east_deg); ++strip) body(strip);
  };
  for (const Span& span : spans) each_strip(span, [&](std::size_t strip) { ++strip_begin_[strip + 1]; });
  for (std::size_t strip = 0; strip < kStrips; ++strip) strip_begin_[strip + 1] += strip_begin_[strip];
  spans_.resize(strip_begin_.back());
  std::vector<std::size_t> next(strip_begin_.begin(), strip_begin_.end() - 1);
  for (const Span& span : spans) each_strip(span, [&](std::size_t strip) { spans_[next[strip]++] = span; });
}

bool Shoreline::is_land(double latitude_deg, double longitude_deg) const {
  const double longitude = turned(longitude_deg);
  const std::size_t strip = strip_of(longitude);
  bool inside = false;
  for (std::size_t s = strip_begin_[strip]; s < strip_begin_[strip + 1]; ++s) {
    const Span& span = spans_[s];
    if (longitude < span.west_deg || longitude >= span.east_deg) continue;
    const double share = (longitude - span.west_deg) / (span.east_deg - span.west_deg);
    if (std::lerp(span.west_latitude_deg, span.east_latitude_deg, share) > latitude_deg) inside = !inside;
  }
  return inside;
}

bool Shoreline::is_near(const Vector3& position_km, double distance) const {
  const std::array<double, 3> query = {position_km.x, position_km.y, position_km.z};
  thread_local std::vector<Neighbour> found;
  middles_.radius_search(query, distance + kLongestPieceKm, found);
  return std::any_of(found.begin(), found.end(), [&](const Neighbour& neighbour) {
    const Piece& piece = pieces_[neighbour.index];
    return distance_km(position_km, piece.from_km, piece.to_km) <= distance;
  });
}

}  // namespace thin
