#pragma once

// Where land is, and how near its shore, from the edges of all land (formats/shoreline_file.h reads them).
//
// A place is on land where a line from it to the north pole crosses an odd number of edges: no polygon need be put
// together, the date line and the south pole are places like others. Edges are sorted into strips of longitude, and
// pieces of them into a kd-tree: building takes a tenth of a second for 50,000 edges, a question some microseconds.

#include <span>
#include <vector>

#include "libthin/foundation/kd_tree.h"
#include "libthin/observations/observation_set.h"
#include "libthin/observations/shore_edge.h"

namespace thin {

class Shoreline {
 public:
  // REQUIRES: finite coordinates; latitudes in -90..90 for edges that are shores
  explicit Shoreline(std::span<const ShoreEdge> edges);

  // On an edge itself either answer may come.
  bool is_land(double latitude_deg, double longitude_deg) const;

  // Whether a shore is at most this far, in a straight line. May be called by many threads.
  bool is_near(const Vector3& position_km, double distance_km) const;

 private:
  // 0 <= west_deg < east_deg <= 360
  struct Span {
    double west_deg, east_deg;
    double west_latitude_deg, east_latitude_deg;
  };
  struct Piece {
    Vector3 from_km, to_km;
  };

  void add_spans(const ShoreEdge& edge, std::vector<Span>& spans) const;
  void add_pieces(const ShoreEdge& edge);
  void sort_into_strips(const std::vector<Span>& spans);

  std::vector<std::size_t> strip_begin_;  // of strip s: spans_[strip_begin_[s]] to [strip_begin_[s + 1])
  std::vector<Span> spans_;
  std::vector<Piece> pieces_;
  KdTree middles_;  // of the pieces
};

}  // namespace thin
