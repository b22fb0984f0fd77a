#pragma once

// The way of one window from decoded files to thinned files, the same for `thin run` and for the daemon's worker:
// merge, preparation (window, duplicates, screening, bias, first guess), thinning, report, extraction from the original
// files.

#include <map>
#include <string>
#include <vector>

#include "libthin/formats/observation_file.h"
#include "libthin/preparation/preparation.h"
#include "libthin/tools/settings.h"
#include "libthin/tools/step_clock.h"
#include "libthin/tools/thinned_error.h"

namespace thin {

struct WindowFile {
  std::string name;           // of the output, in the output directory; different for each file
  std::string original_path;  // what the retained observations are extracted from
  ReadObservations contents;
};

struct RefusedFile {
  std::string name;
  std::string reason;
};

struct FileOutcome {
  std::string name;
  std::string layout;
  std::string instrument;
  std::size_t read = 0;          // all of it
  std::size_t observations = 0;  // in the window
  std::size_t retained = 0;
  ExtractionSummary output;  // messages = 0: no file was written
  std::vector<SkippedPart> skipped;
  std::vector<std::string> notes;  // on how it was read
};

// What there is to say of a file before anything is written of it.
FileOutcome outcome_without_output(const WindowFile& file, const TimeWindow& window);

struct WindowOutcome {
  TimeWindow window;
  std::vector<FileOutcome> files;    // by name
  std::vector<RefusedFile> refused;  // by name
  Prepared prepared;
  Retained retained;              // indices into prepared.observations
  std::vector<Retained> members;  // likewise, as Choice's: what goes on are their means
  std::map<Sounder, std::size_t> retained_by_sounder;
  std::map<Instrument, ThinnedError> errors;
  StepSeconds seconds;  // never part of the report
};

// Writes <output_directory>/<name> for each file of which something is retained, then report.json; each whole or not
// at all. Of a method that makes observations: superobs-<instrument>.nc instead (superobs.h). The outputs depend on the
// files, those that the settings name, the window and the settings alone: not on the order of the files. Errors: input,
// where nothing is left to thin; those of reading what the settings name, of prepare(), the method and
// extract_observations().
Result<WindowOutcome> thin_window(std::vector<WindowFile> files, std::vector<RefusedFile> refused,
                                  const TimeWindow& window, const Settings& settings,
                                  const std::string& output_directory);

// The directory's report of a window: its name.
inline constexpr const char* kReportName = "report.json";

}  // namespace thin
