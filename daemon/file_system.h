#pragma once

// The few things that the daemon does with files, each either durable when it returns or harmless when it was cut off:
// repeating any of them after a crash leads to the same end.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "libthin/foundation/result.h"

namespace thind {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

// SHA-256 in 64 hexadecimal digits.
std::string sha256_of(std::string_view bytes);
Result<std::string> sha256_of_descriptor(int descriptor);  // from its current position to the end
Result<std::string> sha256_of_file(const std::string& path);
// Of the first `bytes` of it, or of all where it is shorter.
Result<std::string> sha256_of_beginning(const std::string& path, std::int64_t bytes);

// "folder/name".
std::string path_in(const std::string& folder, std::string_view name);

// Of the entry itself, following no link.
bool exists(const std::string& path);

// Makes the folder and those above it.
Result<void> make_folder(const std::string& path);

// Names in a folder, sorted, without "." and "..".
Result<std::vector<std::string>> list_folder(const std::string& path);

// Returns when the content of the file, or the entries of the folder, are on the disk.
Result<void> sync_path(const std::string& path);
// Every file and folder below `path`, and itself.
Result<void> sync_tree(const std::string& path);

Result<std::string> read_file(const std::string& path);
// The file appears at `path` whole or not at all, replacing what was there, and is on the disk.
Result<void> write_file(const std::string& path, std::string_view text);

// Moves a file or folder within one file system; false where `to` is taken, which then stays as it is.
Result<bool> rename_to_free(const std::string& from, const std::string& to);

// Moves a file, by copying where it must cross file systems; both folders are on the disk afterwards. False where `to`
// is taken.
Result<bool> move_to_free(const std::string& from, const std::string& to);

// Moves a file of this SHA-256 into a folder under its name, or, where other content has that name, under the name with
// a part of the hash. Where the folder already holds it, `from` is removed; it need not exist then. Returns the path.
// Errors: input, where the content is in neither place.
Result<std::string> place_file(const std::string& from, const std::string& folder, const std::string& name,
                               const std::string& hash);

// Nothing where it is absent.
Result<void> remove_file(const std::string& path);
Result<void> remove_tree(const std::string& path);

// The same names with the same bytes, all the way down; for files and folders.
Result<bool> same_content(const std::string& one, const std::string& other);

// "AMSUA.bufr" -> "AMSUA-1a2b3c4d.bufr", cut so that it still is a file name.
std::string with_hash(const std::string& name, const std::string& hash);

// The name in printable ASCII: others become '_', and then the hash keeps it distinct.
std::string plain_name(const std::string& name, const std::string& hash);

}  // namespace thind
