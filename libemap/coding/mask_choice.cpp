#include "libemap/coding/mask_choice.h"

#include <algorithm>
#include <cmath>

#include "libemap/elevation/cube_hash.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/elevation/map_grid.h"
#include "libemap/elevation/seam_smoothing.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using Eigen::Vector3d;

// Bits of samples, each in the context of eleven before it: three to its left, five above, three above these. Much like
// what MaskCoding learns.
class MaskCosts {
 public:
  void count(std::size_t context, std::uint8_t sample) { counts_[2 * context + sample] += 1; }
  void finish() {
    constexpr double kUnseen = 0.4;
    for (std::size_t i = 0; i < counts_.size(); i += 2) {
      const double zeros = counts_[i] + kUnseen, ones = counts_[i + 1] + kUnseen;
      counts_[i] = -std::log2(zeros / (zeros + ones));
      counts_[i + 1] = -std::log2(ones / (zeros + ones));
    }
  }
  double bits(std::size_t context, std::uint8_t sample) const { return counts_[2 * context + sample]; }

 private:
  std::vector<double> counts_ = std::vector<double>(std::size_t{2} << 11);  // then bits
};

// A mask in the making, with room for contexts on all sides.
class ChosenMask {
 public:
  explicit ChosenMask(const ElevationPatch& patch)
      : stride_(patch.columns + 2 * kMargin), samples_(stride_ * (patch.rows + 2 * kMargin)) {
    for (std::uint32_t row = 0; row < patch.rows; ++row)
      std::copy_n(patch.mask.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * patch.columns), patch.columns,
                  &at(row, 0));
  }

  std::uint8_t& at(std::uint32_t row, std::uint32_t column) {
    return samples_[(row + kMargin) * stride_ + column + kMargin];
  }

  void count(MaskCosts& costs) const {
    const std::size_t end = samples_.size() - kMargin * (stride_ + 1);
    for (std::size_t place = kMargin * (stride_ + 1); place < end; ++place)
      costs.count(context(place), samples_[place]);
  }

  // Of a sample and all those in whose contexts it is.
  double bits_around(std::uint32_t row, std::uint32_t column, const MaskCosts& costs) const {
    const std::size_t place = (row + kMargin) * stride_ + column + kMargin;
    double bits = 0;
    const auto add = [&](std::size_t first, std::size_t count) {
      for (std::size_t i = first; i < first + count; ++i) bits += costs.bits(context(i), samples_[i]);
    };
    add(place, 4);
    add(place + stride_ - 2, 5);
    add(place + 2 * stride_ - 1, 3);
    return bits;
  }

 private:
  static constexpr std::size_t kMargin = 4;

  std::size_t context(std::size_t place) const {
    std::size_t bits = 0;
    const auto append = [&](std::size_t first, std::size_t count) {
      for (std::size_t i = first; i < first + count; ++i) bits = bits << 1 | samples_[i];
    };
    append(place - 3, 3);
    append(place - stride_ - 2, 5);
    append(place - 2 * stride_ - 1, 3);
    return bits;
  }

  std::size_t stride_;
  std::vector<std::uint8_t> samples_;
};

class MaskChoice {
 public:
  MaskChoice(const ElevationMaps& given, std::vector<std::vector<FreeSample>> free_of_patch,
             std::vector<Vector3d> seams, const MaskChoiceOptions& options)
      : given_(given), seams_(std::move(seams)), options_(options) {
    for (const ElevationPatch& patch : given.patches) masks_.emplace_back(patch);
    for (std::uint32_t patch = 0; patch < free_of_patch.size(); ++patch)
      for (const FreeSample& sample : free_of_patch[patch])
        items_.push_back({sample, patch, &masks_[patch].at(sample.row, sample.column)});
    find_neighbours();
    lose_small_patches();
  }

  // Every sample in turn as it costs least, until none changes; costs are those of the masks as they have become.
  void run() {
    constexpr int kSweeps = 3;
    for (int round = 0; round < options_.rounds; ++round) {
      MaskCosts costs;
      for (const ChosenMask& mask : masks_) mask.count(costs);
      costs.finish();
      bool any = false;
      for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (std::uint32_t i = 0; i < items_.size(); ++i) any |= improve(i, costs);
      if (!any) return;
    }
  }

  ElevationMaps maps() const {
    ElevationMaps maps = given_;
    for (const Item& item : items_) {
      ElevationPatch& patch = maps.patches[item.patch];
      const std::size_t place = std::size_t{item.free.row} * patch.columns + item.free.column;
      patch.mask[place] = *item.sample;
      patch.elevation[place] = *item.sample ? item.free.elevation : 0;
    }
    for (const LostPatch& lost : lost_) {
      ElevationPatch& patch = maps.patches[lost.patch];
      std::fill(patch.mask.begin(), patch.mask.end(), std::uint8_t{0});
      std::fill(patch.elevation.begin(), patch.elevation.end(), 0);
    }
    return maps;
  }

  // Where gap filling leaves holes, everything around is as it was given, and small patches are back that are missed. A
  // second round finds no more of them: those that are left were there before.
  void repair() {
    const TriangleTree surface(closed_mesh(maps()).mesh);
    std::erase_if(lost_, [&](const LostPatch& lost) {
      double squares = 0;
      for (const Vector3d& position : lost.positions) squares += square_of_distance(surface, position);
      return options_.freedom.bits_of_bend * squares > options_.bits_of_patch;
    });
    restore_around(holes(surface));
  }

 private:
  struct Item {
    FreeSample free;
    std::uint32_t patch;
    std::uint8_t* sample;
  };
  struct Neighbour {
    std::uint32_t item;
    bool is_rival;
  };
  struct LostPatch {
    std::uint32_t patch;
    std::vector<Vector3d> positions;
  };

  // Of each item, those of other patches within reach.
  void find_neighbours() {
    CubeHash places(given_.spacing);
    for (std::uint32_t i = 0; i < items_.size(); ++i) places.add(i, items_[i].free.position, items_[i].free.position);
    first_neighbour_.push_back(0);
    const double reach = options_.gap_reach * given_.spacing;
    for (const Item& item : items_) {
      const Vector3d& position = item.free.position;
      places.visit(position.array() - reach, position.array() + reach, [&](std::uint32_t other) {
        if (items_[other].patch == item.patch) return;
        const double distance = (items_[other].free.position - position).norm() / given_.spacing;
        if (distance < options_.gap_reach) neighbours_.push_back({other, distance < options_.rival_reach});
      });
      first_neighbour_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
    }
  }

  std::span<const Neighbour> neighbours(std::uint32_t item) const {
    return std::span(neighbours_).subspan(first_neighbour_[item], first_neighbour_[item + 1] - first_neighbour_[item]);
  }

  void lose_small_patches() {
    for (std::uint32_t i = 0; i < given_.patches.size(); ++i) {
      const ElevationPatch& patch = given_.patches[i];
      if (std::count(patch.mask.begin(), patch.mask.end(), 1) > options_.most_samples_lost) continue;
      LostPatch lost{i, {}};
      for (std::uint32_t row = 0; row < patch.rows; ++row)
        for (std::uint32_t column = 0; column < patch.columns; ++column)
          if (patch.mask[std::size_t{row} * patch.columns + column])
            lost.positions.push_back(sample_position(patch, given_.spacing, row, column));
      lost_.push_back(std::move(lost));
    }
  }

  bool improve(std::uint32_t i, const MaskCosts& costs) {
    const Item& item = items_[i];
    const auto bits = [&] {
      return masks_[item.patch].bits_around(item.free.row, item.free.column, costs) +
             (*item.sample ? item.free.bits_if_present : item.free.bits_if_absent) + bits_of_neighbourhood(i);
    };
    const double before = bits();
    *item.sample ^= 1;
    if (bits() < before - 1e-6) return true;
    *item.sample ^= 1;
    return false;
  }

  // Of what lies too near to this item, and of gaps at it and around.
  double bits_of_neighbourhood(std::uint32_t i) const {
    double sum = bits_of_gap(i);
    for (const Neighbour& neighbour : neighbours(i)) {
      if (neighbour.is_rival && *items_[i].sample && *items_[neighbour.item].sample) sum += options_.bits_of_rival;
      sum += bits_of_gap(neighbour.item);
    }
    return sum;
  }

  double bits_of_gap(std::uint32_t i) const {
    if (*items_[i].sample || neighbours(i).empty()) return 0;
    for (const Neighbour& neighbour : neighbours(i))
      if (*items_[neighbour.item].sample) return 0;
    return options_.bits_of_gap;
  }

  bool is_given(const Item& item) const {
    const ElevationPatch& patch = given_.patches[item.patch];
    return patch.mask[std::size_t{item.free.row} * patch.columns + item.free.column];
  }

  double square_of_distance(const TriangleTree& surface, const Vector3d& position) const {
    return surface.closest(position).distance_squared / (given_.spacing * given_.spacing);
  }

  // Places on seams and of samples that were given, beside which the surface passes.
  std::vector<Vector3d> holes(const TriangleTree& surface) const {
    std::vector<Vector3d> places = seams_;
    for (const Item& item : items_)
      if (is_given(item)) places.push_back(item.free.position);
    std::vector<std::uint8_t> is_hole(places.size());
    thin::parallel_ranges(places.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        is_hole[i] = square_of_distance(surface, places[i]) > options_.hole * options_.hole;
    });
    std::vector<Vector3d> found;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (is_hole[i]) found.push_back(places[i]);
    return found;
  }

  void restore_around(const std::vector<Vector3d>& holes) {
    const double around = 2.5 * given_.spacing;
    CubeHash places(around);
    for (std::uint32_t i = 0; i < holes.size(); ++i) places.add(i, holes[i], holes[i]);
    for (const Item& item : items_) {
      const Vector3d& position = item.free.position;
      places.visit(position.array() - around, position.array() + around, [&](std::uint32_t hole) {
        if ((holes[hole] - position).norm() < around) *item.sample = is_given(item) ? 1 : 0;
      });
    }
  }

  const ElevationMaps& given_;
  std::vector<Vector3d> seams_;
  const MaskChoiceOptions& options_;
  std::vector<ChosenMask> masks_;
  std::vector<Item> items_;  // patch by patch
  std::vector<std::uint32_t> first_neighbour_;
  std::vector<Neighbour> neighbours_;
  std::vector<LostPatch> lost_;
};

}  // namespace

void choose_cheaper_masks(const Mesh& mesh, const Partition& partition, const TriangleTree& tree, ElevationMaps& maps,
                          const MaskChoiceOptions& options) {
  const std::vector<std::vector<std::uint32_t>> triangles = partition.elements_of_patches();
  std::vector<std::vector<FreeSample>> free_of_patch(maps.patches.size());
  thin::parallel_ranges(maps.patches.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ElevationPatch& patch = maps.patches[i];
      if (std::count(patch.mask.begin(), patch.mask.end(), 1) < options.fewest_samples) continue;
      free_of_patch[i] = free_samples(mesh, triangles[i], tree, patch, maps.spacing, options.freedom);
    }
  });
  MaskChoice choice(maps, std::move(free_of_patch), vertices_on_seams(mesh, partition.patch_of), options);
  choice.run();
  choice.repair();
  ElevationMaps chosen = choice.maps();
  for (ElevationPatch& patch : chosen.patches) crop(patch);
  maps = std::move(chosen);
}

}  // namespace emap
