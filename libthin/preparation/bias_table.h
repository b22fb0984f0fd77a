#pragma once

// Bias corrections as files hold them: a table of biases by satellite, instrument, channel and scan position, and
// coefficients of air-mass predictors (Harris and Kelly 2001). Both are text, one line an entry, fields parted by
// commas; empty lines and lines that begin with # are left out. The first line names the columns.
//
//   satellite,instrument,channel,scan_position,bias_k         NOAA-19,amsua,5,1,0.31
//   satellite,instrument,channel,predictor,coefficient        NOAA-19,amsua,5,constant,-0.12
//                                                             NOAA-19,amsua,5,satellite_zenith_angle_deg^2,1.3e-4
//
// satellite: name or WMO number. scan_position: from 1, or * for those that have no line of their own. predictor:
// `constant`, or a variable of the observations (docs/formats.md), with ^2 to ^9 its power.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libthin/foundation/result.h"
#include "libthin/observations/instruments.h"

namespace thin {

struct SounderChannel {
  Sounder sounder;
  int channel;
  auto operator<=>(const SounderChannel&) const = default;
};

class BiasTable {
 public:
  // `name` stands for the file in messages. Errors: configuration, with file, line, value and remedy.
  static Result<BiasTable> parse(const std::string& text, const std::string& name);

  // Of one channel: by scan position, and for all positions that have none of their own.
  struct Entry {
    std::map<int, double> bias_k;
    std::optional<double> elsewhere_k;
    std::optional<double> at(int scan_position) const;
  };
  const Entry* find(const SounderChannel& channel) const;

 private:
  std::map<SounderChannel, Entry> entries_;
};

struct BiasPredictor {
  std::string variable;  // empty: the constant 1
  int power = 1;
  double coefficient = 0;  // K per unit of the predictor
};

class BiasPredictors {
 public:
  static Result<BiasPredictors> parse(const std::string& text, const std::string& name);  // as BiasTable::parse
  const std::vector<BiasPredictor>* find(const SounderChannel& channel) const;

 private:
  std::map<SounderChannel, std::vector<BiasPredictor>> entries_;
};

}  // namespace thin
