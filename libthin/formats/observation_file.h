#pragma once

// Any file of soundings, whatever its layout: recognised by content, read into an ObservationSet, and written again
// with only the retained observations, in its own layout and with every retained value as it came.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

// A part of a file that could not be used, and why, in a sentence for people.
struct SkippedPart {
  std::uint32_t message = 0;  // counted from 0 over all messages of the file
  std::uint64_t offset = 0;   // of its first byte
  std::string reason;
};

// ReadObservations::layout of files of BUFR messages.
inline const std::string kBufrLayout = "bufr";

struct ReadObservations {
  ObservationSet observations;  // AMSU-A: channels 1..15; source.file is 0
  std::string layout;           // "bufr", "ioda", "gsi_diagnostics", "feedback", "cf"
  std::string instrument;       // "AMSU-A"; "AMSU-A, MHS" where there are several
  std::uint32_t message_count = 0;
  // By offset: messages of other kinds, damaged ones, stray bytes (but padding), subsets without position or time.
  std::vector<SkippedPart> skipped;
  // Sentences on how it was read: the rule that innovations were taken by, what the file does not say.
  std::vector<std::string> notes;
};

// Which of two temperatures, where a BUFR message has both (ATMS); elsewhere the one that it has.
enum class BufrTemperature { brightness, antenna };

// [input]: what a file is taken to say, where its layout leaves that open.
struct InputOptions {
  std::string platform;  // of files that don't name their satellite: a name or WMO number; empty: unknown

  BufrTemperature bufr_temperature = BufrTemperature::brightness;

  // IODA: groups. The first of each list that the file has.
  std::string ioda_observed = "ObsValue";
  std::vector<std::string> ioda_first_guess = {"GsiHofXBc", "HofX", "hofx", "HofX0", "hofx0"};
  std::string ioda_bias;  // added to the first guess; empty: it is corrected for bias already, as JEDI writes it
  std::vector<std::string> ioda_quality = {"GsiEffectiveQC", "EffectiveQC", "EffectiveQC0", "PreQC"};
  std::vector<int> ioda_accepted = {0};

  // GSI diagnostics: the variable that is the innovation, and the values of QC_Flag with which it is used.
  std::string gsi_innovation = "Obs_Minus_Forecast_adjusted";
  std::vector<int> gsi_accepted = {0};

  // Feedback files: the run whose veri_data is the first guess, by veri_run_type and the first veri_ens_member of the
  // list that there is; the values of state with which a value is used.
  int feedback_run_type = 1;
  std::vector<int> feedback_members = {-1, 0};
  std::vector<int> feedback_accepted = {0, 1};

  // CF: variables. The quality flag is one per observation and channel, or one per observation.
  std::string cf_first_guess = "first_guess_brightness_temperature";
  std::string cf_bias = "brightness_temperature_bias";
  std::string cf_quality = "quality_flag";
  std::vector<int> cf_accepted = {0};

  void declare(OptionTable& table);
};

// Not for several threads at once, nor is anything else in this folder: ecCodes and HDF5 keep state for the process.
// Errors: input, where nothing in the file can be used (with the reason and the remedy); incomplete, where the end of
// the file is cut off, as of a transfer that still runs; temporary, where the machine fails.
Result<ReadObservations> read_observations(const std::string& path, const InputOptions& options = {});

// The same from the file's bytes; name stands for it in messages.
Result<ReadObservations> read_observations(std::span<const std::uint8_t> bytes, const std::string& name,
                                           const InputOptions& options);

struct OutputOptions {
  enum class Mode { subset, flag };
  Mode mode = Mode::subset;  // the retained alone, or all with the layout's thinning flag on those not retained
  std::string ioda_flag_group = "ThinningQC";  // of the flags that mode flag adds to IODA
  enum class GtsHeaders { keep, drop };
  GtsHeaders gts_headers = GtsHeaders::keep;  // keep: bulletin envelopes stay, their length field made right
  enum class OtherMessages { keep, drop };
  OtherMessages other_messages = OtherMessages::keep;  // of kinds that are not thinned
  void declare(OptionTable& table);
};

// Can files of this layout (ReadObservations::layout) be written so? To be asked before thinning, which takes longer.
// Errors: input, with the reason and the remedy.
Result<void> check_output(const std::string& layout, const OutputOptions& options);

struct ExtractionSummary {
  std::uint32_t messages = 0;
  std::uint64_t subsets = 0;  // of the retained observations
  std::uint64_t bytes = 0;
};

// Writes the retained observations of `original_path` to `output_path` (created or replaced; not yet synced to disk).
// retained: references into the original, any order, no duplicates; `file` is not looked at. Messages are written in
// their order in the original, subsets in theirs. Where nothing would be written, no file is created and messages is 0;
// with flags there always is.
// The same input gives the same bytes.
Result<ExtractionSummary> extract_observations(const std::string& original_path,
                                               std::span<const SourceReference> retained,
                                               const std::string& output_path, const OutputOptions& options);

}  // namespace thin
