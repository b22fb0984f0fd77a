#include "libthin/observations/instruments.h"

#include <cctype>

#include "libthin/observations/platforms.h"

namespace thin {
namespace {

std::string bare(const std::string& name) {
  std::string letters;
  for (const char letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)))
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return letters;
}

}  // namespace

std::optional<Instrument> find_instrument(const std::string& name) {
  for (const Instrument instrument :
       {Instrument::amsua, Instrument::amsub, Instrument::mhs, Instrument::hirs, Instrument::atms})
    if (bare(instrument_name(instrument)) == bare(name)) return instrument;
  return std::nullopt;
}

int fields_of_view_per_line(Instrument instrument) {
  switch (instrument) {
    case Instrument::amsua:
      return 30;
    case Instrument::amsub:
    case Instrument::mhs:
      return 90;
    case Instrument::hirs:
      return 56;
    case Instrument::atms:
      return 96;
    case Instrument::unknown:
      break;
  }
  return 0;
}

std::string sounder_name(const Sounder& sounder) {
  const std::string satellite = platform_name(sounder.first);
  return sounder.second == Instrument::unknown ? satellite : satellite + " " + instrument_name(sounder.second);
}

Instrument instrument_of_channel(const ObservationSet& set, std::size_t channel_place) {
  if (!set.channel_instrument.empty()) return set.channel_instrument[channel_place];
  return set.instrument.empty() ? Instrument::unknown : set.instrument.front();
}

}  // namespace thin
