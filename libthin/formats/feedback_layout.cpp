// DWD's feedback files (fof, mon, ekf; version 1.02) with radiances: a header with one entry per report and a body with
// one per channel of it, which i_body (from 1) and l_body of the header lead to; veri_data holds the model equivalents
// of all verification runs over the body. The attributes n_hdr and n_body say how much of the dimensions is in use.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "libthin/formats/netcdf_layout.h"
#include "libthin/formats/sounding_table.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// The tables of the layout.
constexpr int kObstypeRadiances = 10;
constexpr int kVarnoBrightnessTemperature = 119;
constexpr double kMostChannels = 100000;
constexpr int kStatePassive = 5, kStateRejected = 7, kStatePassiveRejected = 9;
constexpr int kFlagThinned = 13;  // number of the bit, and of the check
constexpr int kSurfaceLandBit = 1, kSurfaceSeaBit = 2, kSurfaceIceBit = 4;

// RTTOV's numbers of instruments, which instype holds.
Instrument instrument_of(double instype) {
  constexpr std::pair<int, Instrument> kInstruments[] = {{0, Instrument::hirs},
                                                         {3, Instrument::amsua},
                                                         {4, Instrument::amsub},
                                                         {15, Instrument::mhs},
                                                         {19, Instrument::atms}};
  for (const auto& [number, instrument] : kInstruments)
    if (instype == number) return instrument;
  return Instrument::unknown;
}

// Header variables under the names that every format shares, or their own.
constexpr std::pair<const char*, const char*> kHeaderVariables[] = {
    {"sat_zenit", "satellite_zenith_angle_deg"},
    {"sun_zenit", "solar_zenith_angle_deg"},
    {"sat_azimuth", "satellite_azimuth_deg"},
    {"z_modsurf", "surface_height_m"},
    {"surftype", "surftype"},
    {"mdlsfc", "mdlsfc"},
    {"phase", "phase"},
    {"center", "center"},
    {"cloud_flag", "cloud_flag"},
};

Error damaged(const NetcdfFile& file, const std::string& what) {
  return {ErrorKind::input, fmt::format("{}: feedback file {}. Ask the sender for it again.", file.name(), what)};
}

// Where the parts of each report are.
struct Reports {
  std::size_t header_count = 0, body_count = 0;    // in use
  std::size_t header_length = 0, body_length = 0;  // of the dimensions
  std::vector<std::uint32_t> begin, end;           // in the body, from 0
  std::vector<Instrument> instrument;
  std::vector<bool> is_sounding;  // radiances of an instrument that is read here
  std::vector<double> channel;    // of each entry of the body; NaN where it is no brightness temperature of a channel
  std::set<int> other_instruments;
};

Result<std::vector<double>> required(const NetcdfFile& file, const char* name, std::size_t length) {
  Result<std::vector<double>> column = file.column(name, length);
  if (column && column->size() != length) return damaged(file, fmt::format("without {}", name));
  return column;
}

Result<Reports> read_reports(const NetcdfFile& file) {
  Reports reports;
  reports.header_length = file.dimension_length("d_hdr").value_or(0);
  reports.body_length = file.dimension_length("d_body").value_or(0);
  const double headers = file.number_attribute("n_hdr").value_or(-1),
               bodies = file.number_attribute("n_body").value_or(-1);
  if (!(headers >= 0 && headers <= static_cast<double>(reports.header_length) && bodies >= 0 &&
        bodies <= static_cast<double>(reports.body_length)))
    return damaged(file, fmt::format("whose n_hdr {} and n_body {} are no part of d_hdr {} and d_body {}", headers,
                                     bodies, reports.header_length, reports.body_length));
  reports.header_count = static_cast<std::size_t>(headers);
  reports.body_count = static_cast<std::size_t>(bodies);
  if (reports.header_count > kMostLocations) return damaged(file, "with more reports than any file has");

  const auto first = required(file, "i_body", reports.header_length);
  if (!first) return first.error();
  const auto length = required(file, "l_body", reports.header_length);
  if (!length) return length.error();
  const auto obstype = required(file, "obstype", reports.header_length);
  if (!obstype) return obstype.error();
  const auto varno = required(file, "varno", reports.body_length);
  if (!varno) return varno.error();
  const auto level = required(file, "level", reports.body_length);
  if (!level) return level.error();
  for (std::size_t i = 0; i < varno->size(); ++i) {
    const bool is_channel =
        (*varno)[i] == kVarnoBrightnessTemperature && (*level)[i] >= 0 && (*level)[i] < kMostChannels;
    reports.channel.push_back(is_channel ? (*level)[i] : kMissing);
  }
  const auto instype = file.column("instype", reports.header_length);
  if (!instype) return instype.error();
  std::size_t in_reports = 0;
  for (std::size_t i = 0; i < reports.header_count; ++i) {
    const double begin = (*first)[i] - 1, count = (*length)[i];
    const bool empty = count == 0;
    if (!empty && !(begin >= 0 && count > 0 && begin + count <= bodies))
      return damaged(file, fmt::format("whose report {} has {} entries from {} on, outside of the body of {}", i + 1,
                                       count, begin + 1, bodies));
    reports.begin.push_back(empty ? 0 : static_cast<std::uint32_t>(begin));
    reports.end.push_back(reports.begin.back() + static_cast<std::uint32_t>(count));
    in_reports += static_cast<std::size_t>(count);
    if (in_reports > reports.body_count) return damaged(file, "whose reports share parts of the body");
    const Instrument instrument = instype->empty() ? Instrument::unknown : instrument_of((*instype)[i]);
    const bool radiances =
        (*obstype)[i] == kObstypeRadiances &&
        std::any_of(reports.channel.begin() + reports.begin[i], reports.channel.begin() + reports.end[i],
                    [](double channel) { return !std::isnan(channel); });
    const bool known = instype->empty() || instrument != Instrument::unknown;
    if (radiances && !known && !std::isnan((*instype)[i]))
      reports.other_instruments.insert(static_cast<int>((*instype)[i]));
    reports.instrument.push_back(instrument);
    reports.is_sounding.push_back(radiances && known);
  }
  return reports;
}

class Reader {
 public:
  Reader(const NetcdfFile& file, const InputOptions& options) : file_(file), options_(options) {}

  Result<ReadObservations> read() {
    Result<Reports> reports = read_reports(file_);
    if (!reports) return reports.error();
    reports_ = std::move(*reports);
    std::map<Instrument, std::vector<std::uint32_t>> by_instrument;
    for (std::uint32_t i = 0; i < reports_.header_count; ++i)
      if (reports_.is_sounding[i]) by_instrument[reports_.instrument[i]].push_back(i);
    if (by_instrument.empty()) return nothing_to_read();
    for (const auto step : {&Reader::read_header, &Reader::read_body, &Reader::choose_first_guess})
      if (Result<void> done = (this->*step)(); !done) return done.error();
    std::optional<ReadObservations> all;
    std::vector<Error> problems;  // of an instrument without a usable report: the others are read
    for (const auto& [instrument, headers] : by_instrument) {
      Result<SoundingTable> table = table_of(instrument, headers);
      if (!table) return table.error();
      Result<ReadObservations> contents =
          observations_of(std::move(*table), feedback_layout().name(), options_, file_.name());
      if (!contents)
        problems.push_back(contents.error());
      else if (all)
        join(std::move(*contents), *all);
      else
        all = std::move(*contents);
    }
    if (!all) return problems.front();
    for (const Error& problem : problems) all->skipped.push_back({0, 0, problem.message});
    return std::move(*all);
  }

 private:
  Error nothing_to_read() const {
    const std::string found = reports_.other_instruments.empty()
                                  ? "no radiances (obstype 10, varno 119)"
                                  : fmt::format("radiances of other instruments alone (RTTOV's numbers {})",
                                                fmt::join(reports_.other_instruments, ", "));
    return {ErrorKind::input,
            fmt::format("{}: a feedback file with {}. Send those of HIRS, AMSU-A, AMSU-B, MHS or ATMS.", file_.name(),
                        found)};
  }

  Result<void> read_header() {
    const std::pair<const char*, std::vector<double>*> columns[] = {
        {"lat", &latitude_deg_}, {"lon", &longitude_deg_}, {"time", &time_s_}};
    for (const auto& [name, column] : columns) {
      Result<std::vector<double>> values = required(file_, name, reports_.header_length);
      if (!values) return values.error();
      *column = std::move(*values);
    }
    const double date = file_.number_attribute("verification_ref_date").value_or(0);
    const double time = file_.number_attribute("verification_ref_time").value_or(-1);
    const bool good = time >= 0 && time < 2400;
    const auto origin_s = good ? time_of_date_number(100 * date + std::floor(time / 100)) : std::nullopt;
    if (!origin_s) return damaged(file_, "without verification_ref_date and verification_ref_time");
    for (double& value : time_s_) value = *origin_s + 60 * (std::fmod(time, 100) + value);

    const std::pair<const char*, std::vector<double>*> further[] = {
        {"ident", &platform_}, {"scanline", &scan_line_}, {"fov", &field_of_view_}, {"mdlsfc", &surface_}};
    for (const auto& [name, column] : further) {
      Result<std::vector<double>> values = file_.column(name, reports_.header_length);
      if (!values) return values.error();
      *column = std::move(*values);
    }
    for (const auto& [name, shared] : kHeaderVariables) {
      Result<std::vector<double>> values = file_.column(name, reports_.header_length);
      if (!values) return values.error();
      if (!values->empty()) variables_[shared] = std::move(*values);
    }
    return {};
  }

  Result<void> read_body() {
    Result<std::vector<double>> observed = required(file_, "obs", reports_.body_length);
    if (!observed) return observed.error();
    observed_k_ = std::move(*observed);
    for (const auto& [name, column] : {std::pair("bcor", &correction_k_), {"state", &state_}}) {
      Result<std::vector<double>> values = file_.column(name, reports_.body_length);
      if (!values) return values.error();
      *column = std::move(*values);
    }
    return {};
  }

  // The row of veri_data whose run and member the options name.
  Result<void> choose_first_guess() {
    const NetcdfVariable* data = file_.find("veri_data");
    const std::size_t runs = file_.dimension_length("d_veri").value_or(0);
    const Result<std::vector<double>> type = file_.column("veri_run_type", runs);
    if (!type) return type.error();
    const Result<std::vector<double>> member = file_.column("veri_ens_member", runs);
    if (!member) return member.error();
    const bool usable = data && data->lengths == std::vector<std::size_t>{runs, reports_.body_length};
    for (const int wanted : options_.feedback_members)
      for (std::size_t run = 0; run < type->size() && usable; ++run) {
        const bool right_member = member->empty() || (*member)[run] == wanted;
        if ((*type)[run] != options_.feedback_run_type || !right_member) continue;
        Result<std::vector<double>> values = file_.numbers(*data, run);
        if (!values) return values.error();
        first_guess_k_ = std::move(*values);
        notes_.push_back(
            fmt::format("innovations: obs - veri_data of run {} (veri_run_type {}, veri_ens_member {}) where "
                        "state is {}",
                        run + 1, options_.feedback_run_type, wanted, fmt::join(options_.feedback_accepted, " or ")));
        return {};
      }
    notes_.push_back(fmt::format("values: obs where state is {}", fmt::join(options_.feedback_accepted, " or ")));
    notes_.push_back(
        fmt::format("no innovations: the file has no veri_data with veri_run_type {} and veri_ens_member {}",
                    options_.feedback_run_type, fmt::join(options_.feedback_members, " or ")));
    return {};
  }

  bool is_accepted(double state) const {
    return std::any_of(options_.feedback_accepted.begin(), options_.feedback_accepted.end(),
                       [&](int accepted) { return state == accepted; });
  }

  static std::vector<double> at(const std::vector<double>& column, const std::vector<std::uint32_t>& headers) {
    std::vector<double> values;
    for (const std::uint32_t i : headers)
      if (!column.empty()) values.push_back(column[i]);
    return values;
  }

  Result<SoundingTable> table_of(Instrument instrument, const std::vector<std::uint32_t>& headers) const {
    SoundingTable table;
    table.instrument = instrument;
    table.locations = headers.size();
    table.numbers = headers;
    table.notes = notes_;
    table.latitude_deg = at(latitude_deg_, headers);
    table.longitude_deg = at(longitude_deg_, headers);
    table.time_s = at(time_s_, headers);
    table.platform = at(platform_, headers);
    table.scan_line = at(scan_line_, headers);
    table.field_of_view = at(field_of_view_, headers);
    for (const double bits : at(surface_, headers)) table.surface.push_back(surface_of(bits));
    for (const auto& [name, column] : variables_) table.variables[name] = at(column, headers);
    if (Result<void> filled = fill_values(table, headers); !filled) return filled.error();
    return table;
  }

  // Of the model's grid box.
  static Surface surface_of(double bits) {
    if (!(bits >= 0 && bits < 256)) return Surface::unknown;
    const int set = static_cast<int>(bits);
    if (set & kSurfaceIceBit) return Surface::ice;
    if ((set & kSurfaceLandBit) && (set & kSurfaceSeaBit)) return Surface::coast;
    return set & kSurfaceLandBit ? Surface::land : set & kSurfaceSeaBit ? Surface::sea : Surface::unknown;
  }

  bool is_temperature(std::size_t i) const { return !std::isnan(reports_.channel[i]); }

  Result<void> fill_values(SoundingTable& table, const std::vector<std::uint32_t>& headers) const {
    std::set<int> channels;
    for (const std::uint32_t header : headers)
      for (std::size_t i = reports_.begin[header]; i < reports_.end[header]; ++i)
        if (is_temperature(i)) channels.insert(static_cast<int>(std::lround(reports_.channel[i])));
    table.channels.assign(channels.begin(), channels.end());
    if (table.locations > kMostNetcdfValues / std::max<std::size_t>(1, channels.size()))
      return damaged(file_, "with more reports and channels than any file has");
    table.observed_k.assign(table.locations * channels.size(), kMissing);
    if (!first_guess_k_.empty()) table.first_guess_k = table.observed_k;
    for (std::size_t row = 0; row < headers.size(); ++row)
      for (std::size_t i = reports_.begin[headers[row]]; i < reports_.end[headers[row]]; ++i) {
        if (!is_temperature(i)) continue;
        const auto place =
            std::lower_bound(table.channels.begin(), table.channels.end(), std::lround(reports_.channel[i]));
        const std::size_t at = row * channels.size() + static_cast<std::size_t>(place - table.channels.begin());
        // obs is corrected for bias already; as measured it is obs - bcor.
        const double correction_k = correction_k_.empty() || std::isnan(correction_k_[i]) ? 0 : correction_k_[i];
        if (state_.empty() || is_accepted(state_[i])) table.observed_k[at] = observed_k_[i] - correction_k;
        if (!first_guess_k_.empty()) table.first_guess_k[at] = first_guess_k_[i] - correction_k;
      }
    return {};
  }

  const NetcdfFile& file_;
  const InputOptions& options_;
  Reports reports_;
  std::vector<double> latitude_deg_, longitude_deg_, time_s_, platform_, scan_line_, field_of_view_, surface_;
  std::map<std::string, std::vector<double>> variables_;
  std::vector<double> observed_k_, correction_k_, state_, first_guess_k_;
  std::vector<std::string> notes_;
};

class FeedbackLayout : public NetcdfLayout {
 public:
  const char* name() const override { return "feedback"; }
  bool recognises(const NetcdfFile& file) const override {
    return file.dimension_length("d_hdr") && file.dimension_length("d_body") && file.number_attribute("n_hdr") &&
           file.find("i_body") && file.find("l_body");
  }
  std::size_t locations(const NetcdfFile& file) const override {
    return static_cast<std::size_t>(std::max(0.0, file.number_attribute("n_hdr").value_or(0)));
  }
  Result<ReadObservations> read(const NetcdfFile& file, const InputOptions& options) const override {
    return Reader(file, options).read();
  }

  // Reports that are no soundings go on as they are, or leave, as other messages of BUFR do. What the dimensions hold
  // beyond n_hdr and n_body is nobody's, and leaves.
  Result<NetcdfEdit> subset(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                            const OutputOptions& options) const override {
    const Result<Reports> reports = read_checked(file, retained);
    if (!reports) return reports.error();
    const std::vector<bool> is_retained = retained_of(*reports, retained);
    std::vector<std::uint32_t> headers;
    for (std::uint32_t i = 0; i < reports->header_count; ++i) {
      const bool other = !reports->is_sounding[i] && options.other_messages == OutputOptions::OtherMessages::keep;
      if (is_retained[i] || other) headers.push_back(i);
    }
    NetcdfEdit edit;
    edit.locations = headers.size();
    if (headers.size() == reports->header_count) return edit;

    std::vector<bool> in_body(reports->body_count);
    for (const std::uint32_t i : headers)
      std::fill(in_body.begin() + reports->begin[i], in_body.begin() + reports->end[i], true);
    std::vector<std::uint32_t>& body = edit.kept[file.find("varno")->dimensions.front()];
    std::vector<std::uint32_t> new_place(reports->body_count);
    for (std::uint32_t i = 0; i < reports->body_count; ++i) {
      new_place[i] = static_cast<std::uint32_t>(body.size());
      if (in_body[i]) body.push_back(i);
    }
    for (const std::uint32_t i : headers) {
      const bool empty = reports->begin[i] == reports->end[i];
      edit.replaced["i_body"].push_back(empty ? 1 : new_place[reports->begin[i]] + 1);
    }
    edit.kept[file.find("i_body")->dimensions.front()] = std::move(headers);
    edit.attributes = {{"n_hdr", static_cast<double>(edit.locations)}, {"n_body", static_cast<double>(body.size())}};
    return edit;
  }

  Result<NetcdfEdit> flag(const NetcdfFile& file, std::span<const std::uint32_t> retained,
                          const OutputOptions&) const override {
    const Result<Reports> reports = read_checked(file, retained);
    if (!reports) return reports.error();
    const std::vector<bool> is_retained = retained_of(*reports, retained);
    std::vector<bool> header(reports->header_length), body(reports->body_length);
    for (std::size_t i = 0; i < reports->header_count; ++i) {
      header[i] = reports->is_sounding[i] && !is_retained[i];
      if (header[i]) std::fill(body.begin() + reports->begin[i], body.begin() + reports->end[i], true);
    }
    NetcdfEdit edit;
    edit.locations = reports->header_count;
    if (Result<void> done = add_flags(file, header, "r_state", "r_flags", "r_check", edit); !done) return done.error();
    if (Result<void> done = add_flags(file, body, "state", "flags", "check", edit); !done) return done.error();
    return edit;
  }

 private:
  static Result<Reports> read_checked(const NetcdfFile& file, std::span<const std::uint32_t> retained) {
    Result<Reports> reports = read_reports(file);
    if (reports && !retained.empty() && retained.back() >= reports->header_count)
      return damaged(file, "that has fewer reports than when it was read");
    return reports;
  }

  static std::vector<bool> retained_of(const Reports& reports, std::span<const std::uint32_t> retained) {
    std::vector<bool> is_retained(reports.header_count);
    for (const std::uint32_t i : retained) is_retained[i] = true;
    return is_retained;
  }

  // Sets FL_THIN; the state becomes "rejected", a passive one "passive and rejected", with thinning as the check that
  // decided. A state that says more already, and its check, stay.
  static Result<void> add_flags(const NetcdfFile& file, const std::vector<bool>& thinned, const char* state_name,
                                const char* flags_name, const char* check_name, NetcdfEdit& edit) {
    std::vector<double>* columns[3] = {};
    const char* names[3] = {state_name, flags_name, check_name};
    for (int i = 0; i < 3; ++i) {
      const NetcdfVariable* variable = file.find(names[i]);
      const bool fits = variable && variable->lengths == std::vector<std::size_t>{thinned.size()};
      if (!fits && names[i] == check_name) continue;
      if (!fits) return damaged(file, fmt::format("without {}, where thinning is to be flagged", names[i]));
      Result<std::vector<double>> values = file.stored_numbers(*variable);
      if (!values) return values.error();
      columns[i] = &(edit.replaced[names[i]] = std::move(*values));
    }
    for (std::size_t i = 0; i < thinned.size(); ++i) {
      if (!thinned[i]) continue;
      double& flags = (*columns[1])[i];
      flags = static_cast<double>(static_cast<std::int64_t>(std::max(0.0, flags)) | std::int64_t{1} << kFlagThinned);
      double& state = (*columns[0])[i];
      if (!(state < kStateRejected)) continue;
      state = state == kStatePassive ? kStatePassiveRejected : kStateRejected;
      if (columns[2]) (*columns[2])[i] = kFlagThinned;
    }
    return {};
  }
};

}  // namespace

const NetcdfLayout& feedback_layout() {
  static const FeedbackLayout layout;
  return layout;
}

}  // namespace thin
