#include "libthin/observations/observation_set.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

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

// Calls body(vector of a, the same vector of b) for every vector that has one entry per observation.
template <class Body>
void each_column(ObservationSet& a, const ObservationSet& b, const Body& body) {
  body(a.latitude_deg, b.latitude_deg);
  body(a.longitude_deg, b.longitude_deg);
  body(a.position_km, b.position_km);
  body(a.time_ms, b.time_ms);
  body(a.platform, b.platform);
  body(a.instrument, b.instrument);
  body(a.scan_line, b.scan_line);
  body(a.field_of_view, b.field_of_view);
  body(a.surface, b.surface);
  body(a.source, b.source);
}

void gather_rows(const std::vector<double>& from, std::size_t width, std::span<const std::uint32_t> rows,
                 std::vector<double>& to) {
  to.reserve(to.size() + rows.size() * width);
  for (const std::uint32_t row : rows)
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(row * width),
              from.begin() + static_cast<std::ptrdiff_t>((row + 1) * width));
}

using ChannelName = std::pair<Instrument, int>;

std::vector<ChannelName> channel_names(const ObservationSet& set) {
  const Instrument only = set.instrument.empty() ? Instrument::unknown : set.instrument.front();
  std::vector<ChannelName> names;
  for (std::size_t c = 0; c < set.channels.size(); ++c)
    names.emplace_back(set.channel_instrument.empty() ? only : set.channel_instrument[c], set.channels[c]);
  return names;
}

// rows x names as rows x wanted, NaN where a wanted channel is not among the names.
std::vector<double> spread(const std::vector<double>& from, const std::vector<ChannelName>& names,
                           const std::vector<ChannelName>& wanted, std::size_t rows) {
  std::vector<double> to(rows * wanted.size(), kMissing);
  for (std::size_t c = 0; c < names.size() && !from.empty(); ++c) {
    const auto place =
        static_cast<std::size_t>(std::lower_bound(wanted.begin(), wanted.end(), names[c]) - wanted.begin());
    for (std::size_t row = 0; row < rows; ++row) to[row * wanted.size() + place] = from[row * names.size() + c];
  }
  return to;
}

}  // namespace

const char* instrument_name(Instrument instrument) {
  switch (instrument) {
    case Instrument::amsua:
      return "AMSU-A";
    case Instrument::amsub:
      return "AMSU-B";
    case Instrument::mhs:
      return "MHS";
    case Instrument::hirs:
      return "HIRS";
    case Instrument::atms:
      return "ATMS";
    case Instrument::unknown:
      break;
  }
  return "unknown instrument";
}

void ObservationSet::push_back(const Entry& entry, std::span<const double> entry_values) {
  assert(entry_values.size() == channels.size());
  latitude_deg.push_back(entry.latitude_deg);
  longitude_deg.push_back(entry.longitude_deg);
  position_km.push_back(geocentric_km(entry.latitude_deg, entry.longitude_deg));
  time_ms.push_back(entry.time_ms);
  platform.push_back(entry.platform);
  instrument.push_back(entry.instrument);
  scan_line.push_back(entry.scan_line);
  field_of_view.push_back(entry.field_of_view);
  surface.push_back(entry.surface);
  source.push_back(entry.source);
  values.insert(values.end(), entry_values.begin(), entry_values.end());
  if (!first_guess_k.empty()) first_guess_k.resize(values.size(), kMissing);
  for (auto& [name, column] : variables) column.push_back(kMissing);
}

void ObservationSet::append(const ObservationSet& other) {
  if (other.size() == 0) return;
  if (size() == 0) {
    *this = other;
    return;
  }
  assert(value_kind == other.value_kind);
  const std::size_t before = size(), total = before + other.size();
  const std::vector<ChannelName> names = channel_names(*this), other_names = channel_names(other);
  const bool has_first_guess = !first_guess_k.empty() || !other.first_guess_k.empty();
  if (names == other_names) {
    if (has_first_guess) {
      first_guess_k.resize(values.size(), kMissing);
      extend(first_guess_k, other.first_guess_k);
      first_guess_k.resize(values.size() + other.values.size(), kMissing);
    }
    extend(values, other.values);
  } else {
    std::vector<ChannelName> all;
    std::set_union(names.begin(), names.end(), other_names.begin(), other_names.end(), std::back_inserter(all));
    const auto joined = [&](const std::vector<double>& ours, const std::vector<double>& theirs) {
      std::vector<double> rows = spread(ours, names, all, before);
      extend(rows, spread(theirs, other_names, all, other.size()));
      return rows;
    };
    values = joined(values, other.values);
    if (has_first_guess) first_guess_k = joined(first_guess_k, other.first_guess_k);
    channels.clear();
    channel_instrument.clear();
    for (const auto& [whose, number] : all) {
      channels.push_back(number);
      channel_instrument.push_back(whose);
    }
  }
  each_column(*this, other, [](auto& to, const auto& from) { extend(to, from); });
  for (const auto& [name, column] : other.variables) variables.try_emplace(name, before, kMissing);
  for (auto& [name, column] : variables) {
    const auto found = other.variables.find(name);
    if (found != other.variables.end()) extend(column, found->second);
    column.resize(total, kMissing);
  }
}

void ObservationSet::reserve(std::size_t count) {
  each_column(*this, *this, [&](auto& column, const auto&) { column.reserve(count); });
  values.reserve(count * channels.size());
}

std::vector<double> ObservationSet::values_or_zero() const {
  std::vector<double> result = values;
  if (channel_instrument.empty()) return result;
  for (std::size_t i = 0; i < result.size(); ++i)
    if (!measures(i / channels.size(), i % channels.size())) result[i] = 0;
  return result;
}

ObservationSet ObservationSet::select(std::span<const std::uint32_t> indices) const {
  ObservationSet selected;
  selected.channels = channels;
  selected.channel_instrument = channel_instrument;
  selected.value_kind = value_kind;
  each_column(selected, *this, [&](auto& to, const auto& from) { gather(from, indices, to); });
  gather_rows(values, channels.size(), indices, selected.values);
  if (!first_guess_k.empty()) gather_rows(first_guess_k, channels.size(), indices, selected.first_guess_k);
  for (const auto& [name, column] : variables) gather(column, indices, selected.variables[name]);
  return selected;
}

ObservationSet ObservationSet::select_channels(std::span<const std::size_t> places) const {
  const auto narrowed = [&](const std::vector<double>& rows) {
    std::vector<double> result;
    result.reserve(rows.empty() ? 0 : size() * places.size());
    for (std::size_t row = 0; row < rows.size(); row += channels.size())
      for (const std::size_t place : places) result.push_back(rows[row + place]);
    return result;
  };
  ObservationSet selected = *this;
  selected.values = narrowed(values);
  selected.first_guess_k = narrowed(first_guess_k);
  selected.channels.clear();
  selected.channel_instrument.clear();
  for (const std::size_t place : places) {
    selected.channels.push_back(channels[place]);
    if (!channel_instrument.empty()) selected.channel_instrument.push_back(channel_instrument[place]);
  }
  return selected;
}

std::vector<std::uint32_t> canonical_order(const ObservationSet& set) {
  std::vector<std::uint32_t> order(set.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto scan_key = [&](std::uint32_t i) {
    return std::tuple(set.time_ms[i], set.platform[i], set.instrument[i], set.scan_line[i], set.field_of_view[i],
                      set.latitude_deg[i], set.longitude_deg[i]);
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
