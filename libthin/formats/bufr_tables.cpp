#include "libthin/formats/bufr_tables.h"

#include <eccodes.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>

#include "libthin/foundation/file_bytes.h"

namespace thin {
namespace {

namespace fs = std::filesystem;

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// Up to the next `separator`, which `rest` is moved behind.
std::string_view next_part(std::string_view& rest, char separator) {
  const std::size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return part;
}

// A line of element.table: code|abbreviation|type|name|unit|scale|reference|width|...; others are passed over.
void add_element_line(std::string_view line, BufrTables& tables) {
  const auto descriptor = whole_number(next_part(line, '|'));
  next_part(line, '|');
  const std::string_view type = next_part(line, '|');
  next_part(line, '|');
  next_part(line, '|');
  const auto scale = whole_number(next_part(line, '|'));
  const auto reference = whole_number(next_part(line, '|'));
  const auto width = whole_number(next_part(line, '|'));
  if (!descriptor || !scale || !reference || !width || *width < 0) return;
  const BufrElement::Kind kind = type == "string"                    ? BufrElement::Kind::text
                                 : type == "table" || type == "flag" ? BufrElement::Kind::code_or_flags
                                                                     : BufrElement::Kind::number;
  tables.add_element(static_cast<int>(*descriptor),
                     {kind, static_cast<int>(*scale), *reference, static_cast<unsigned>(*width)});
}

// sequence.def: "310012" = [  002150, 025076, ... ], over as many lines as it takes.
void add_sequences(std::string_view text, BufrTables& tables) {
  for (next_part(text, '"'); !text.empty(); next_part(text, '"')) {
    const auto descriptor = whole_number(next_part(text, '"'));
    next_part(text, '[');
    std::string_view list = next_part(text, ']');
    std::vector<int> members;
    while (!list.empty()) {
      std::string_view member = next_part(list, ',');
      while (!member.empty() && (member.front() < '0' || member.front() > '9')) member.remove_prefix(1);
      while (!member.empty() && (member.back() < '0' || member.back() > '9')) member.remove_suffix(1);
      if (const auto number = whole_number(member)) members.push_back(static_cast<int>(*number));
    }
    if (descriptor) tables.add_sequence(static_cast<int>(*descriptor), std::move(members));
  }
}

std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void add_folder(const fs::path& folder, BufrTables& tables) {
  if (const auto bytes = read_file_bytes((folder / "element.table").string()))
    for (std::string_view rest = text_of(*bytes); !rest.empty();) add_element_line(next_part(rest, '\n'), tables);
  if (const auto bytes = read_file_bytes((folder / "sequence.def").string())) add_sequences(text_of(*bytes), tables);
}

// The first folder of ecCodes' definitions that has these tables, as ecCodes itself looks for them.
std::optional<fs::path> folder_of(const std::string& tables) {
  const char* folders = codes_definition_path(codes_context_get_default());
  std::istringstream list(folders ? folders : "");
  for (std::string folder; std::getline(list, folder, ':');) {
    const fs::path path = fs::path(folder) / "bufr/tables" / tables;
    std::error_code ignored;
    if (fs::exists(path / "element.table", ignored) || fs::exists(path / "sequence.def", ignored)) return path;
  }
  return std::nullopt;
}

// The centre's own tables, where the message says that it uses some and ecCodes has them.
std::optional<fs::path> local_folder_of(const BufrHeader& header) {
  if (header.local_table_version == 0) return std::nullopt;
  return folder_of(std::to_string(header.master_table) + "/local/" + std::to_string(header.local_table_version) + "/" +
                   std::to_string(header.centre) + "/" + std::to_string(header.sub_centre));
}

Result<std::shared_ptr<const BufrTables>> read_installed(const BufrHeader& header,
                                                         const std::optional<fs::path>& local) {
  const std::string master = std::to_string(header.master_table), version = std::to_string(header.master_table_version);
  const auto wmo = folder_of(master + "/wmo/" + version);
  if (!wmo)
    return Error{ErrorKind::input,
                 "it needs version " + version + " of master table " + master + ", which this ecCodes does not have"};
  auto tables = std::make_shared<BufrTables>();
  add_folder(*wmo, *tables);
  if (local) add_folder(*local, *tables);
  return std::shared_ptr<const BufrTables>(std::move(tables));
}

}  // namespace

const BufrElement* BufrTables::element(int descriptor) const {
  if (const auto found = elements_.find(descriptor); found != elements_.end()) return &found->second;
  for (const auto& tables : beneath_)
    if (const BufrElement* found = tables->element(descriptor)) return found;
  return nullptr;
}

const std::vector<int>* BufrTables::sequence(int descriptor) const {
  if (const auto found = sequences_.find(descriptor); found != sequences_.end()) return &found->second;
  for (const auto& tables : beneath_)
    if (const std::vector<int>* found = tables->sequence(descriptor)) return found;
  return nullptr;
}

std::set<int> BufrTables::elements_within(std::span<const int> descriptors) const {
  std::set<int> elements, seen;
  std::vector<int> open(descriptors.begin(), descriptors.end());
  while (!open.empty()) {
    const int descriptor = open.back();
    open.pop_back();
    if (descriptor < 100'000) elements.insert(descriptor);
    if (descriptor < 300'000 || !seen.insert(descriptor).second) continue;
    if (const std::vector<int>* members = sequence(descriptor))
      open.insert(open.end(), members->begin(), members->end());
  }
  return elements;
}

Result<std::shared_ptr<const BufrTables>> installed_tables(const BufrHeader& header) {
  static std::mutex mutex;
  static std::map<std::tuple<int, int, std::string>, std::shared_ptr<const BufrTables>> known;
  const std::optional<fs::path> local = local_folder_of(header);
  const std::tuple key(header.master_table, header.master_table_version, local ? local->string() : "");
  const std::lock_guard lock(mutex);
  if (const auto found = known.find(key); found != known.end()) return found->second;
  auto read = read_installed(header, local);
  if (read) known[key] = *read;
  return read;
}

}  // namespace thin
