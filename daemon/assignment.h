#pragma once

// Which windows a decoded file goes to, and what becomes of it where it comes too late for them.

#include <functional>

#include "daemon/folders.h"
#include "daemon/journal.h"
#include "daemon/settings.h"

namespace thind {

// Makes the file, just staged, a member of its windows: of the open ones; for a closed one of a later version of it
// (late = rethin), of a window for late data (separate), or of none (drop). Opens windows as needed. A file that ends
// up in none is published as late and dropped. REQUIRES: the times span no more than max_windows_per_file windows
//
// rethin needs the originals of what the closed window held; where one has left the archive, the late data is thinned
// separately, which the log says.
void assign_to_windows(Journal& journal, const Settings& settings, const Folders& folders, const FileRecord& file,
                       std::int64_t now_ms);

}  // namespace thind
