#pragma once

// netCDF files made by ncgen from CDL, the text form that netCDF's own manual defines: nothing of the code under test
// takes part.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace thin::test {

// Collects the declarations and the data of one CDL file, group by group.
class Cdl {
 public:
  void dimension(const std::string& name, std::size_t length) { dimensions_ << name << " = " << length << ";\n"; }
  void unlimited_dimension(const std::string& name) { dimensions_ << name << " = UNLIMITED;\n"; }
  void global(const std::string& attribute) { globals_ << ":" << attribute << ";\n"; }

  // declaration: "float latitude(Location)"; attributes without the name in front: "units = \"K\"".
  void variable(const std::string& declaration, const std::vector<std::string>& attributes,
                const std::vector<double>& values) {
    declare(declaration, attributes);
    data_ << name_of(declaration) << " = ";
    for (std::size_t i = 0; i < values.size(); ++i) {
      data_ << (i ? ", " : "");
      if (std::isnan(values[i]))
        data_ << "_";
      else
        data_ << std::setprecision(17) << values[i];
    }
    data_ << ";\n";
  }
  void texts(const std::string& declaration, const std::vector<std::string>& attributes,
             const std::vector<std::string>& values) {
    declare(declaration, attributes);
    data_ << name_of(declaration) << " = ";
    for (std::size_t i = 0; i < values.size(); ++i) data_ << (i ? ", " : "") << '"' << values[i] << '"';
    data_ << ";\n";
  }
  void type(const std::string& declaration) { types_ << declaration << ";\n"; }
  // As CDL writes them: "{1, 2.5}, {3, 4.5}".
  void raw(const std::string& declaration, const std::string& values) {
    declare(declaration, {});
    data_ << name_of(declaration) << " = " << values << ";\n";
  }

  // Everything of the root group comes before the first group; groups hold no groups.
  void begin_group(const std::string& name) {
    root_ += text_of_group();
    name_ = name;
    clear();
  }
  void end_group() {
    groups_ << "group: " << name_ << " {\n" << text_of_group() << "}\n";
    clear();
  }

  // kind: as for ncgen -k: "nc4", "nc3", "64-bit offset", "cdf5", "nc7" (netCDF-4 classic).
  std::string write(const std::string& path, const std::string& kind = "nc4") const {
    const std::string source = path + ".cdl";
    std::ofstream(source) << "netcdf file {\n" << root_ << text_of_group() << groups_.str() << "}\n";
    const std::string command = "ncgen -k '" + kind + "' -o '" + path + "' '" + source + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    std::filesystem::remove(source);
    return path;
  }

 private:
  static std::string name_of(const std::string& declaration) {
    const std::size_t begin = declaration.find(' ') + 1;
    return declaration.substr(begin, declaration.find('(') - begin);
  }

  void declare(const std::string& declaration, const std::vector<std::string>& attributes) {
    variables_ << declaration << ";\n";
    for (const std::string& attribute : attributes) {
      // A type in front of an attribute's name: "string units".
      const bool is_string = attribute.starts_with("string ");
      variables_ << (is_string ? "string " : "") << name_of(declaration) << ":"
                 << (is_string ? attribute.substr(7) : attribute) << ";\n";
    }
  }

  std::string text_of_group() const {
    const auto section = [](const char* name, const std::string& text) {
      return text.empty() ? "" : std::string(name) + ":\n" + text;
    };
    std::string text = section("types", types_.str()) + section("dimensions", dimensions_.str());
    text += section("variables", variables_.str() + globals_.str());
    return text + section("data", data_.str());
  }

  void clear() {
    for (std::ostringstream* part : {&types_, &dimensions_, &variables_, &globals_, &data_}) part->str("");
  }

  std::ostringstream types_, dimensions_, variables_, globals_, data_, groups_;
  std::string root_, name_;
};

}  // namespace thin::test
