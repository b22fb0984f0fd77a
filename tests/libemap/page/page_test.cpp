#include "libemap/page/page.h"

#include <gtest/gtest.h>

#include <string>

#include "libemap/page/page_sources.h"
#include "tests/support/browser.h"
#include "tests/support/random32.h"

namespace emap {
namespace {

std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const std::size_t begin = text.find(before) + before.size();
  return text.substr(begin, text.find(after, begin) - begin);
}

TEST(WebPage, HoldsTheStreamsBytesWhateverTheirNumber) {
  test::Random32 random(1);
  for (std::size_t size = 0; size < 8; ++size) {
    std::vector<std::uint8_t> stream(size);
    for (std::uint8_t& byte : stream) byte = static_cast<std::uint8_t>(random());
    const std::string text = between(web_page("model", stream), "octet-stream;base64\">", "</script>");
    EXPECT_EQ(text, test::base64_of(stream));
    EXPECT_EQ(test::bytes_of_base64(text), stream);
  }
}

TEST(WebPage, ATitleIsText) {
  const std::string page = web_page("<script>alert(\"1\")</script> & {{stream}}", {});
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(between(page, "<title>", "</title>"), "&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; {{stream}}");
}

TEST(WebPage, TheScriptsEndWhereTheyShould) {
  for (const std::string_view script : {kPageDecoder, kPageViewer}) {
    EXPECT_GT(script.size(), 1000U);
    EXPECT_EQ(script.find("</script"), std::string_view::npos);
    EXPECT_EQ(script.find("<!--"), std::string_view::npos);
  }
}

}  // namespace
}  // namespace emap
