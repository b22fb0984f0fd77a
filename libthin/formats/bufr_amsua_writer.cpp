#include "libthin/formats/bufr_amsua_writer.h"

#include <eccodes.h>
#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <memory>
#include <vector>

#include "libthin/formats/atomic_file.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

// Centres of the channels' bands, GHz (NOAA KLM User's Guide, table 3.3.2.1-1), for the wave numbers in the messages.
constexpr std::array<double, kAmsuaChannels> kFrequencyGhz = {23.8,      31.4,      50.3,      52.8,      53.596,
                                                              54.4,      54.94,     55.5,      57.290344, 57.290344,
                                                              57.290344, 57.290344, 57.290344, 57.290344, 89.0};
constexpr double kLightSpeedMPerNs = 0.299792458;

constexpr long kAmsuaSensor = 3;
constexpr long kLevel1c = 3, kLevel1b = 2;
constexpr long kFirstChannelNumber = 28;  // of AMSU-A in code table 0 02 150
constexpr std::array<long, 4> kRadiometers = {0, 3, 4, 6};

struct DeleteHandle {
  void operator()(codes_handle* handle) const { codes_handle_delete(handle); }
};

// A message under construction. The first failure is kept and the rest does nothing, so that the caller looks once.
class MessageBuilder {
 public:
  MessageBuilder() : handle_(codes_bufr_handle_new_from_samples(nullptr, "BUFR4")) {
    if (!handle_) failure_ = "cannot find ecCodes' sample BUFR4: are its definitions installed?";
  }

  void set(const std::string& key, long value) {
    if (ok()) note(key, codes_set_long(handle_.get(), key.c_str(), value));
  }
  void set(const std::string& key, double value) {
    if (ok()) note(key, codes_set_double(handle_.get(), key.c_str(), value));
  }
  void set(const std::string& key, const std::vector<long>& values) {
    if (ok()) note(key, codes_set_long_array(handle_.get(), key.c_str(), values.data(), values.size()));
  }
  void set(const std::string& key, const std::vector<double>& values) {
    if (ok()) note(key, codes_set_double_array(handle_.get(), key.c_str(), values.data(), values.size()));
  }

  Result<std::string> finish() {
    set("pack", 1L);
    const void* bytes = nullptr;
    std::size_t size = 0;
    if (ok()) note("message", codes_get_message(handle_.get(), &bytes, &size));
    if (!ok()) return Error{ErrorKind::internal, "cannot encode AMSU-A as BUFR: " + failure_};
    return std::string(static_cast<const char*>(bytes), size);
  }

 private:
  bool ok() const { return failure_.empty(); }
  void note(const std::string& key, int status) {
    if (status != CODES_SUCCESS) failure_ = key + ": " + codes_get_error_message(status);
  }

  std::unique_ptr<codes_handle, DeleteHandle> handle_;
  std::string failure_;
};

// One number of each sounding.
template <class T, class Get>
std::vector<T> column(std::span<const AmsuaSounding> soundings, const Get& get) {
  std::vector<T> numbers;
  numbers.reserve(soundings.size());
  for (const AmsuaSounding& sounding : soundings) numbers.push_back(static_cast<T>(get(sounding)));
  return numbers;
}

void set_sections_0_to_3(MessageBuilder& message, std::span<const AmsuaSounding> soundings) {
  const CivilTime begin = to_civil(soundings.front().view.time_ms);
  message.set("masterTableNumber", 0L);
  message.set("bufrHeaderCentre", 65535L);
  message.set("bufrHeaderSubCentre", 65535L);
  message.set("updateSequenceNumber", 0L);
  message.set("dataCategory", 3L);
  message.set("internationalDataSubCategory", 3L);
  message.set("dataSubCategory", 3L);
  message.set("masterTablesVersionNumber", 13L);
  message.set("localTablesVersionNumber", 0L);
  message.set("typicalYear", static_cast<long>(begin.year));
  message.set("typicalMonth", static_cast<long>(begin.month));
  message.set("typicalDay", static_cast<long>(begin.day));
  message.set("typicalHour", static_cast<long>(begin.hour));
  message.set("typicalMinute", static_cast<long>(begin.minute));
  message.set("typicalSecond", static_cast<long>(begin.second));
  message.set("numberOfSubsets", static_cast<long>(soundings.size()));
  message.set("observedData", 1L);
  message.set("compressedData", 1L);
  message.set("unexpandedDescriptors", 310009L);
}

void set_times(MessageBuilder& message, std::span<const AmsuaSounding> soundings) {
  std::vector<CivilTime> times;
  times.reserve(soundings.size());
  for (const AmsuaSounding& sounding : soundings) times.push_back(to_civil(sounding.view.time_ms));
  const auto field = [&](auto member) {
    std::vector<long> numbers;
    numbers.reserve(times.size());
    for (const CivilTime& time : times) numbers.push_back(time.*member);
    return numbers;
  };
  message.set("year", field(&CivilTime::year));
  message.set("month", field(&CivilTime::month));
  message.set("day", field(&CivilTime::day));
  message.set("hour", field(&CivilTime::hour));
  message.set("minute", field(&CivilTime::minute));
  std::vector<double> seconds;
  seconds.reserve(times.size());
  for (const CivilTime& time : times) seconds.push_back(time.second);
  message.set("second", seconds);
}

void set_instrument(MessageBuilder& message, std::int32_t platform, std::span<const AmsuaSounding> soundings) {
  message.set("#1#tovsOrAtovsProductQualifier", kLevel1c);
  message.set("#2#tovsOrAtovsProductQualifier", kLevel1b);
  message.set("satelliteIdentifier", static_cast<long>(platform));
  message.set("satelliteSensorIndicator", kAmsuaSensor);
  message.set("satelliteAntennaCorrectionsVersionNumber", 0L);
  for (std::size_t i = 0; i < kRadiometers.size(); ++i)
    message.set(fmt::format("#{}#radiometerIdentifier", i + 1), kRadiometers[i]);
  message.set("orbitNumber", column<long>(soundings, [](const auto& s) { return s.orbit_number; }));
  message.set("scanLineNumber", column<long>(soundings, [](const auto& s) { return s.scan_line; }));
  message.set("fieldOfViewNumber", column<long>(soundings, [](const auto& s) { return s.field_of_view; }));
  message.set("scanLineStatusFlagsForAtovs", 0L);
  message.set("scanLineQualityFlagsForAtovs", 0L);
  message.set("fieldOfViewQualityFlagsForAtovs", 0L);
}

void set_geometry(MessageBuilder& message, std::span<const AmsuaSounding> soundings) {
  const auto set = [&](const char* key, double FieldOfView::*member, double factor = 1) {
    message.set(key, column<double>(soundings, [&](const auto& s) { return factor * (s.view.*member); }));
  };
  set("latitude", &FieldOfView::latitude_deg);
  set("longitude", &FieldOfView::longitude_deg);
  set("heightOfStation", &FieldOfView::satellite_height_km, 1000);
  set("satelliteZenithAngle", &FieldOfView::satellite_zenith_deg);
  set("bearingOrAzimuth", &FieldOfView::satellite_azimuth_deg);
  set("solarZenithAngle", &FieldOfView::solar_zenith_deg);
  set("solarAzimuth", &FieldOfView::solar_azimuth_deg);
}

void set_channels(MessageBuilder& message, std::span<const AmsuaSounding> soundings) {
  for (std::size_t channel = 0; channel < kAmsuaChannels; ++channel) {
    const std::string rank = fmt::format("#{}#", channel + 1);
    const double wave_number_per_m = kFrequencyGhz[channel] / kLightSpeedMPerNs;
    message.set(rank + "tovsOrAtovsOrAvhrrInstrumentationChannelNumber",
                kFirstChannelNumber + static_cast<long>(channel));
    message.set(rank + "log10OfTemperatureRadianceCentralWaveNumberForAtovs", std::log10(wave_number_per_m));
    message.set(rank + "bandwidthCorrectionCoefficient1ForAtovs", 0.0);
    message.set(rank + "bandwidthCorrectionCoefficient2ForAtovs", 1.0);
    message.set(rank + "channelQualityFlagsForAtovs", 0L);
    message.set(rank + "brightnessTemperature", column<double>(soundings, [&](const AmsuaSounding& s) {
                  const double value = s.brightness_temperature_k[channel];
                  assert(std::isnan(value) || (value >= 0 && value <= 655.34));
                  return std::isnan(value) ? CODES_MISSING_DOUBLE : value;
                }));
  }
}

// A bulletin as it travels (WMO-No. 386, part II, attachment II-15): its length from SOH to ETX in 8 digits, the format
// 00, and three digits that count bulletins.
std::string in_gts_envelope(const std::string& message, std::uint32_t sequence_number, std::int64_t time_ms) {
  const CivilTime time = to_civil(time_ms);
  const std::string bulletin = fmt::format("\x01\r\r\n{:03}\r\r\nINAX01 SYNT {:02}{:02}{:02}\r\r\n",
                                           sequence_number % 1000, time.day, time.hour, time.minute) +
                               message + "\r\r\n\x03";
  return fmt::format("{:08}00", bulletin.size()) + bulletin;
}

// How many soundings from the front belong to the next message.
std::size_t next_message_size(std::span<const AmsuaSounding> soundings, int lines) {
  constexpr std::size_t kMaximum = 65535;
  std::size_t size = 1;
  for (; size < soundings.size() && size < kMaximum; ++size)
    if (soundings[size].scan_line != soundings[size - 1].scan_line && --lines == 0) break;
  return size;
}

}  // namespace

Result<std::string> encode_amsua_message(std::int32_t platform, std::span<const AmsuaSounding> soundings) {
  assert(!soundings.empty() && soundings.size() <= 65535);
  MessageBuilder message;
  set_sections_0_to_3(message, soundings);
  set_instrument(message, platform, soundings);
  set_times(message, soundings);
  set_geometry(message, soundings);
  set_channels(message, soundings);
  return message.finish();
}

Result<AmsuaFileSummary> write_amsua_file(const std::string& path, std::int32_t platform,
                                          std::span<const AmsuaSounding> soundings, const AmsuaWriterOptions& options) {
  assert(options.lines_per_message >= 1);
  AmsuaFileSummary summary;
  std::string file;
  while (!soundings.empty()) {
    const auto part = soundings.first(next_message_size(soundings, options.lines_per_message));
    auto message = encode_amsua_message(platform, part);
    if (!message) return message.error();
    ++summary.messages;
    file += options.gts_envelopes ? in_gts_envelope(*message, summary.messages, part.front().view.time_ms) : *message;
    soundings = soundings.subspan(part.size());
  }
  summary.bytes = file.size();
  if (auto written = write_text_atomically(path, file); !written) return written.error();
  return summary;
}

}  // namespace thin
