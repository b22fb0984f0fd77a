#pragma once

// netCDF-4 files as images in memory, so that writing them to disk has errno and equal contents have equal bytes.
//
// Both classes keep the first failure and do nothing after it; ask once, at the end.

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "libthin/foundation/result.h"

namespace thin {

class NetcdfWriter {
 public:
  NetcdfWriter();
  ~NetcdfWriter();
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;

  void put_attribute(const char* name, const std::string& text);
  void put_attribute(const char* name, int number);
  void put_attribute(const char* name, std::uint32_t number);

  // Length 0 is allowed: then no dimension is made, and variables over it are left out.
  int dimension(const char* name, std::size_t length);

  // T: double, char, std::uint8_t, std::int32_t, std::uint32_t, std::int64_t, std::uint64_t. Deflated, level 1.
  template <class T>
  void put(const char* name, std::initializer_list<int> dimensions, std::span<const T> values);
  template <class T>
  void put(const char* name, std::initializer_list<int> dimensions, std::span<T> values) {
    put(name, dimensions, std::span<const T>(values));
  }

  // The file. Error internal or temporary (out of memory).
  Result<std::vector<std::uint8_t>> finish();

 private:
  void check(int code);

  int file_ = -1;
  int failure_ = 0;
};

class NetcdfReader {
 public:
  // bytes must outlive the reader.
  explicit NetcdfReader(std::span<const std::uint8_t> bytes);
  ~NetcdfReader();
  NetcdfReader(const NetcdfReader&) = delete;
  NetcdfReader& operator=(const NetcdfReader&) = delete;

  bool ok() const { return problem_.empty(); }
  const std::string& problem() const { return problem_; }
  void fail(const std::string& problem);

  std::string text_attribute(const char* name);
  double number_attribute(const char* name);
  std::size_t length(const char* dimension);  // 0 where there is none

  // All values; none, where there is no such variable. Fails where the stored type is another.
  template <class T>
  std::vector<T> get(const char* name);

 private:
  void check(int code, const char* name);

  int file_ = -1;
  std::string problem_;
};

}  // namespace thin
