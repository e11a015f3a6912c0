#include "console.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace quell::app::testing {
namespace {

/// What a console writes to its stream.
class ConsoleTest : public ::testing::Test {
 protected:
  ~ConsoleTest() override {
    std::fclose(stream_);
    std::free(text_);
  }
  std::string written() {
    std::fflush(stream_);
    return {text_, size_};
  }
  void log(Console& console, spdlog::level::level_enum level, const char* text) {
    console.log(spdlog::details::log_msg("quell", level, text));
  }
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_ = open_memstream(&text_, &size_);
};

TEST_F(ConsoleTest, KeepsTheStatusBelowTheMessages) {
  Console console(stream_, true, false);
  console.set_status("half done");
  log(console, spdlog::level::info, "a message");
  console.set_status("");
  EXPECT_EQ(written(), "half done\r\x1b[Ka message\nhalf done\r\x1b[K");
}

TEST_F(ConsoleTest, HasNoStatusAwayFromATerminal) {
  Console console(stream_, false, false);
  console.set_status("half done");
  log(console, spdlog::level::warn, "a message");
  EXPECT_EQ(written(), "warning: a message\n");
}

TEST_F(ConsoleTest, DoesNotLabelWhatNamesItsOwnPlace) {
  Console console(stream_, false, false);
  log(console, spdlog::level::err, "g.json:1:2: error: wrong");
  log(console, spdlog::level::err, "wrong");
  log(console, spdlog::level::err, "error: wrong without a place");
  EXPECT_EQ(written(), "g.json:1:2: error: wrong\nerror: wrong\nerror: wrong without a place\n");
}

TEST_F(ConsoleTest, ShowsNoControlCharactersOfFileNames) {
  Console console(stream_, true, false);
  log(console, spdlog::level::info, "a\x1b[2J\rb\n\xc3\xa4");
  EXPECT_EQ(written(), "a?[2J?b\n\xc3\xa4\n");
}

}  // namespace
}  // namespace quell::app::testing
