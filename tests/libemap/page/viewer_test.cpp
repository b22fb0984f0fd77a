// The page as a visitor has it: what it draws, how it is turned, what it says when it can't.

#include "tests/libemap/page/opened_page.h"
#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {
class ViewerTest : public test::PageTest {};
}  // namespace
}  // namespace emap
