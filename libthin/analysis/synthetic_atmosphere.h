#pragma once

// A made-up atmosphere as AMSU-A would see it, with the truth at hand: for trials of thinning where the answer is
// known.
//
// Its anomaly, the departure from climatology that thinning is about, has
// - waves of 200 to 4000 km, whose amplitude falls with their length (variance as wave number^-3, the synoptic range of
//   Nastrom and Gage 1985), different by height, drifting eastward;
// - flat regions, about four tenths of the Earth, where the waves vanish;
// - curved fronts in middle latitudes, across which channels jump within about 100 km.
//
// Everything is a function of seed, place and time alone, noise included: the order of calls and the number of threads
// change nothing. Less than 10 microseconds per field of view.

#include <cstdint>
#include <vector>

#include "libthin/analysis/synthetic_climatology.h"
#include "libthin/observations/observation_set.h"
#include "libthin/observations/scan_geometry.h"

namespace thin {

// Names one measurement, for its noise.
struct MeasurementKey {
  std::int32_t platform = 0;
  std::int64_t line_begin_ms = 0;
  std::int32_t field_of_view = 1;
};

struct MeasurementOptions {
  bool noise = true;
  // Without: every channel has the same mean, kFlatMeanK, everywhere and no limb effect. Then a channel minus its mean
  // is the anomaly, as an innovation is what remains when the first guess is taken off.
  bool climatology = true;
};
constexpr double kFlatMeanK = 250;

class SyntheticAtmosphere {
 public:
  explicit SyntheticAtmosphere(std::uint64_t seed);

  // Departure from climatology, without noise and limb effect, K. The place is on the ellipsoid.
  ChannelValues anomaly_k(const Vector3& position_km, std::int64_t time_ms) const;

  // climatology_k + anomaly_k.
  ChannelValues truth_k(double latitude_deg, double longitude_deg, std::int64_t time_ms) const;

  // What the instrument would report, before BUFR rounds it, K.
  ChannelValues measurement_k(const FieldOfView& view, const MeasurementKey& key,
                              const MeasurementOptions& options) const;

  // White: normal, independent, of deviation kNoiseDeviationK.
  ChannelValues noise_k(const MeasurementKey& key) const;

  // Whether nothing but noise is to be seen here: no waves, and of every front less than 1 %.
  bool is_flat(const Vector3& position_km, std::int64_t time_ms) const;

 private:
  struct Wave {
    Vector3 wave_vector_per_km;
    double phase_rad;
    double rate_rad_per_s;
    double amplitude;
  };
  using Waves = std::vector<Wave>;  // of variance 1 in all

  struct Front {
    Vector3 centre, along, across;  // orthonormal
    double half_width_km;           // of the jump, as tanh(distance / half_width)
    double bend_km;                 // amplitude of its curve
    double strength;                // -1..1
  };
  struct FrontPlace {
    double across_km;
    double strength;  // fades away from the line and beyond its ends
  };

  static Waves make_waves(std::uint64_t& random, int count, double shortest_km, double longest_km);
  static Front make_front(std::uint64_t& random);
  static double sum(const Waves& waves, const Vector3& position_km, double time_s);
  static double jump(const Front& front, const Vector3& position_km);
  static FrontPlace place_at(const Front& front, const Vector3& position_km);

  double activity(const Vector3& drifting_km, double time_s) const;

  std::uint64_t seed_;
  std::vector<Waves> heights_;  // independent, one per height
  Waves regions_;               // where the waves are, and where not
  std::vector<Front> fronts_;
};

}  // namespace thin
