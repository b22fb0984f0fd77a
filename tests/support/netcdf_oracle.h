#pragma once

// Two netCDF files side by side, value by value: whether the second is the first with fewer entries along some of its
// dimensions. Slow and obvious: everything is compared through netCDF-C's own reading, in the stored type.

#include <gtest/gtest.h>
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace thin::test {

// By name of the dimension: the entries of the original that must be there, in order.
using KeptEntries = std::map<std::string, std::vector<std::size_t>>;

class OpenNetcdf {
 public:
  explicit OpenNetcdf(const std::string& path) { EXPECT_EQ(nc_open(path.c_str(), NC_NOWRITE, &id), NC_NOERR) << path; }
  ~OpenNetcdf() { nc_close(id); }
  OpenNetcdf(const OpenNetcdf&) = delete;
  OpenNetcdf& operator=(const OpenNetcdf&) = delete;
  int id = -1;
};

struct OracleVariable {
  int type = 0;
  std::vector<std::string> dimensions;
  std::vector<std::size_t> lengths;
  std::vector<std::string> values;  // each as its bytes, or its text
};

inline std::size_t value_count(const OracleVariable& variable) {
  std::size_t count = 1;
  for (const std::size_t length : variable.lengths) count *= length;
  return count;
}

inline OracleVariable read_variable(int group, int id) {
  OracleVariable variable;
  int rank = 0, dimensions[NC_MAX_VAR_DIMS];
  EXPECT_EQ(nc_inq_var(group, id, nullptr, &variable.type, &rank, dimensions, nullptr), NC_NOERR);
  for (int axis = 0; axis < rank; ++axis) {
    char name[NC_MAX_NAME + 1] = {};
    std::size_t length = 0;
    EXPECT_EQ(nc_inq_dim(group, dimensions[axis], name, &length), NC_NOERR);
    variable.dimensions.emplace_back(name);
    variable.lengths.push_back(length);
  }
  const std::size_t count = value_count(variable);
  if (count == 0) return variable;
  if (variable.type == NC_STRING) {
    std::vector<char*> texts(count);
    EXPECT_EQ(nc_get_var_string(group, id, texts.data()), NC_NOERR);
    for (const char* text : texts) variable.values.emplace_back(text ? text : "");
    nc_free_string(count, texts.data());
    return variable;
  }
  std::size_t size = 0;
  EXPECT_EQ(nc_inq_type(group, variable.type, nullptr, &size), NC_NOERR);
  std::vector<char> bytes(count * size);
  EXPECT_EQ(nc_get_var(group, id, bytes.data()), NC_NOERR);
  for (std::size_t i = 0; i < count; ++i) variable.values.emplace_back(bytes.data() + i * size, size);
  return variable;
}

// All variables of a file by path, "MetaData/latitude".
inline void read_group(int group, const std::string& path, std::map<std::string, OracleVariable>& into) {
  int count = 0;
  nc_inq_nvars(group, &count);
  for (int id = 0; id < count; ++id) {
    char name[NC_MAX_NAME + 1] = {};
    nc_inq_varname(group, id, name);
    into[path + name] = read_variable(group, id);
  }
  int groups = 0;
  if (nc_inq_grps(group, &groups, nullptr) != NC_NOERR || groups == 0) return;
  std::vector<int> ids(static_cast<std::size_t>(groups));
  nc_inq_grps(group, nullptr, ids.data());
  for (const int id : ids) {
    char name[NC_MAX_NAME + 1] = {};
    nc_inq_grpname(id, name);
    read_group(id, path + name + "/", into);
  }
}

inline std::map<std::string, OracleVariable> read_all_variables(const std::string& path) {
  std::map<std::string, OracleVariable> variables;
  const OpenNetcdf file(path);
  read_group(file.id, "", variables);
  return variables;
}

// The place in the original of a place in the output, the last dimension fastest.
inline std::size_t original_place(const OracleVariable& original, const OracleVariable& output, std::size_t place,
                                  const KeptEntries& kept) {
  std::size_t result = 0, stride = 1;
  for (std::size_t axis = output.lengths.size(); axis-- > 0;) {
    std::size_t entry = place % output.lengths[axis];
    place /= output.lengths[axis];
    const auto found = kept.find(output.dimensions[axis]);
    if (found != kept.end()) entry = found->second[entry];
    result += entry * stride;
    stride *= original.lengths[axis];
  }
  return result;
}

// Every variable of the original is there, with the retained entries; but for those named, whose values may differ.
inline void expect_retained(const std::string& original_path, const std::string& output_path, const KeptEntries& kept,
                            const std::set<std::string>& rewritten = {}, const std::set<std::string>& added = {}) {
  const auto original = read_all_variables(original_path), output = read_all_variables(output_path);
  EXPECT_EQ(output.size(), original.size() + added.size());
  for (const auto& [path, before] : original) {
    SCOPED_TRACE(path);
    ASSERT_TRUE(output.contains(path));
    const OracleVariable& after = output.at(path);
    EXPECT_EQ(after.dimensions, before.dimensions);
    if (before.type < NC_FIRSTUSERTYPEID) {
      EXPECT_EQ(after.type, before.type);
    }
    for (std::size_t axis = 0; axis < before.lengths.size(); ++axis) {
      const auto found = kept.find(before.dimensions[axis]);
      ASSERT_EQ(after.lengths[axis], found == kept.end() ? before.lengths[axis] : found->second.size());
    }
    if (rewritten.contains(path)) continue;
    for (std::size_t place = 0; place < after.values.size(); ++place)
      ASSERT_EQ(after.values[place], before.values[original_place(before, after, place, kept)]) << place;
  }
}

inline std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  EXPECT_NE(pipe, nullptr);
  std::array<char, 4096> buffer{};
  while (pipe && std::fgets(buffer.data(), buffer.size(), pipe)) text += buffer.data();
  EXPECT_EQ(pipe ? pclose(pipe) : -1, 0) << command;
  return text;
}

// What `ncdump -hs` says of a file, line by line, but for what an output may differ in: lengths of dimensions, the
// library's own marks, and the order of lines. chunks: of fixed dimensions that shrink they shrink too.
inline std::multiset<std::string> header_lines(const std::string& path, bool with_chunks) {
  std::istringstream text(output_of("ncdump -hs '" + path + "'"));
  std::multiset<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    const auto holds = [&](const char* part) { return line.find(part) != std::string::npos; };
    const bool is_dimension = holds(" = ") && !holds(":") && line.ends_with(" ;");
    const bool is_unlimited = holds("currently");
    if (line.starts_with("netcdf ") || is_dimension || is_unlimited || holds("_NCProperties") ||
        holds("_SuperblockVersion"))
      continue;
    if (!with_chunks && holds("_ChunkSizes")) continue;
    lines.insert(line);
  }
  return lines;
}

}  // namespace thin::test
