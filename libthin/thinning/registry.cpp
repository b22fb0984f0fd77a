#include <algorithm>
#include <array>

#include "libthin/thinning/analysis_thinning.h"
#include "libthin/thinning/box.h"
#include "libthin/thinning/eea.h"
#include "libthin/thinning/gaussian.h"
#include "libthin/thinning/octree.h"
#include "libthin/thinning/poisson_disk.h"
#include "libthin/thinning/stepwise.h"
#include "libthin/thinning/superob.h"
#include "libthin/thinning/thinning_method.h"
#include "libthin/thinning/top_down_clustering.h"

namespace thin {
namespace {

template <class Method>
std::unique_ptr<ThinningMethod> make() {
  return std::make_unique<Method>();
}

template <Eea::Direction Way, Eea::EvaluationPoints Points>
std::unique_ptr<ThinningMethod> make_eea() {
  return std::make_unique<Eea>(Way, Points);
}

}  // namespace

std::span<const MethodEntry> thinning_methods() {
  using Way = Eea::Direction;
  using Points = Eea::EvaluationPoints;
  static const std::array entries = {
      MethodEntry{"analysis", "insertion of what brings the analysis nearest to that from all, then exchange",
                  "sequential optimal interpolation; docs/methods.md", make<AnalysisThinning>},
      MethodEntry{"box", "one observation per equal-area box or GME cell, the nearest to its centre",
                  "Purser et al. 2000; box thinning as centres use it", make<Box>},
      MethodEntry{"eea", "greedy removal of what the Gaussian estimate at the observations misses least",
                  "estimation error analysis: thesis 6.3.2, eq. 6.10-6.13",
                  make_eea<Way::removal, Points::observations>},
      MethodEntry{"gaussian", "one observation per cell in place and time, the nearest to its centre",
                  "the filter Gaussian Thinning of JEDI's UFO", make<Gaussian>},
      MethodEntry{"grid_eea", "greedy removal of what the Gaussian estimate on the GME grid misses least",
                  "estimation error analysis on a regular grid: thesis 6.3.3, eq. 6.10-6.14",
                  make_eea<Way::removal, Points::grid>},
      MethodEntry{
          "grid_top_down_eea", "greedy insertion of what brings the estimate on the GME grid nearest to the full",
          "top-down estimation error analysis on a regular grid: thesis 6.3.4", make_eea<Way::insertion, Points::grid>},
      MethodEntry{"octree", "one observation per octree cell, split while a test says that its values vary",
                  "Ramachandran et al. 2005; thesis 6.2", make<Octree>},
      MethodEntry{"poisson_disk", "in random order, all that are not too near to one retained before",
                  "the filter Poisson Disk Thinning of JEDI's UFO", make<PoissonDisk>},
      MethodEntry{"stepwise", "every s-th field of view of every s-th scan line", "the reference of thesis 6.5",
                  make<Stepwise>},
      MethodEntry{"superob", "all observations of a box become one, their mean: not a subset, CF netCDF alone",
                  "superobbing as centres use it; Lorenc 1981, Purser et al. 2000", make<Superob>},
      MethodEntry{"top_down_clustering", "one observation per cluster of near places and like values",
                  "thesis 6.3.1, eq. 6.8, 6.9; Gersho and Gray 1992", make<TopDownClustering>},
      MethodEntry{"top_down_eea",
                  "greedy insertion of what brings the estimate at the observations nearest to the full",
                  "top-down estimation error analysis: thesis 6.3.4", make_eea<Way::insertion, Points::observations>},
  };
  return entries;
}

const MethodEntry* find_thinning_method(const std::string& name) {
  const auto entries = thinning_methods();
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const MethodEntry& e) { return e.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

}  // namespace thin
