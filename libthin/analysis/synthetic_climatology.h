#pragma once

// What AMSU-A sees on an average day, roughly: the mean of each channel by latitude, season and surface, its change
// with the scan angle, and its noise. Round figures of the right order, for synthetic soundings; not a climatology to
// compare anything real with.

#include <array>
#include <cstdint>

namespace thin {

constexpr int kSyntheticChannels = 15;

// One number per channel of AMSU-A; channel c stands at c - 1.
using ChannelValues = std::array<double, kSyntheticChannels>;

// 0 over sea, 1 over land, smooth over about 200 km between. The continents are fourteen ellipses where the real ones
// are, so that maps can be read.
double land_fraction(double latitude_deg, double longitude_deg);

// Mean brightness temperature at nadir, K. Channels 1-4 and 15 see the surface.
ChannelValues climatology_k(double latitude_deg, double longitude_deg, std::int64_t time_ms);

// What a slanting view adds, K, in proportion to the longer path: sec(zenith) - 1. Cooling in the troposphere, warming
// in the stratosphere and over the cold sea; the order of Goldberg et al. 2001 (J. Appl. Meteor. 40, 70-83).
// REQUIRES: 0 <= satellite_zenith_deg < 80
ChannelValues limb_effect_k(double satellite_zenith_deg);

// Noise equivalent temperature difference, K, as specified (NOAA KLM User's Guide, table 3.3.2.1-1).
constexpr ChannelValues kNoiseDeviationK = {0.30, 0.30, 0.40, 0.25, 0.25, 0.25, 0.25, 0.25,
                                            0.25, 0.40, 0.40, 0.60, 0.80, 1.20, 0.50};

}  // namespace thin
