#include "libthin/thinning/stepwise.h"

#include <fmt/format.h>

namespace thin {

void Stepwise::declare_options(OptionTable& table) {
  table.add(
      "step", step_,
      {.minimum = 1, .maximum = 1000, .explanation = "keep every step-th field of view of every step-th scan line"});
  table.add("line_offset", line_offset_,
            {.unit = "scan lines", .minimum = 0, .explanation = "keep the lines whose number is this modulo step"});
  table.add("field_of_view_offset", field_of_view_offset_,
            {.unit = "fields of view",
             .minimum = 0,
             .explanation = "keep the fields of view whose number, counted from 0, is this modulo step"});
}

std::optional<ThinningMethod::Conflict> Stepwise::conflict() const {
  const auto must_be_less = [&](int offset) {
    return fmt::format("must be less than step = {}, not {}", step_, offset);
  };
  if (line_offset_ >= step_) return Conflict{"line_offset", must_be_less(line_offset_)};
  if (field_of_view_offset_ >= step_) return Conflict{"field_of_view_offset", must_be_less(field_of_view_offset_)};
  return std::nullopt;
}

Result<Choice> Stepwise::choose(const ThinningInput& input) const {
  const ObservationSet& observations = input.observations;
  Retained retained;
  for (std::uint32_t i = 0; i < observations.size(); ++i) {
    const int line = observations.scan_line[i];
    const int field_of_view = observations.field_of_view[i] - 1;
    if (line < 0 || field_of_view < 0)
      return Error{ErrorKind::input,
                   fmt::format("stepwise thinning counts scan lines and fields of view, but observation {} has no {}; "
                               "use method = \"box\" or \"grid_eea\"",
                               i, line < 0 ? "scan line number" : "field of view number")};
    if (line % step_ == line_offset_ && field_of_view % step_ == field_of_view_offset_) retained.push_back(i);
  }
  return Choice{retained};
}

}  // namespace thin
