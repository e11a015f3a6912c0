#include "text_layout.h"

#include <gtest/gtest.h>

#include <sstream>

namespace quell::app::testing {
namespace {

TEST(TextLayout, BreaksAtSpacesAndKeepsLineFeeds) {
  const std::string words(60, 'a');
  EXPECT_EQ(wrap(words + " " + words + "\n\nend", 2), "  " + words + "\n  " + words + "\n\n  end\n");
  EXPECT_EQ(wrap(""), "");
}

TEST(TextLayout, FillsLinesToTheLastColumn) {
  const std::string half(49, 'a');  // 49 + 1 + 50 = 100
  EXPECT_EQ(wrap(half + " " + half + "a"), half + " " + half + "a\n");
  EXPECT_EQ(wrap(half + " " + half + "aa"), half + "\n" + half + "aa\n");
}

TEST(TextLayout, LeavesWordsThatAreTooLongWhole) {
  const std::string word(150, 'a');
  EXPECT_EQ(wrap("see " + word + " there"), "see\n" + word + "\nthere\n");
}

TEST(TextLayout, CountsCharactersNotBytes) {
  std::string half;
  for (int i = 0; i < 49; ++i) half += "à";
  EXPECT_EQ(wrap(half + " " + half + "a"), half + " " + half + "a\n");
}

TEST(TextLayout, PutsTheSecondColumnBelowWhenTheFirstIsTooLong) {
  EXPECT_EQ(entry("name", "what it is", 2, 10), "  name    what it is\n");
  EXPECT_EQ(entry("a_long_name", "what it is", 2, 10), "  a_long_name\n          what it is\n");
  EXPECT_EQ(entry("name", "", 2, 10), "  name\n");
}

}  // namespace
}  // namespace quell::app::testing
