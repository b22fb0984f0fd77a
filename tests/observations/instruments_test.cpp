#include "libthin/observations/instruments.h"

#include <gtest/gtest.h>

namespace thin {
namespace {

TEST(Instruments, AreFoundByNameInAnySpelling) {
  EXPECT_EQ(find_instrument("AMSU-A"), Instrument::amsua);
  EXPECT_EQ(find_instrument("amsua"), Instrument::amsua);
  EXPECT_EQ(find_instrument("amsu_b"), Instrument::amsub);
  EXPECT_EQ(find_instrument("Mhs"), Instrument::mhs);
  for (const char* name : {"", "amsu", "iasi", "unknown instrument"}) EXPECT_FALSE(find_instrument(name)) << name;
}

TEST(Instruments, AndSatellitesHaveOneName) {
  EXPECT_EQ(sounder_name({223, Instrument::mhs}), "NOAA-19 MHS");
  EXPECT_EQ(sounder_name({223, Instrument::unknown}), "NOAA-19");
}

TEST(Instruments, OwnTheirChannels) {
  ObservationSet set;
  set.channels = {1};
  EXPECT_EQ(instrument_of_channel(set, 0), Instrument::unknown);
  const double value[] = {250};
  set.push_back({.instrument = Instrument::hirs, .source = {}}, value);
  EXPECT_EQ(instrument_of_channel(set, 0), Instrument::hirs);
  set.channel_instrument = {Instrument::atms};
  EXPECT_EQ(instrument_of_channel(set, 0), Instrument::atms);
}

}  // namespace
}  // namespace thin
