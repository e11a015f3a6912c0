#include <gtest/gtest.h>

#include "quell/text/html_text.h"

namespace quell {
namespace {

TEST(EscapeHtml, LeavesNothingThatBeginsATagOrEndsAnAttribute) {
  EXPECT_EQ(escape_html("<b> & \"c\" 'd' ä\n"), "&lt;b&gt; &amp; &quot;c&quot; 'd' ä\n");
  EXPECT_EQ(escape_html("\xff\x01"), "??");
}

}  // namespace
}  // namespace quell
