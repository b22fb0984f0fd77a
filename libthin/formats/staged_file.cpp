#include "libthin/formats/staged_file.h"

#include <algorithm>
#include <sstream>

#include "libthin/formats/netcdf_image.h"
#include "libthin/foundation/file_bytes.h"

namespace thin {
namespace {

// Of the layout below. A file of another version is refused: staged files live no longer than a window.
constexpr int kStagedVersion = 3;
constexpr const char* kVersionName = "thin_staged_version";

// Of the i-th further variable: its own name may hold what netCDF does not allow in one.
std::string variable_name(std::size_t i) {
  return "variable_" + std::to_string(i);
}

// Structures as columns, the way that netCDF holds them.
struct Columns {
  std::vector<double> x, y, z;
  std::vector<std::uint8_t> surface, instrument, channel_instrument;
  std::vector<std::uint32_t> file, message, subset;
};

Columns columns_of(const ObservationSet& set) {
  Columns columns;
  for (const Vector3& p : set.position_km) {
    columns.x.push_back(p.x);
    columns.y.push_back(p.y);
    columns.z.push_back(p.z);
  }
  for (const Surface surface : set.surface) columns.surface.push_back(static_cast<std::uint8_t>(surface));
  for (const Instrument whose : set.instrument) columns.instrument.push_back(static_cast<std::uint8_t>(whose));
  for (const Instrument whose : set.channel_instrument)
    columns.channel_instrument.push_back(static_cast<std::uint8_t>(whose));
  for (const SourceReference& source : set.source) {
    columns.file.push_back(source.file);
    columns.message.push_back(source.message);
    columns.subset.push_back(source.subset);
  }
  return columns;
}

// Skipped parts: numbers, and all reasons in one text with the end of each.
struct SkippedColumns {
  std::vector<std::uint32_t> message;
  std::vector<std::uint64_t> offset, reason_end;
  std::string text;
};

SkippedColumns columns_of(const std::vector<SkippedPart>& skipped) {
  SkippedColumns columns;
  for (const SkippedPart& part : skipped) {
    columns.message.push_back(part.message);
    columns.offset.push_back(part.offset);
    columns.text += part.reason;
    columns.reason_end.push_back(columns.text.size());
  }
  return columns;
}

void put_observations(NetcdfWriter& file, const ObservationSet& set) {
  const int observation = file.dimension("observation", set.size());
  const int channel = file.dimension("channel", set.channels.size());
  const Columns columns = columns_of(set);
  file.put("channel_number", {channel}, std::span(set.channels));
  file.put("latitude_deg", {observation}, std::span(set.latitude_deg));
  file.put("longitude_deg", {observation}, std::span(set.longitude_deg));
  file.put("position_x_km", {observation}, std::span(columns.x));
  file.put("position_y_km", {observation}, std::span(columns.y));
  file.put("position_z_km", {observation}, std::span(columns.z));
  file.put("time_ms", {observation}, std::span(set.time_ms));
  file.put("platform", {observation}, std::span(set.platform));
  file.put("scan_line", {observation}, std::span(set.scan_line));
  file.put("field_of_view", {observation}, std::span(set.field_of_view));
  file.put("surface", {observation}, std::span(columns.surface));
  file.put("value_k", {observation, channel}, std::span(set.values));
  file.put("instrument", {observation}, std::span(columns.instrument));
  if (!columns.channel_instrument.empty())
    file.put("channel_instrument", {channel}, std::span(columns.channel_instrument));
  if (!set.first_guess_k.empty()) file.put("first_guess_k", {observation, channel}, std::span(set.first_guess_k));
  std::string names;
  std::size_t i = 0;
  for (const auto& [name, column] : set.variables) {
    file.put(variable_name(i++).c_str(), {observation}, std::span(column));
    names += name + "\n";
  }
  file.put_attribute("variables", names);
  file.put("source_file", {observation}, std::span(columns.file));
  file.put("source_message", {observation}, std::span(columns.message));
  file.put("source_subset", {observation}, std::span(columns.subset));
}

void put_skipped(NetcdfWriter& file, const std::vector<SkippedPart>& skipped) {
  const SkippedColumns columns = columns_of(skipped);
  const int part = file.dimension("skipped", skipped.size());
  const int text = file.dimension("reason_text", columns.text.size());
  file.put("skipped_message", {part}, std::span(columns.message));
  file.put("skipped_offset", {part}, std::span(columns.offset));
  file.put("skipped_reason_end", {part}, std::span(columns.reason_end));
  file.put("skipped_reason", {text}, std::span(columns.text.data(), columns.text.size()));
}

Instrument known_instrument(NetcdfReader& file, std::uint8_t number) {
  if (number > static_cast<std::uint8_t>(Instrument::atms)) file.fail("it holds an instrument that this version lacks");
  return static_cast<Instrument>(number);
}

void get_variables(NetcdfReader& file, ObservationSet& set) {
  std::istringstream names(file.text_attribute("variables"));
  std::size_t i = 0;
  for (std::string name; std::getline(names, name);) {
    std::vector<double>& column = set.variables[name] = file.get<double>(variable_name(i++).c_str());
    if (column.size() != set.latitude_deg.size()) file.fail("its variable " + name + " differs in length");
  }
}

ObservationSet get_observations(NetcdfReader& file) {
  ObservationSet set;
  set.channels = file.get<int>("channel_number");
  const std::size_t count = file.length("observation");
  set.latitude_deg = file.get<double>("latitude_deg");
  set.longitude_deg = file.get<double>("longitude_deg");
  set.time_ms = file.get<std::int64_t>("time_ms");
  set.platform = file.get<std::int32_t>("platform");
  set.scan_line = file.get<std::int32_t>("scan_line");
  set.field_of_view = file.get<std::int32_t>("field_of_view");
  set.values = file.get<double>("value_k");
  const auto x = file.get<double>("position_x_km"), y = file.get<double>("position_y_km"),
             z = file.get<double>("position_z_km");
  const auto surface = file.get<std::uint8_t>("surface"), instrument = file.get<std::uint8_t>("instrument"),
             channel_instrument = file.get<std::uint8_t>("channel_instrument");
  set.first_guess_k = file.get<double>("first_guess_k");
  get_variables(file, set);
  const auto source_file = file.get<std::uint32_t>("source_file"), message = file.get<std::uint32_t>("source_message"),
             subset = file.get<std::uint32_t>("source_subset");
  const std::size_t lengths[] = {set.latitude_deg.size(),
                                 set.longitude_deg.size(),
                                 set.time_ms.size(),
                                 set.platform.size(),
                                 set.scan_line.size(),
                                 set.field_of_view.size(),
                                 x.size(),
                                 y.size(),
                                 z.size(),
                                 surface.size(),
                                 instrument.size(),
                                 source_file.size(),
                                 message.size(),
                                 subset.size()};
  const bool equal = std::all_of(std::begin(lengths), std::end(lengths), [&](std::size_t n) { return n == count; });
  const auto fits = [](std::size_t length, std::size_t whole) { return length == 0 || length == whole; };
  if (!equal || set.values.size() != count * set.channels.size() ||
      !fits(set.first_guess_k.size(), set.values.size()) || !fits(channel_instrument.size(), set.channels.size()))
    file.fail("its variables differ in length");
  if (!file.ok()) return set;
  for (std::size_t i = 0; i < count; ++i) {
    if (surface[i] > static_cast<std::uint8_t>(Surface::ice)) file.fail("it holds a surface that this version lacks");
    set.position_km.push_back({x[i], y[i], z[i]});
    set.surface.push_back(static_cast<Surface>(surface[i]));
    set.instrument.push_back(known_instrument(file, instrument[i]));
    set.source.push_back({source_file[i], message[i], subset[i]});
  }
  for (const std::uint8_t whose : channel_instrument) set.channel_instrument.push_back(known_instrument(file, whose));
  return set;
}

std::vector<SkippedPart> get_skipped(NetcdfReader& file) {
  const auto message = file.get<std::uint32_t>("skipped_message");
  const auto offset = file.get<std::uint64_t>("skipped_offset");
  const auto reason_end = file.get<std::uint64_t>("skipped_reason_end");
  const auto characters = file.get<char>("skipped_reason");
  const std::string text(characters.begin(), characters.end());
  std::vector<SkippedPart> skipped;
  if (!file.ok()) return skipped;
  std::uint64_t begin = 0;
  for (std::size_t i = 0; i < message.size() && i < offset.size() && i < reason_end.size(); ++i) {
    if (reason_end[i] < begin || reason_end[i] > text.size()) {
      file.fail("its texts are out of order");
      break;
    }
    skipped.push_back({message[i], offset[i], text.substr(begin, reason_end[i] - begin)});
    begin = reason_end[i];
  }
  return skipped;
}

}  // namespace

Result<void> write_staged(const std::string& path, const ReadObservations& contents) {
  NetcdfWriter file;
  file.put_attribute(kVersionName, kStagedVersion);
  file.put_attribute("layout", contents.layout);
  file.put_attribute("instrument", contents.instrument);
  file.put_attribute("message_count", contents.message_count);
  file.put_attribute("value_kind", static_cast<int>(contents.observations.value_kind));
  std::string notes;
  for (const std::string& note : contents.notes) notes += note + "\n";
  file.put_attribute("notes", notes);
  put_observations(file, contents.observations);
  put_skipped(file, contents.skipped);
  const Result<std::vector<std::uint8_t>> image = file.finish();
  if (!image) return Error{image.error().kind, "cannot stage as " + path + ": " + image.error().message};
  return write_file_bytes(path, *image);
}

Result<ReadObservations> read_staged(const std::string& path) {
  Result<std::vector<std::uint8_t>> bytes = read_file_bytes(path);
  if (!bytes) return bytes.error();
  NetcdfReader file(*bytes);
  const double version = file.number_attribute(kVersionName);
  if (file.ok() && version != kStagedVersion)
    file.fail("its version is " + std::to_string(static_cast<int>(version)) + ", this program's " +
              std::to_string(kStagedVersion));
  ReadObservations contents;
  contents.layout = file.text_attribute("layout");
  contents.instrument = file.text_attribute("instrument");
  contents.message_count = static_cast<std::uint32_t>(file.number_attribute("message_count"));
  std::istringstream notes(file.text_attribute("notes"));
  for (std::string note; std::getline(notes, note);) contents.notes.push_back(note);
  const double value_kind = file.number_attribute("value_kind");
  if (value_kind != 0 && value_kind != 1) file.fail("it holds values of a kind that this version lacks");
  if (file.ok()) contents.observations = get_observations(file);
  if (file.ok()) contents.skipped = get_skipped(file);
  if (!file.ok())
    return Error{ErrorKind::input, path + ": not a staged file of this version (" + file.problem() +
                                       "). Remove it, and stage its original again."};
  contents.observations.value_kind = static_cast<ValueKind>(static_cast<int>(value_kind));
  return contents;
}

}  // namespace thin
