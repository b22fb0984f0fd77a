#pragma once

// The simplest global model that makes fronts and flow-dependent errors: scalars carried by a given wind, for cycling
// (the stand-in for the thesis's GME). Solid-body rotation and drifting vortices stir fields that relax towards a
// pattern of their own. Nothing feeds back on the wind: errors come from the wind's errors, are carried and sheared,
// and grow where gradients are, not by themselves.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

// Latitudes and longitudes at equal steps, rows half a step away from the poles, from south to north.
class GlobalGrid {
 public:
  // REQUIRES: 180 / step_deg is a whole number of rows
  explicit GlobalGrid(double step_deg);

  std::size_t size() const { return directions_.size(); }
  const std::vector<Vector3>& directions() const { return directions_; }  // unit vectors, row by row
  std::vector<Vector3> positions_km() const;                              // on the ellipsoid
  double latitude_deg(std::size_t point) const;
  double area(std::size_t point) const;  // share of the sphere

  // The four by four points around a direction, with the weights of cubic Lagrange interpolation; across a pole the
  // rows go on at the opposite longitude. The weights' sum is 1.
  struct Stencil {
    std::uint32_t points[16];
    double weights[16];
  };
  Stencil stencil(const Vector3& direction) const;

  // A field at these places, by that interpolation.
  std::vector<double> sample(std::span<const double> field, std::span<const Vector3> positions_km) const;

 private:
  std::size_t rows_, columns_;
  double step_rad_;
  std::vector<Vector3> directions_;
};

// Angular velocity of the air: solid rotation about the poles, and vortices that turn about centres of their own, which
// drift eastwards; each turns rigidly about its centre at a rate that falls as exp(-d²/2R²), so that the wind is free
// of divergence.
class Wind {
 public:
  struct Vortex {
    double latitude_deg, longitude_deg;  // at time 0
    double drift_deg_per_h;
    double radius;          // in Earth radii
    double rate_rad_per_h;  // at the centre; positive: anticlockwise
    // Of a wind with errors: displaced in longitude and misjudged in strength, to and fro.
    double displacement_deg = 0, strength_error = 0, error_period_h = 1, error_phase_rad = 0;
  };
  double solid_rad_per_h = 0;
  std::vector<Vortex> vortices;

  // Middle latitudes' weather of that seed: peak winds of about 20 m/s around centres, rotation in 12 days.
  static Wind random(std::uint64_t seed, int vortices = 24);
  // The same, with errors of that size: strengths by about so much, displacements by so much of a radius, and the
  // rotation by a tenth of it; each changes over three to six days.
  Wind with_errors(double size, std::uint64_t seed) const;

  // At one time.
  struct Now {
    struct Turn {
      Vector3 centre;
      double radius, rate_rad_per_h;
    };
    double solid_rad_per_h;
    std::vector<Turn> turns;

    Vector3 velocity(const Vector3& direction) const;  // tangential, Earth radii per hour
  };
  Now at(double time_h) const;
};

// The time derivative of q along the flow: (equilibrium - q) / relaxation time.
struct Relaxation {
  std::vector<double> equilibrium;  // on the grid, for each field one after the other
  double time_h = 240;              // 0: none
};

// Carries all fields (each grid.size() long) from time_h to time_h + hours: semi-Lagrangian, departure points by the
// midpoint rule, cubic interpolation. On all cores; the same bits for any number of them.
void advance(const GlobalGrid& grid, const Wind& wind, const Relaxation& relaxation,
             std::vector<std::vector<double>>& fields, double time_h, double hours);

}  // namespace thin
