#pragma once

// The output of a method that makes observations: a CF file for each instrument.

#include <string>
#include <vector>

#include "libthin/tools/window_pipeline.h"

namespace thin {

// Writes <directory>/superobs-<instrument>.nc for each instrument and completes outcome.files: those of the input,
// without output of their own, and these. Temperatures and first guess are the means of what the files hold (`all`, of
// which outcome.prepared.origin speaks), without what preparation took off; `mean_of` says of how many.
// Errors: configuration, where an input has such a name; those of write_cf_file().
Result<void> write_superobs(const std::vector<WindowFile>& files, const ObservationSet& all,
                            const std::string& directory, WindowOutcome& outcome);

}  // namespace thin
