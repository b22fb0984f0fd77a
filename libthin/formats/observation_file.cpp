#include "libthin/formats/observation_file.h"

#include <algorithm>
#include <string_view>

#include "libthin/formats/bufr_extraction.h"
#include "libthin/formats/bufr_file.h"
#include "libthin/formats/file_layout.h"
#include "libthin/formats/netcdf_layout.h"
#include "libthin/foundation/file_bytes.h"

namespace thin {

void InputOptions::declare(OptionTable& table) {
  table.add("platform", platform,
            {.explanation = "satellite of files that don't name theirs: a name (NOAA-19) or a WMO number"});
  table.add_choice("bufr_temperature", bufr_temperature,
                   {{"brightness", BufrTemperature::brightness}, {"antenna", BufrTemperature::antenna}},
                   {.explanation = "which temperature, where BUFR has two (ATMS)"});
  table.add("ioda_observed", ioda_observed, {.explanation = "group of the observed brightness temperatures"});
  table.add("ioda_first_guess", ioda_first_guess,
            {.explanation = "groups of the model's equivalents: the first that a file has is subtracted from the "
                            "observed values; empty: none"});
  table.add("ioda_bias", ioda_bias,
            {.explanation = "group that is added to the first guess; empty: the first guess is corrected for bias "
                            "already, as JEDI and GSI write it"});
  table.add("ioda_quality", ioda_quality,
            {.explanation = "groups of quality flags: the first that a file has decides; empty: none"});
  table.add("ioda_accepted", ioda_accepted,
            {.explanation = "flags of ioda_quality with which a value is used; others count as missing"});
  table.add("gsi_innovation", gsi_innovation, {.explanation = "variable of GSI diagnostics that is the innovation"});
  table.add("gsi_accepted", gsi_accepted, {.explanation = "values of QC_Flag with which a value is used"});
  table.add("feedback_run_type", feedback_run_type,
            {.explanation = "veri_run_type of the run that is the first guess: 0 forecast, 1 first guess, 3 analysis"});
  table.add("feedback_members", feedback_members,
            {.explanation = "veri_ens_member of that run, in order of preference: -1 deterministic, 0 ensemble mean"});
  table.add("feedback_accepted", feedback_accepted,
            {.explanation = "states of an observation with which it is used: 0 accepted, 1 active, 5 passive"});
  table.add("cf_first_guess", cf_first_guess, {.explanation = "variable of CF files that is the first guess"});
  table.add("cf_bias", cf_bias,
            {.explanation = "variable of CF files that is the bias of the observed values; where a file has it, it is "
                            "added to the first guess"});
  table.add("cf_quality", cf_quality, {.explanation = "variable of CF files that holds quality flags"});
  table.add("cf_accepted", cf_accepted, {.explanation = "flags of cf_quality with which a value is used"});
}

void OutputOptions::declare(OptionTable& table) {
  table.add_choice("mode", mode, {{"subset", Mode::subset}, {"flag", Mode::flag}},
                   {.explanation = "outputs hold the retained observations alone, or all of them with the layout's own "
                                   "thinning flag set where they are not retained (not BUFR, which has none)"});
  table.add(
      "ioda_flag_group", ioda_flag_group,
      {.explanation = "group of the flags that mode = \"flag\" adds to IODA: 0 retained, 16 thinned, as in JEDI"});
  table.add_choice("gts_headers", gts_headers, {{"keep", GtsHeaders::keep}, {"drop", GtsHeaders::drop}},
                   {.explanation = "bulletin headings around messages: keep them, their length made right, or write "
                                   "bare messages"});
  table.add_choice("other_messages", other_messages, {{"keep", OtherMessages::keep}, {"drop", OtherMessages::drop}},
                   {.explanation = "messages of kinds that are not thinned: keep them as they are, or leave them out"});
}

Result<ReadObservations> read_observations(const std::string& path, const InputOptions& options) {
  const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(path);
  if (!bytes) return bytes.error();
  return read_observations(*bytes, path, options);
}

Result<ReadObservations> read_observations(std::span<const std::uint8_t> bytes, const std::string& name,
                                           const InputOptions& options) {
  switch (layout_of(bytes)) {
    case FileLayout::bufr:
      return read_bufr(bytes, name, options.bufr_temperature);
    case FileLayout::netcdf:
      return read_netcdf(bytes, name, options);
    default:
      return refusal(layout_of(bytes), bytes, name);
  }
}

Result<void> check_output(const std::string& layout, const OutputOptions& options) {
  if (layout == kBufrLayout && options.mode == OutputOptions::Mode::flag)
    return Error{ErrorKind::input,
                 "BUFR has no flag for thinned observations. Set [output] mode = \"subset\", or keep BUFR away."};
  return {};
}

Result<ExtractionSummary> extract_observations(const std::string& original_path,
                                               std::span<const SourceReference> retained,
                                               const std::string& output_path, const OutputOptions& options) {
  const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(original_path);
  if (!bytes) return bytes.error();
  switch (layout_of(*bytes)) {
    case FileLayout::bufr:
      if (const Result<void> possible = check_output(kBufrLayout, options); !possible)
        return Error{possible.error().kind, original_path + ": " + possible.error().message};
      return extract_bufr(*bytes, original_path, retained, output_path, options);
    case FileLayout::netcdf:
      return extract_netcdf(*bytes, original_path, retained, output_path, options);
    default:
      return refusal(layout_of(*bytes), *bytes, original_path);
  }
}

}  // namespace thin
