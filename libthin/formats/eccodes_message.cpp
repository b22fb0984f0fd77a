#include "libthin/formats/eccodes_message.h"

#include <eccodes.h>

#include <cassert>
#include <filesystem>
#include <limits>
#include <mutex>
#include <sstream>
#include <system_error>

namespace thin {
namespace {

thread_local std::string last_complaint;

void keep_complaint(const codes_context*, int level, const char* text) {
  constexpr int kLevelBits = 7;  // above them a bit that asks for the text of errno, too
  if ((level & kLevelBits) != CODES_LOG_ERROR && (level & kLevelBits) != CODES_LOG_FATAL) return;
  // The first complaint names the cause; later ones tell of the ways that it spoilt.
  if (last_complaint.empty()) last_complaint = text;
}

codes_context* quiet_context() {
  static std::once_flag once;
  codes_context* context = codes_context_get_default();
  std::call_once(once, [&] { codes_context_set_logging_proc(context, keep_complaint); });
  return context;
}

Error eccodes_error(const std::string& what, int code) {
  std::string message = "ecCodes cannot " + what + ": " + codes_get_error_message(code);
  if (!last_complaint.empty()) message += " (" + last_complaint + ")";
  last_complaint.clear();
  return {code == CODES_OUT_OF_MEMORY ? ErrorKind::temporary : ErrorKind::input, message};
}

}  // namespace

bool eccodes_has_tables(int master_table, int version) {
  const char* folders = codes_definition_path(quiet_context());
  if (!folders) return false;
  std::istringstream list(folders);
  for (std::string folder; std::getline(list, folder, ':');) {
    // Some builds carry their definitions inside the library, where no file shows what they have.
    if (folder.starts_with("/MEMFS")) return true;
    const auto tables =
        std::filesystem::path(folder) / "bufr/tables" / std::to_string(master_table) / "wmo" / std::to_string(version);
    std::error_code ignored;
    if (std::filesystem::exists(tables / "sequence.def", ignored) &&
        std::filesystem::exists(tables / "element.table", ignored))
      return true;
  }
  return false;
}

void EccodesMessage::Delete::operator()(grib_handle* handle) const {
  codes_handle_delete(handle);
}

Result<EccodesMessage> EccodesMessage::open(std::span<const std::uint8_t> bytes) {
  codes_context* context = quiet_context();
  last_complaint.clear();
  grib_handle* handle = codes_handle_new_from_message_copy(context, bytes.data(), bytes.size());
  if (!handle) return eccodes_error("open the message", CODES_INVALID_MESSAGE);
  return EccodesMessage(handle);
}

Result<void> EccodesMessage::unpack() {
  last_complaint.clear();
  int code = codes_set_long(handle_.get(), "skipExtraKeyAttributes", 1);
  if (code == CODES_SUCCESS) code = codes_set_long(handle_.get(), "unpack", 1);
  if (code != CODES_SUCCESS) return eccodes_error("decode the message", code);
  return {};
}

Result<long> EccodesMessage::number(const std::string& key) const {
  last_complaint.clear();
  long value = 0;
  const int code = codes_get_long(handle_.get(), key.c_str(), &value);
  if (code != CODES_SUCCESS) return eccodes_error("read " + key, code);
  return value;
}

Result<void> EccodesMessage::numbers(const std::string& key, std::vector<double>& values) const {
  last_complaint.clear();
  std::size_t count = 0;
  int code = codes_get_size(handle_.get(), key.c_str(), &count);
  if (code == CODES_SUCCESS) {
    values.resize(count);
    code = codes_get_double_array(handle_.get(), key.c_str(), values.data(), &count);
    values.resize(count);
  }
  if (code != CODES_SUCCESS) return eccodes_error("read " + key, code);
  for (double& value : values)
    if (value == CODES_MISSING_DOUBLE) value = std::numeric_limits<double>::quiet_NaN();
  return {};
}

Result<std::vector<std::uint8_t>> EccodesMessage::extract_subsets(std::span<const std::uint32_t> subsets) {
  assert(!subsets.empty());
  last_complaint.clear();
  std::vector<long> numbers_from_one;
  numbers_from_one.reserve(subsets.size());
  for (const std::uint32_t subset : subsets) numbers_from_one.push_back(static_cast<long>(subset) + 1);

  grib_handle* handle = handle_.get();
  int code = codes_set_long_array(handle, "extractSubsetList", numbers_from_one.data(), numbers_from_one.size());
  if (code == CODES_SUCCESS) code = codes_set_long(handle, "doExtractSubsets", 1);
  const void* bytes = nullptr;
  std::size_t size = 0;
  if (code == CODES_SUCCESS) code = codes_get_message(handle, &bytes, &size);
  if (code != CODES_SUCCESS) return eccodes_error("extract subsets", code);
  const auto* first = static_cast<const std::uint8_t*>(bytes);
  return std::vector<std::uint8_t>(first, first + size);
}

}  // namespace thin
