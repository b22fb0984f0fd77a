#pragma once

#include "libthin/foundation/result.h"

namespace emap {

// Says what went wrong on standard error, once. Returns the exit code: a cut file is as unusable as a wrong one to who
// asks now; only the machine's own failures ask for another try.
int fail(const thin::Error& error);

}  // namespace emap
