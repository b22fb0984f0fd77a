#pragma once

// What a daemon does before anything else, for the one before it may have died anywhere.

#include "daemon/folders.h"
#include "daemon/journal.h"

namespace thind {

// Removes what was half done, counts interruptions, takes up spooled content that the journal does not know, and marks
// for decoding what is not staged, or was staged by another version of the product. Idempotent.
// REQUIRES: no worker runs. Throws JournalError.
Result<void> recover(const Folders& folders, Journal& journal);

}  // namespace thind
