#include "libemap/coding/set_splitting.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <optional>

namespace emap {
namespace {

constexpr std::uint32_t kSizeClasses = 10;
constexpr std::uint32_t kEnergyClasses = 10;
constexpr std::uint32_t kLevels = 8;
constexpr std::array<std::uint32_t, 3> kSignificanceContexts = {kSizeClasses * 27, kSizeClasses* kEnergyClasses * 4,
                                                                4 * kLevels * 8 * 2};

bool cut_short(const RangeDecoder& coder) {
  return coder.exhausted();
}
template <class Coder>
bool cut_short(const Coder&) {
  return false;
}

// A rectangle of coefficients of one band that are all insignificant so far.
struct Set {
  std::uint32_t row, column, rows, columns;
  std::uint32_t band;

  bool single() const { return rows == 1 && columns == 1; }
};

bool any_in_row(const CoefficientPlanes& planes, const Set& set, std::uint32_t row) {
  const auto begin = planes.support.begin() + std::size_t{row} * planes.columns + set.column;
  return std::find(begin, begin + set.columns, 1) != begin + set.columns;
}

bool any_in_column(const CoefficientPlanes& planes, const Set& set, std::uint32_t column) {
  for (std::uint32_t row = set.row; row < set.row + set.rows; ++row)
    if (planes.support[std::size_t{row} * planes.columns + column]) return true;
  return false;
}

// The smallest rectangle in `set` with all its supported coefficients; nothing where there are none.
std::optional<Set> shrink(const CoefficientPlanes& planes, Set set) {
  while (set.rows > 0 && !any_in_row(planes, set, set.row)) ++set.row, --set.rows;
  if (set.rows == 0) return std::nullopt;
  while (!any_in_row(planes, set, set.row + set.rows - 1)) --set.rows;
  while (!any_in_column(planes, set, set.column)) ++set.column, --set.columns;
  while (!any_in_column(planes, set, set.column + set.columns - 1)) --set.columns;
  return set;
}

std::array<Set, 2> halves_of(const Set& set) {
  std::array<Set, 2> parts = {set, set};
  if (set.columns >= set.rows) {
    parts[0].columns = (set.columns + 1) / 2;
    parts[1].column += parts[0].columns;
    parts[1].columns -= parts[0].columns;
  } else {
    parts[0].rows = (set.rows + 1) / 2;
    parts[1].row += parts[0].rows;
    parts[1].rows -= parts[0].rows;
  }
  return parts;
}

// Plane of the highest bit of each set's largest magnitude; -1 for none.
int top_plane_of(const CoefficientPlanes& planes, const Set& set) {
  std::uint32_t bits = 0;
  for (std::uint32_t row = set.row; row < set.row + set.rows; ++row) {
    const std::uint32_t* magnitudes = planes.magnitudes.data() + std::size_t{row} * planes.columns;
    for (std::uint32_t column = set.column; column < set.column + set.columns; ++column) bits |= magnitudes[column];
  }
  return std::bit_width(bits) - 1;
}

}  // namespace

CoefficientPlanes::CoefficientPlanes(std::uint32_t columns_, std::uint32_t rows_, std::vector<Band> bands_,
                                     std::vector<std::uint8_t> support_)
    : columns(columns_), rows(rows_), bands(std::move(bands_)), support(std::move(support_)), halves(support.size()) {}

SetSplittingCoding::SetSplittingCoding() : significance_(kSignificanceContexts, kSizeClasses), refinement_(12) {}

// One map being coded.
template <class Coder>
class SetSplittingCoding::Run {
 public:
  Run(SetSplittingCoding& models, Coder& coder, CoefficientPlanes& planes, std::uint32_t top_plane,
      const Observer* observer)
      : models_(models),
        coder_(coder),
        planes_(planes),
        observer_(observer),
        top_plane_(top_plane),
        found_at_(planes.support.size()) {
    for (std::uint32_t band = 0; band < planes.bands.size(); ++band) {
      const Band& b = planes.bands[band];
      if (const auto set = shrink(planes, {b.row, b.column, b.rows, b.columns, band})) keep(*set, 0);
    }
  }

  void significance_pass(std::uint32_t plane) {
    plane_ = plane;
    known_before_ = significant_.size();
    // The smallest sets first. A pass puts what it splits off behind what it has done.
    for (std::size_t depth = waiting_.size(); depth-- > 0;) {
      std::vector<Waiting> sets;
      sets.swap(waiting_[depth]);
      for (const Waiting& waiting : sets) {
        if (cut_short(coder_)) return;
        if (is_significant(waiting))
          split_or_find(waiting.set, depth);
        else
          waiting_[depth].push_back(waiting);
      }
    }
  }

  void refinement_pass(std::uint32_t plane) {
    plane_ = plane;
    for (std::size_t i = 0; i < known_before_; ++i) {
      const std::uint32_t index = significant_[i];
      const std::uint32_t age = std::min(found_at_[index] - 1U - plane, 3U);
      const std::uint32_t context = (age - 1) * 4 + std::min(energy_at(index), 3U);
      const bool given = !planes_.magnitudes.empty() && (planes_.magnitudes[index] >> plane & 1) != 0;
      const bool bit = models_.refinement_.code(coder_, given, context);
      const std::int32_t step = 1 << plane;
      change(index, planes_.halves[index] + ((planes_.halves[index] > 0) == bit ? step : -step));
    }
  }

 private:
  struct Waiting {
    Set set;
    int top_plane;  // the writer's; -1 for the reader
  };

  void keep(const Set& set, std::size_t depth) {
    if (waiting_.size() <= depth) waiting_.resize(depth + 1);
    waiting_[depth].push_back({set, planes_.magnitudes.empty() ? -1 : top_plane_of(planes_, set)});
  }

  void split_or_find(const Set& set, std::size_t depth) {
    if (set.single()) return find(set);
    const std::array<Set, 2> parts = halves_of(set);
    const std::optional<Set> first = shrink(planes_, parts[0]);
    const std::optional<Set> second = shrink(planes_, parts[1]);
    // One of the two is significant, for the whole is: where the first is not, the second need not be asked.
    bool ask_second = true;
    if (first) {
      const Waiting waiting{*first, planes_.magnitudes.empty() ? -1 : top_plane_of(planes_, *first)};
      if (!second || is_significant(waiting)) {
        split_or_find(*first, depth + 1);
      } else {
        insert(waiting, depth + 1);
        ask_second = false;
      }
    } else {
      ask_second = false;
    }
    if (!second) return;
    const Waiting waiting{*second, planes_.magnitudes.empty() ? -1 : top_plane_of(planes_, *second)};
    if (!ask_second || is_significant(waiting))
      split_or_find(*second, depth + 1);
    else
      insert(waiting, depth + 1);
  }

  void insert(const Waiting& waiting, std::size_t depth) {
    if (waiting_.size() <= depth) waiting_.resize(depth + 1);
    waiting_[depth].push_back(waiting);
  }

  void find(const Set& set) {
    const auto index = static_cast<std::uint32_t>(std::size_t{set.row} * planes_.columns + set.column);
    const bool negative = coder_.code(!planes_.negative.empty() && planes_.negative[index], kProbabilityOne / 2);
    found_at_[index] = static_cast<std::uint8_t>(plane_ + 1);
    significant_.push_back(index);
    const std::int32_t halves = 3 << plane_;
    change(index, negative ? -halves : halves);
  }

  void change(std::uint32_t index, std::int32_t after) {
    if (observer_) observer_->changed(index, planes_.halves[index], after);
    planes_.halves[index] = after;
  }

  bool is_significant(const Waiting& waiting) {
    const Set& set = waiting.set;
    const Band& band = planes_.bands[set.band];
    const std::uint32_t size = std::min<std::uint32_t>(std::bit_width(set.rows * set.columns) - 1, kSizeClasses - 1);
    const Surroundings around = surroundings_of(set, band);
    const std::uint32_t since_top = std::min(top_plane_ - plane_, 7U);
    const std::array<std::uint32_t, 3> contexts = {
        (size * 3 + around.beside) * 9 + around.above_below * 3 + around.corners,
        (size * kEnergyClasses + around.energy) * 4 + parent_class(set, band),
        ((band.kind * kLevels + std::min(band.level, kLevels - 1)) * 8 + since_top) * 2 + (set.single() ? 1 : 0)};
    return models_.significance_.code(coder_, waiting.top_plane == static_cast<int>(plane_), contexts, size);
  }

  // How much above the plane in hand the coefficient is known to lie: 0 not at all, 1 from this plane, ... 3.
  std::uint32_t height_at(std::size_t index) const {
    return found_at_[index] == 0 ? 0 : std::min(found_at_[index] - plane_, 3U);
  }

  struct Surroundings {
    std::uint32_t beside, above_below, corners;  // how many are significant, at most 2
    std::uint32_t energy;                        // below kEnergyClasses
  };

  // Looks at the eight coefficients around the set: at its corners and beside the middles of its sides.
  Surroundings surroundings_of(const Set& set, const Band& band) const {
    const bool left = set.column > band.column, right = set.column + set.columns < band.column + band.columns;
    const bool up = set.row > band.row, down = set.row + set.rows < band.row + band.rows;
    const std::size_t middle_row = set.row + set.rows / 2, middle_column = set.column + set.columns / 2;
    const auto height = [&](bool inside, std::size_t row, std::size_t column) {
      return inside ? height_at(row * planes_.columns + column) : 0U;
    };
    const std::array<std::uint32_t, 8> heights = {
        height(left, middle_row, set.column - std::size_t{1}),
        height(right, middle_row, std::size_t{set.column} + set.columns),
        height(up, set.row - std::size_t{1}, middle_column),
        height(down, std::size_t{set.row} + set.rows, middle_column),
        height(left && up, set.row - std::size_t{1}, set.column - std::size_t{1}),
        height(right && up, set.row - std::size_t{1}, std::size_t{set.column} + set.columns),
        height(left && down, std::size_t{set.row} + set.rows, set.column - std::size_t{1}),
        height(right && down, std::size_t{set.row} + set.rows, std::size_t{set.column} + set.columns)};
    const auto count = [&](int from, int to) {
      std::uint32_t found = 0;
      for (int i = from; i < to; ++i) found += heights[i] > 0;
      return std::min(found, 2U);
    };
    const std::uint32_t weighted =
        2 * (heights[0] + heights[1] + heights[2] + heights[3]) + heights[4] + heights[5] + heights[6] + heights[7];
    return {count(0, 2), count(2, 4), count(4, 8), std::min((weighted + 1) / 2, kEnergyClasses - 1)};
  }

  std::uint32_t energy_at(std::uint32_t index) const {
    const std::uint32_t row = index / planes_.columns, column = index % planes_.columns;
    std::uint32_t sum = 0;
    if (column > 0) sum += found_at_[index - 1] > 0;
    if (column + 1 < planes_.columns) sum += found_at_[index + 1] > 0;
    if (row > 0) sum += found_at_[index - planes_.columns] > 0;
    if (row + 1 < planes_.rows) sum += found_at_[index + planes_.columns] > 0;
    return sum;
  }

  // The height of the coefficient of the next coarser level in the same place, where there is one.
  std::uint32_t parent_class(const Set& set, const Band& band) const {
    if (band.kind == 0 || set.band < 4) return 0;
    const Band& parent = planes_.bands[set.band - 3];
    if (parent.kind != band.kind) return 0;
    const std::uint32_t row = std::min((set.row + set.rows / 2 - band.row) / 2, parent.rows - 1);
    const std::uint32_t column = std::min((set.column + set.columns / 2 - band.column) / 2, parent.columns - 1);
    return height_at(std::size_t{parent.row + row} * planes_.columns + parent.column + column);
  }

  SetSplittingCoding& models_;
  Coder& coder_;
  CoefficientPlanes& planes_;
  const Observer* observer_;
  const std::uint32_t top_plane_;
  std::uint32_t plane_ = 0;
  std::vector<std::vector<Waiting>> waiting_;  // insignificant sets, by the number of splits that led to them
  std::vector<std::uint32_t> significant_;     // indices of coefficients, in the order in which they were found
  std::size_t known_before_ = 0;               // of these, found before the plane in hand
  std::vector<std::uint8_t> found_at_;         // 1 + the plane at which a coefficient was found; 0 for not yet
};

template <class Coder>
void SetSplittingCoding::code(Coder& coder, CoefficientPlanes& planes, std::uint32_t top_plane, std::uint32_t passes,
                              const Observer* observer) {
  assert(top_plane < kBitPlanes && passes <= 2 * (top_plane + 1));
  Run<Coder> run(*this, coder, planes, top_plane, observer);
  for (std::uint32_t pass = 0; pass < passes && !cut_short(coder); ++pass) {
    if (pass % 2 == 0)
      run.significance_pass(top_plane - pass / 2);
    else
      run.refinement_pass(top_plane - pass / 2);
    if (observer) observer->pass_done();
  }
}

template void SetSplittingCoding::code(RangeEncoder&, CoefficientPlanes&, std::uint32_t, std::uint32_t,
                                       const Observer*);
template void SetSplittingCoding::code(RangeDecoder&, CoefficientPlanes&, std::uint32_t, std::uint32_t,
                                       const Observer*);
template void SetSplittingCoding::code(BitCounter&, CoefficientPlanes&, std::uint32_t, std::uint32_t, const Observer*);

}  // namespace emap
