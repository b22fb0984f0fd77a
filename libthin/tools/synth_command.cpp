// `thin synth`: synthetic AMSU-A soundings on realistic orbits as files of BUFR or CF, delivered as a receiving station
// would.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "libthin/analysis/synthetic_atmosphere.h"
#include "libthin/formats/bufr_amsua_writer.h"
#include "libthin/formats/cf_writer.h"
#include "libthin/foundation/options.h"
#include "libthin/foundation/parallel.h"
#include "libthin/observations/orbit.h"
#include "libthin/observations/platforms.h"
#include "libthin/observations/scan_geometry.h"
#include "libthin/observations/time.h"
#include "libthin/tools/commands.h"

namespace thin {
namespace {

// As given on the command line.
struct SynthArguments {
  std::string output_folder;
  std::vector<std::string> satellites = {"NOAA-15", "NOAA-16"};
  std::string begin = "2004-07-21T22:30:00Z";
  int duration_minutes = 180;
  int minutes_per_file = 10;
  std::uint64_t seed = 1;
  bool noise = true;
  bool climatology = true;
  int lines_per_message = 10;
  std::vector<std::string> dead_channels;
  bool gts = false;
  std::string format = "bufr";
  int deliver_delay_ms = 0;
};

struct DeadChannel {
  std::int32_t platform;
  int channel;
};

// The same, understood.
struct SynthPlan {
  std::vector<OrbitElements> satellites;
  std::vector<DeadChannel> dead_channels;
  std::int64_t begin_ms = 0;
  MeasurementOptions measurement;
  AmsuaWriterOptions writer;
  bool as_cf = false;
};

struct FileTotals {
  std::size_t files = 0;
  std::size_t observations = 0;
  std::uint64_t bytes = 0;
};

Result<OrbitElements> known_satellite(const std::string& name) {
  if (const auto orbit = find_orbit(name)) return *orbit;
  std::vector<std::string> known;
  for (const OrbitElements& orbit : known_orbits()) known.push_back(platform_name(orbit.platform));
  std::string message = fmt::format("unknown satellite \"{}\"", name);
  if (const auto meant = likely_meant(name, known)) message += fmt::format(" (did you mean {}?)", *meant);
  message += "; known are";
  for (const std::string& each : known) message += " " + each;
  return Error{ErrorKind::configuration, message};
}

// "NOAA-16:4"
Result<DeadChannel> read_dead_channel(const std::string& text) {
  const Error malformed{ErrorKind::configuration,
                        fmt::format("--dead-channel {}: expected SATELLITE:CHANNEL with a channel from 1 to {}, as in "
                                    "NOAA-16:4",
                                    text, kAmsuaChannels)};
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return malformed;
  const std::string digits = text.substr(colon + 1);
  if (digits.empty() || digits.size() > 2 || digits.find_first_not_of("0123456789") != std::string::npos)
    return malformed;
  const int channel = std::stoi(digits);
  if (channel < 1 || channel > kAmsuaChannels) return malformed;
  const auto satellite = known_satellite(text.substr(0, colon));
  if (!satellite) return satellite.error();
  return DeadChannel{satellite->platform, channel};
}

Result<SynthPlan> understand(const SynthArguments& arguments) {
  SynthPlan plan;
  const auto begin_ms = from_iso8601(arguments.begin);
  if (!begin_ms)
    return Error{ErrorKind::configuration,
                 fmt::format("--begin {}: not a time; write it as 2004-07-21T22:30:00Z", arguments.begin)};
  plan.begin_ms = *begin_ms;
  std::set<std::int32_t> named;
  for (const std::string& name : arguments.satellites) {
    const auto satellite = known_satellite(name);
    if (!satellite) return satellite.error();
    if (named.insert(satellite->platform).second) plan.satellites.push_back(*satellite);
  }
  for (const std::string& text : arguments.dead_channels) {
    const auto dead = read_dead_channel(text);
    if (!dead) return dead.error();
    plan.dead_channels.push_back(*dead);
  }
  plan.measurement = {.noise = arguments.noise, .climatology = arguments.climatology};
  plan.writer = {.lines_per_message = arguments.lines_per_message, .gts_envelopes = arguments.gts};
  plan.as_cf = arguments.format == "cf";
  return plan;
}

// amsua_noaa15_20040721T223000Z.bufr
std::string file_name(std::int32_t platform, std::int64_t begin_ms) {
  std::string satellite;
  for (const char letter : platform_name(platform))
    if (std::isalnum(static_cast<unsigned char>(letter)))
      satellite += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return fmt::format("amsua_{}_{}", satellite, to_compact_iso8601(begin_ms));
}

// Lines begin at whole multiples of 8 s, whatever the files' limits, so that files cut differently hold the same lines.
// The scan line is counted from the beginning of its orbit.
std::vector<AmsuaSounding> sound(const SyntheticAtmosphere& atmosphere, const Orbit& orbit, const SynthPlan& plan,
                                 std::int64_t begin_ms, std::int64_t end_ms) {
  const auto first_multiple = [](std::int64_t time_ms) {  // at or after
    const std::int64_t rest = time_ms % kAmsuaLineMs;
    return rest == 0 ? time_ms : time_ms - rest + (rest > 0 ? kAmsuaLineMs : 0);
  };
  const std::int64_t first_ms = first_multiple(begin_ms);
  const auto line_count = static_cast<std::size_t>((first_multiple(end_ms) - first_ms) / kAmsuaLineMs);
  std::vector<AmsuaSounding> soundings(line_count * kAmsuaFieldsOfView);
  parallel_ranges(line_count, 4, [&](std::size_t from, std::size_t to) {
    for (std::size_t line = from; line < to; ++line) {
      const std::int64_t line_ms = first_ms + static_cast<std::int64_t>(line) * kAmsuaLineMs;
      const std::int64_t orbit_number = orbit.orbit_number(line_ms);
      const std::int64_t orbit_line = (line_ms - first_multiple(orbit.orbit_begin_ms(orbit_number))) / kAmsuaLineMs + 1;
      const auto views = amsua_scan_line(orbit, line_ms);
      for (std::size_t f = 0; f < views.size(); ++f) {
        const auto field_of_view = static_cast<std::int32_t>(f + 1);
        AmsuaSounding& sounding = soundings[line * kAmsuaFieldsOfView + f];
        sounding.view = views[f];
        sounding.scan_line = static_cast<std::int32_t>(orbit_line);
        sounding.field_of_view = field_of_view;
        sounding.orbit_number = static_cast<std::int32_t>(std::max<std::int64_t>(orbit_number, 0));
        sounding.brightness_temperature_k =
            atmosphere.measurement_k(views[f], {orbit.platform(), line_ms, field_of_view}, plan.measurement);
      }
    }
  });
  return soundings;
}

ObservationSet observations_of(const std::vector<AmsuaSounding>& soundings, std::int32_t platform) {
  ObservationSet set;
  set.channels.resize(kAmsuaChannels);
  std::iota(set.channels.begin(), set.channels.end(), 1);
  std::vector<double> satellite_zenith_deg, solar_zenith_deg;
  for (const AmsuaSounding& sounding : soundings) {
    ObservationSet::Entry entry;
    entry.latitude_deg = sounding.view.latitude_deg;
    entry.longitude_deg = sounding.view.longitude_deg;
    entry.time_ms = sounding.view.time_ms;
    entry.platform = platform;
    entry.instrument = Instrument::amsua;
    entry.scan_line = sounding.scan_line;
    entry.field_of_view = sounding.field_of_view;
    set.push_back(entry, sounding.brightness_temperature_k);
    satellite_zenith_deg.push_back(sounding.view.satellite_zenith_deg);
    solar_zenith_deg.push_back(sounding.view.solar_zenith_deg);
  }
  set.variables = {{"satellite_zenith_angle_deg", std::move(satellite_zenith_deg)},
                   {"solar_zenith_angle_deg", std::move(solar_zenith_deg)}};
  return set;
}

// One file in the format of the plan; CF has no messages, but is one.
Result<AmsuaFileSummary> write_soundings(const std::string& path, std::int32_t platform,
                                         const std::vector<AmsuaSounding>& soundings, const SynthPlan& plan) {
  if (!plan.as_cf) return write_amsua_file(path, platform, soundings, plan.writer);
  const Result<std::uint64_t> bytes = write_cf_file(path, observations_of(soundings, platform));
  if (!bytes) return bytes.error();
  return AmsuaFileSummary{1, *bytes};
}

Result<void> write_file(const std::filesystem::path& folder, const SyntheticAtmosphere& atmosphere, const Orbit& orbit,
                        const SynthPlan& plan, std::int64_t begin_ms, std::int64_t end_ms, FileTotals& totals) {
  std::vector<AmsuaSounding> soundings = sound(atmosphere, orbit, plan, begin_ms, end_ms);
  if (soundings.empty()) return {};
  for (const DeadChannel& dead : plan.dead_channels)
    if (dead.platform == orbit.platform())
      for (AmsuaSounding& sounding : soundings)
        sounding.brightness_temperature_k[static_cast<std::size_t>(dead.channel - 1)] =
            std::numeric_limits<double>::quiet_NaN();

  const std::string name = file_name(orbit.platform(), begin_ms) + (plan.as_cf ? ".nc" : ".bufr");
  const auto summary = write_soundings((folder / name).string(), orbit.platform(), soundings, plan);
  if (!summary) return summary.error();
  fmt::print("{:<42} {:>12} {:>8}  {:<24}  {:<24}\n", name, soundings.size(), summary->messages,
             to_iso8601(soundings.front().view.time_ms), to_iso8601(soundings.back().view.time_ms));
  std::fflush(stdout);  // one line per file as it appears is the progress
  ++totals.files;
  totals.observations += soundings.size();
  totals.bytes += summary->bytes;
  return {};
}

// In the order of time, as files would arrive.
Result<FileTotals> write_files(const SynthArguments& arguments, const SynthPlan& plan) {
  std::error_code error;
  std::filesystem::create_directories(arguments.output_folder, error);
  if (error) return system_error("create the folder", arguments.output_folder, error.value());
  const SyntheticAtmosphere atmosphere(arguments.seed);
  const std::vector<Orbit> orbits(plan.satellites.begin(), plan.satellites.end());
  const std::int64_t end_ms = plan.begin_ms + std::int64_t{arguments.duration_minutes} * 60'000;
  const std::int64_t file_ms = std::int64_t{arguments.minutes_per_file} * 60'000;

  fmt::print("{:<42} {:>12} {:>8}  {:<24}  {:<24}\n", "file", "observations", "messages", "from", "to");
  FileTotals totals;
  for (std::int64_t begin_ms = plan.begin_ms; begin_ms < end_ms; begin_ms += file_ms) {
    for (const Orbit& orbit : orbits) {
      if (totals.files > 0 && arguments.deliver_delay_ms > 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(arguments.deliver_delay_ms));
      const auto written = write_file(arguments.output_folder, atmosphere, orbit, plan, begin_ms,
                                      std::min(begin_ms + file_ms, end_ms), totals);
      if (!written) return written.error();
    }
  }
  return totals;
}

int fail(const Error& error) {
  fmt::print(stderr, "thin synth: {}\n", error.message);
  return exit_code(error.kind);
}

int synthesise(const SynthArguments& arguments) {
  const auto plan = understand(arguments);
  if (!plan) return fail(plan.error());
  const auto totals = write_files(arguments, *plan);
  if (!totals) return fail(totals.error());
  fmt::print("{} files, {} observations, {:.1f} MB in {}\n", totals->files, totals->observations,
             static_cast<double>(totals->bytes) / 1e6, arguments.output_folder);
  return 0;
}

}  // namespace

void add_synth_command(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("synth", "realistic AMSU-A soundings as BUFR or CF files, deterministic by seed");
  const auto arguments = std::make_shared<SynthArguments>();
  command->add_option("-o,--output", arguments->output_folder, "Folder to write to; made where it does not exist")
      ->required();
  command->add_option("--satellite", arguments->satellites, "Name, as NOAA-15; may be given several times")
      ->capture_default_str();
  command->add_option("--begin", arguments->begin, "Time of the first scan line, UTC")->capture_default_str();
  command->add_option("--duration-minutes", arguments->duration_minutes, "How long to sound")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--minutes-per-file", arguments->minutes_per_file, "How much of it goes into one file")
      ->check(CLI::Range(1, 1440))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Of the weather and the noise")->capture_default_str();
  command->add_flag("--noise,!--no-noise", arguments->noise, "Instrument noise (default: with)");
  command->add_flag("--climatology,!--no-climatology", arguments->climatology,
                    "Change with latitude, surface and scan angle (default: with; without, a channel less its mean is "
                    "like an innovation)");
  command->add_option("--lines-per-message", arguments->lines_per_message, "Scan lines in one BUFR message")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--dead-channel", arguments->dead_channels,
                      "SATELLITE:CHANNEL whose values are missing, as NOAA-16:4; may be given several times");
  command->add_option("--format", arguments->format, "bufr, or cf: netCDF as docs/formats.md describes it")
      ->check(CLI::IsMember({"bufr", "cf"}))
      ->capture_default_str();
  command->add_flag("--gts", arguments->gts, "Put each message into a GTS bulletin");
  command->add_option("--deliver-delay-ms", arguments->deliver_delay_ms, "Pause between files")
      ->check(CLI::Range(0, 3'600'000))
      ->capture_default_str();
  command->callback([&action, arguments] { action = [arguments] { return synthesise(*arguments); }; });
}

}  // namespace thin
