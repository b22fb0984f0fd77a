#include "libthin/tools/variant_json.h"

namespace thin {

using Json = nlohmann::ordered_json;

Json variant_json(const Variant& variant) {
  Json json = {{"label", variant.label}, {"method", variant.thinner->method_name()}};
  json["fit"] = variant.fit.empty() ? Json() : Json(variant.fit);
  const OptionTable options = variant.options.without({"retain_count", "retain_fraction", variant.fit});
  for (const Option& option : options.options()) json["options"][option.name] = option.current_value();
  return json;
}

Json failures_json(const std::vector<Evaluation::Failure>& failures, const std::vector<Variant>& variants) {
  Json json = Json::array();
  for (const Evaluation::Failure& failure : failures)
    json.push_back({{"variant", variants[failure.variant].label}, {"reason", failure.reason}});
  return json;
}

}  // namespace thin
