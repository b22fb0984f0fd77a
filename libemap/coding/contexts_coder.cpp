#include "libemap/coding/contexts_coder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libemap/coding/coefficient_coding.h"
#include "libemap/coding/coefficient_support.h"
#include "libemap/coding/rectangular_wavelet.h"
#include "libemap/coding/sparse_fit.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

// Magnitudes from this on round up; what is left lies nearer to zero than to one, so that zeros are cheap.
static const double kRounding = getenv("KR")?atof(getenv("KR")):0.4;
// Where a reader puts a coefficient within its interval, measured from the interval's number.
static const double kReconstruction = getenv("KO")?atof(getenv("KO")):-0.04;

QuantisedMap empty_map(const ElevationPatch& patch) {
  const std::uint32_t levels = rectangular_levels(patch.columns, patch.rows);
  return {patch.columns, patch.rows, wavelet_bands(patch.columns, patch.rows, levels),
          coefficient_support(patch.columns, patch.rows, levels, patch.mask),
          std::vector<std::int32_t>(patch.mask.size())};
}

// An error of half a step in every coefficient is one of half a step in every coarse sample, root mean square: four fine
// samples stand for a coarse one.
double step_of(const Band& band, double step) { return 2 * step / synthesis_norm(band); }

class ContextsWriter : public ElevationWriter {
 public:
  explicit ContextsWriter(const ElevationMaps& maps) : maps_(maps) {
    for (const ElevationPatch& patch : maps.patches) quantised_.push_back(empty_map(patch));
 wanted_.resize(quantised_.size());  }

  void write(double step, RangeEncoder& encoder) override {
    thin::parallel_ranges(quantised_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) quantise(maps_.patches[i], step, quantised_[i],wanted_[i]);
    });
    if(getenv("STAT")){ long nz[9][4]={},n[9][4]={},one[9][4]={}; double sumlog=0; for(auto&m:quantised_) for(auto&b:m.bands) for(unsigned r=b.row;r<b.row+b.rows;++r)for(unsigned c=b.column;c<b.column+b.columns;++c){size_t i=size_t(r)*m.columns+c; if(!m.support[i])continue; n[b.level][b.kind]++; int a=std::abs(m.values[i]); if(a)nz[b.level][b.kind]++; if(a==1)one[b.level][b.kind]++; } (void)sumlog; for(int l=1;l<9;l++){fprintf(stderr,"level %d:",l);for(int k=0;k<4;k++)fprintf(stderr," %ld/%ld(%ld)",nz[l][k],n[l][k],one[l][k]);fprintf(stderr,"\n");}}
    CoefficientCoding coding;
    for (std::size_t i=0;i<quantised_.size();++i) coding.code(encoder, quantised_[i], getenv("BP")?&wanted_[i]:nullptr);
  }

 private:
  static void quantise(const ElevationPatch& patch, double step, QuantisedMap& map,std::vector<double>&wanted) {wanted.resize(map.values.size());
    std::vector<double> known = patch.elevation;
    for (std::size_t i = 0; i < known.size(); ++i)
      if (!patch.mask[i]) known[i] = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> steps;
    for (const Band& band : map.bands) steps.push_back(step_of(band, step));
    const std::vector<double> coefficients =
        fit_coefficients(map.columns, map.rows, rectangular_levels(map.columns, map.rows), known, map.support,
                         map.bands, steps);
    for (std::size_t b = 0; b < map.bands.size(); ++b) quantise_band(map.bands[b], steps[b], coefficients, map,wanted);
  }

  static void quantise_band(const Band& band, double step, const std::vector<double>& coefficients,
                            QuantisedMap& map,std::vector<double>&wanted) {
    constexpr double kMost = (1U << kValueBits) - 1;
    for (std::uint32_t r = band.row; r < band.row + band.rows; ++r)
      for (std::uint32_t c = band.column; c < band.column + band.columns; ++c) {
        const std::size_t i = std::size_t{r} * map.columns + c;
        const double rounding = band.kind == 0 ? 0.5 : kRounding;
        const auto magnitude =
            static_cast<std::int32_t>(std::min(std::floor(std::abs(coefficients[i]) / step + rounding), kMost));
        wanted[i]=coefficients[i]/step; map.values[i] = !map.support[i] ? 0 : coefficients[i] < 0 ? -magnitude : magnitude;
      }
  }

  const ElevationMaps& maps_;
  std::vector<QuantisedMap> quantised_;std::vector<std::vector<double>> wanted_;
};

void fill_in(ElevationPatch& patch, const QuantisedMap& map, double step) {
  patch.elevation.assign(map.values.size(), 0);
  for (const Band& band : map.bands) {
    const double band_step = step_of(band, step);
    const double offset = band.kind == 0 ? 0 : kReconstruction;
    for (std::uint32_t r = band.row; r < band.row + band.rows; ++r)
      for (std::uint32_t c = band.column; c < band.column + band.columns; ++c) {
        const std::size_t i = std::size_t{r} * map.columns + c;
        const double value = map.values[i];
        patch.elevation[i] = value == 0 ? 0 : band_step * std::copysign(std::abs(value) + offset, value);
      }
  }
  rectangular_synthesis(map.columns, map.rows, rectangular_levels(map.columns, map.rows), patch.elevation);
  for (std::size_t i = 0; i < patch.mask.size(); ++i)
    if (!patch.mask[i]) patch.elevation[i] = 0;
}

thin::Result<void> read(RangeDecoder& decoder, double step, ElevationMaps& maps) {
  CoefficientCoding coding;
  std::vector<QuantisedMap> quantised;
  for (const ElevationPatch& patch : maps.patches) {
    quantised.push_back(empty_map(patch));
    coding.code(decoder, quantised.back());
    if (decoder.exhausted())
      return thin::Error{thin::ErrorKind::incomplete, "the stream ends within the elevations: it was cut or is damaged"};
  }
  thin::parallel_ranges(quantised.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) fill_in(maps.patches[i], quantised[i], step);
  });
  return {};
}

}  // namespace

ElevationCoder contexts_coder() {
  return {2, "contexts", "13/7 wavelet on rectangles with its finest band left out, mixed contexts, coarse masks", true,
          [](const ElevationMaps& maps) -> std::unique_ptr<ElevationWriter> {
            return std::make_unique<ContextsWriter>(maps);
          },
          &read};
}

}  // namespace emap
