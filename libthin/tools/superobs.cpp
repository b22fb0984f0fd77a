#include "libthin/tools/superobs.h"

#include <fmt/format.h>

#include <algorithm>

#include "libthin/formats/cf_writer.h"
#include "libthin/observations/mean_observations.h"
#include "libthin/tools/instrument_parts.h"

namespace thin {
namespace {

// "AMSU-A": "amsua".
std::string file_name_of(Instrument instrument) {
  std::string name;
  for (const char letter : std::string(instrument_name(instrument)))
    if (letter >= 'A' && letter <= 'Z')
      name += static_cast<char>(letter - 'A' + 'a');
    else if (letter >= 'a' && letter <= 'z')
      name += letter;
  return fmt::format("superobs-{}.nc", name);
}

// The means of what the files hold.
ObservationSet means_of_files(const ObservationSet& all, const WindowOutcome& outcome) {
  std::vector<Retained> groups = outcome.members;
  for (Retained& members : groups)
    for (std::uint32_t& member : members) member = outcome.prepared.origin[member];
  return mean_observations(all, groups);
}

}  // namespace

Result<void> write_superobs(const std::vector<WindowFile>& files, const ObservationSet& all,
                            const std::string& directory, WindowOutcome& outcome) {
  for (const WindowFile& file : files) {
    outcome.files.push_back(outcome_without_output(file, outcome.window));
    outcome.files.back().notes.emplace_back("its observations went into the means of superobs-*.nc");
  }
  if (outcome.members.empty()) return {};
  return each_instrument(
      means_of_files(all, outcome),
      [&](Instrument instrument, const ObservationSet& means, std::span<const std::uint32_t>) -> Result<void> {
        FileOutcome file;
        file.name = file_name_of(instrument);
        file.layout = "cf";
        file.instrument = instrument_name(instrument);
        file.retained = means.size();
        if (std::any_of(files.begin(), files.end(), [&](const WindowFile& other) { return other.name == file.name; }))
          return Error{ErrorKind::configuration,
                       fmt::format("the means would be written to {}, which an input is called; rename it", file.name)};
        const Result<std::uint64_t> bytes = write_cf_file(directory + "/" + file.name, means);
        if (!bytes) return bytes.error();
        file.output = {1, means.size(), *bytes};
        outcome.files.push_back(std::move(file));
        return {};
      });
}

}  // namespace thin
