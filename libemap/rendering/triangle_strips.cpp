#include "libemap/rendering/triangle_strips.h"

#include <algorithm>

#include "libemap/elevation/grid_triangles.h"

namespace emap {
namespace {

constexpr std::uint32_t kBandColumns = 64;

class StripWriter {
 public:
  StripWriter(const ElevationPatch& map, double spacing, double steepest_slope,
              const std::function<std::uint16_t(std::uint32_t, std::uint32_t)>& index_of,
              std::vector<std::uint16_t>& strip)
      : map_(map),
        spacing_(spacing),
        steepest_slope_(steepest_slope),
        index_of_(index_of),
        strip_(strip),
        begin_(strip.size()) {}

  void add_row(std::uint32_t row, std::uint32_t first_column, std::uint32_t last_column) {
    running_ = Running::none;
    for (std::uint32_t column = first_column; column < last_column; ++column) add_square(row, column);
  }

 private:
  // What the strip's last two vertices are: a column's upper and lower sample in either order, or something else.
  enum class Running { none, top_bottom, bottom_top };

  void add_square(std::uint32_t row, std::uint32_t column) {
    const std::size_t a = std::size_t{row} * map_.columns + column, b = a + 1, d = a + map_.columns, c = d + 1;
    if (map_.mask[a] && map_.mask[b] && map_.mask[c] && map_.mask[d]) {
      const bool is_falling = falls(map_, a);
      const GridTriangle first = is_falling ? GridTriangle{a, b, d} : GridTriangle{a, b, c};
      const GridTriangle second = is_falling ? GridTriangle{b, c, d} : GridTriangle{a, c, d};
      if (is_wanted(first) && is_wanted(second)) return add_both(a, is_falling);
      running_ = Running::none;
      if (is_wanted(first)) add_alone(first);
      if (is_wanted(second)) add_alone(second);
      return;
    }
    running_ = Running::none;
    for (const GridTriangle& triangle :
         {GridTriangle{b, c, d}, GridTriangle{a, c, d}, GridTriangle{a, b, d}, GridTriangle{a, b, c}})
      if (map_.mask[triangle[0]] && map_.mask[triangle[1]] && map_.mask[triangle[2]] && is_wanted(triangle))
        add_alone(triangle);
  }

  bool is_wanted(const GridTriangle& triangle) const { return slope_of(map_, triangle, spacing_) <= steepest_slope_; }

  // Upper, lower, upper, lower has the diagonal that falls from the upper right; lower, upper, lower, upper the other.
  void add_both(std::size_t a, bool is_falling) {
    const std::size_t top = a, bottom = a + map_.columns;
    const Running wanted = is_falling ? Running::top_bottom : Running::bottom_top;
    if (running_ == Running::none) begin_piece(is_falling ? top : bottom);
    if (running_ != wanted) push(is_falling ? bottom : top);
    push(is_falling ? top + 1 : bottom + 1);
    push(is_falling ? bottom + 1 : top + 1);
    running_ = wanted;
  }

  void add_alone(const GridTriangle& triangle) {
    begin_piece(triangle[0]);
    push(triangle[1]);
    push(triangle[2]);
  }

  void begin_piece(std::size_t place) {
    if (strip_.size() > begin_) {
      strip_.push_back(strip_.back());
      push(place);
    }
    push(place);
  }

  void push(std::size_t place) {
    strip_.push_back(
        index_of_(static_cast<std::uint32_t>(place / map_.columns), static_cast<std::uint32_t>(place % map_.columns)));
  }

  const ElevationPatch& map_;
  double spacing_, steepest_slope_;
  const std::function<std::uint16_t(std::uint32_t, std::uint32_t)>& index_of_;
  std::vector<std::uint16_t>& strip_;
  std::size_t begin_;
  Running running_ = Running::none;
};

}  // namespace

void append_strip(const ElevationPatch& map, double spacing, double steepest_slope, const SquareRange& squares,
                  const std::function<std::uint16_t(std::uint32_t, std::uint32_t)>& index_of,
                  std::vector<std::uint16_t>& strip) {
  StripWriter writer(map, spacing, steepest_slope, index_of, strip);
  for (std::uint32_t column = squares.first_column; column < squares.last_column; column += kBandColumns)
    for (std::uint32_t row = squares.first_row; row < squares.last_row; ++row)
      writer.add_row(row, column, std::min(column + kBandColumns, squares.last_column));
}

}  // namespace emap
