#pragma once

// Reads the files that [preparation] names: the land/sea mask, bias corrections, companions.

#include <string>

#include "libthin/formats/observation_file.h"
#include "libthin/foundation/result.h"
#include "libthin/preparation/preparation.h"

namespace thin {

// Relative paths start at this folder: that of the configuration.
void make_paths_absolute(PreparationOptions& options, const std::string& folder);

// All but the companions, whose files may come with the observations. The mask is read only where `surface` is asked
// for. Errors: configuration, where a file is not there or wrong, with file, line, value and remedy; temporary.
Result<PreparationData> read_preparation_data(const PreparationOptions& options);

// The first guesses that companion_files names, in order of file names, read as [input] says. Nothing where first_guess
// is not "companion". Errors: temporary, where nothing matches a name yet; input, where a file can't be read or has no
// first guess.
Result<std::optional<ObservationSet>> read_companions(const PreparationOptions& options, const InputOptions& input);

}  // namespace thin
