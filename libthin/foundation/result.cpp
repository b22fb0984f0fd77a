#include "libthin/foundation/result.h"

#include <cerrno>
#include <cstring>

namespace thin {

ErrorKind kind_of_errno(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EIO:
    case EMFILE:
    case ENFILE:
    case ENOMEM:
    case EAGAIN:
    case EINTR:
      return ErrorKind::temporary;
    default:
      return ErrorKind::internal;
  }
}

Error system_error(const std::string& what, const std::string& path, int error_number) {
  return {kind_of_errno(error_number), "cannot " + what + " " + path + ": " + std::strerror(error_number)};
}

}  // namespace thin
