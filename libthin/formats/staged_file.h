#pragma once

// What `thin ingest` leaves for `thin window`: one decoded file as canonical netCDF-4, so that a window need not decode
// its inputs again and a bad file can hurt nobody but the process that met it first.

#include "libthin/formats/observation_file.h"

namespace thin {

// Writes everything in `contents` to `path`; the same contents give the same bytes.
Result<void> write_staged(const std::string& path, const ReadObservations& contents);

// What write_staged wrote, equal in every field. Errors: input, where the file is not of this kind or version.
Result<ReadObservations> read_staged(const std::string& path);

}  // namespace thin
