#include "libthin/preparation/bias.h"

#include <cmath>
#include <map>

namespace thin {
namespace {

// What one channel of one sounder is corrected with, looked up once.
struct Correction {
  const BiasTable::Entry* table = nullptr;
  const std::vector<BiasPredictor>* predictors = nullptr;
  std::vector<const std::vector<double>*> columns;  // of the predictors; nullptr: the constant, or a missing variable
};

class Corrections {
 public:
  Corrections(const ObservationSet& set, const BiasTable* table, const BiasPredictors* predictors)
      : set_(set), table_(table), predictors_(predictors) {}

  // By channel place.
  const std::vector<Correction>& of(const Sounder& sounder) {
    const auto [entry, is_new] = by_sounder_.try_emplace(sounder);
    for (std::size_t place = 0; is_new && place < set_.channel_count(); ++place)
      entry->second.push_back(look_up({sounder, set_.channels[place]}));
    return entry->second;
  }

  // K; NaN where something that it needs is missing.
  double bias_k(const Correction& correction, std::size_t i) const {
    double bias = 0;
    if (table_) bias += correction.table ? correction.table->at(set_.field_of_view[i]).value_or(NAN) : NAN;
    if (!predictors_) return bias;
    if (!correction.predictors) return NAN;
    for (std::size_t p = 0; p < correction.predictors->size(); ++p) {
      const BiasPredictor& predictor = (*correction.predictors)[p];
      if (predictor.variable.empty())
        bias += predictor.coefficient;
      else
        bias += correction.columns[p] ? predictor.coefficient * std::pow((*correction.columns[p])[i], predictor.power)
                                      : NAN;
    }
    return bias;
  }

 private:
  Correction look_up(const SounderChannel& channel) const {
    Correction correction;
    if (table_) correction.table = table_->find(channel);
    if (predictors_) correction.predictors = predictors_->find(channel);
    if (!correction.predictors) return correction;
    for (const BiasPredictor& predictor : *correction.predictors) {
      const auto found = set_.variables.find(predictor.variable);
      correction.columns.push_back(found == set_.variables.end() ? nullptr : &found->second);
    }
    return correction;
  }

  const ObservationSet& set_;
  const BiasTable* table_;
  const BiasPredictors* predictors_;
  std::map<Sounder, std::vector<Correction>> by_sounder_;
};

}  // namespace

void BiasOptions::declare(OptionTable& options) {
  options.add("bias_table", table,
              {.explanation = "file of biases by satellite, instrument, channel and scan position (CSV, "
                              "docs/operations.md); empty: none"});
  options.add("bias_predictors", predictors,
              {.explanation = "file of coefficients of air-mass predictors (CSV, docs/operations.md); empty: none"});
  options.add_choice<Uncorrected>(
      "bias_missing", uncorrected, {{"screen", Uncorrected::screen}, {"keep", Uncorrected::keep}},
      {.explanation = "observations that the files have no correction for: screen them out, or keep them as they are"});
}

BiasCounts correct_bias(ObservationSet& set, const BiasTable* table, const BiasPredictors* predictors,
                        const std::vector<bool>& skip, std::vector<bool>& uncorrected) {
  BiasCounts counts;
  uncorrected.assign(set.size(), false);
  if ((!table && !predictors) || set.value_kind == ValueKind::innovation) return counts;
  Corrections corrections(set, table, predictors);
  std::vector<double> corrected(set.channel_count());
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!skip.empty() && skip[i]) continue;
    const std::vector<Correction>& of_channels = corrections.of(sounder_of(set, i));
    const auto values = set.values_of(i);
    bool whole = true;
    for (std::size_t place = 0; place < values.size(); ++place) {
      corrected[place] = values[place];
      if (std::isnan(values[place])) continue;
      corrected[place] -= corrections.bias_k(of_channels[place], i);
      whole = whole && !std::isnan(corrected[place]);
    }
    uncorrected[i] = !whole;
    ++(whole ? counts.corrected : counts.uncorrected);
    if (whole)
      std::copy(corrected.begin(), corrected.end(),
                set.values.begin() + static_cast<std::ptrdiff_t>(i * values.size()));
  }
  return counts;
}

}  // namespace thin
