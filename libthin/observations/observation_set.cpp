#include "libthin/observations/observation_set.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <numeric>
#include <tuple>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

// The vectors of `from` at `indices`, appended to those of `to`.
template <class T>
void gather(const std::vector<T>& from, std::span<const std::uint32_t> indices, std::vector<T>& to) {
  to.reserve(to.size() + indices.size());
  for (const std::uint32_t index : indices) to.push_back(from[index]);
}

template <class T>
void extend(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

// Bit patterns give NaN (missing) a place in the order, which `<` does not.
bool values_less(std::span<const double> a, std::span<const double> b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) < std::bit_cast<std::uint64_t>(y);
  });
}

}  // namespace

void ObservationSet::push_back(const Entry& entry, std::span<const double> entry_values) {
  assert(entry_values.size() == channels.size());
  latitude_deg.push_back(entry.latitude_deg);
  longitude_deg.push_back(entry.longitude_deg);
  position_km.push_back(geocentric_km(entry.latitude_deg, entry.longitude_deg));
  time_ms.push_back(entry.time_ms);
  platform.push_back(entry.platform);
  scan_line.push_back(entry.scan_line);
  field_of_view.push_back(entry.field_of_view);
  surface.push_back(entry.surface);
  source.push_back(entry.source);
  values.insert(values.end(), entry_values.begin(), entry_values.end());
}

void ObservationSet::append(const ObservationSet& other) {
  assert(channels == other.channels && value_kind == other.value_kind);
  extend(latitude_deg, other.latitude_deg);
  extend(longitude_deg, other.longitude_deg);
  extend(position_km, other.position_km);
  extend(time_ms, other.time_ms);
  extend(platform, other.platform);
  extend(scan_line, other.scan_line);
  extend(field_of_view, other.field_of_view);
  extend(surface, other.surface);
  extend(values, other.values);
  extend(source, other.source);
}

void ObservationSet::reserve(std::size_t count) {
  latitude_deg.reserve(count);
  longitude_deg.reserve(count);
  position_km.reserve(count);
  time_ms.reserve(count);
  platform.reserve(count);
  scan_line.reserve(count);
  field_of_view.reserve(count);
  surface.reserve(count);
  values.reserve(count * channels.size());
  source.reserve(count);
}

ObservationSet ObservationSet::select(std::span<const std::uint32_t> indices) const {
  ObservationSet selected;
  selected.channels = channels;
  selected.value_kind = value_kind;
  gather(latitude_deg, indices, selected.latitude_deg);
  gather(longitude_deg, indices, selected.longitude_deg);
  gather(position_km, indices, selected.position_km);
  gather(time_ms, indices, selected.time_ms);
  gather(platform, indices, selected.platform);
  gather(scan_line, indices, selected.scan_line);
  gather(field_of_view, indices, selected.field_of_view);
  gather(surface, indices, selected.surface);
  gather(source, indices, selected.source);
  selected.values.reserve(indices.size() * channels.size());
  for (const std::uint32_t index : indices) {
    const auto row = values_of(index);
    selected.values.insert(selected.values.end(), row.begin(), row.end());
  }
  return selected;
}

ObservationSet ObservationSet::select_channels(std::span<const std::size_t> places) const {
  ObservationSet selected = *this;
  selected.channels.clear();
  for (const std::size_t place : places) selected.channels.push_back(channels[place]);
  selected.values.clear();
  selected.values.reserve(size() * places.size());
  for (std::size_t i = 0; i < size(); ++i)
    for (const std::size_t place : places) selected.values.push_back(values_of(i)[place]);
  return selected;
}

std::vector<std::uint32_t> canonical_order(const ObservationSet& set) {
  std::vector<std::uint32_t> order(set.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto scan_key = [&](std::uint32_t i) {
    return std::tuple(set.time_ms[i], set.platform[i], set.scan_line[i], set.field_of_view[i], set.latitude_deg[i],
                      set.longitude_deg[i]);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto key_a = scan_key(a);
    const auto key_b = scan_key(b);
    if (key_a != key_b) return key_a < key_b;
    if (values_less(set.values_of(a), set.values_of(b))) return true;
    if (values_less(set.values_of(b), set.values_of(a))) return false;
    return set.source[a] < set.source[b];
  });
  return order;
}

}  // namespace thin
