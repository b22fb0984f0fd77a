#include "libemap/tools/failure.h"

#include <spdlog/spdlog.h>

namespace emap {

int fail(const thin::Error& error) {
  spdlog::error("{}", error.message);
  return thin::exit_code(error.kind == thin::ErrorKind::incomplete ? thin::ErrorKind::input : error.kind);
}

}  // namespace emap
