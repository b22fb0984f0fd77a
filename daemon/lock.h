#pragma once

// One daemon per folder: a lock that the kernel drops with its process.

#include <string>

#include "daemon/descriptor.h"
#include "libthin/foundation/result.h"

namespace thind {

class Lock {
 public:
  Lock() = default;
  // Errors: configuration, where another process has it (its number is in the message).
  static thin::Result<Lock> take(const std::string& path);

 private:
  explicit Lock(Descriptor file) : file_(std::move(file)) {}
  Descriptor file_;
};

}  // namespace thind
