// The listing of core/README.md, "In memory, from C++", as it stands there.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

// listing begins
#include <quell/runtime/session.h>

quell::Image denoise_twice(const char* graph_file, const quell::Image& first, const quell::Image& second) {
  const quell::Registry passes = quell::load_plugins();
  quell::Session session(quell::load_graph(graph_file, passes));
  session.push(1, {{"color", first}});  // frame 1 is history for frame 2
  const auto outputs = session.push(2, {{"color", second}});
  return *outputs.at("color").image();
}
// listing ends

namespace {

std::string read(const std::string& file) {
  std::stringstream text;
  text << std::ifstream(QUELL_SOURCE_DIR "/" + file).rdbuf();
  return text.str();
}

TEST(InMemoryExample, AveragesTwoFrames) {
  quell::BufferPool pool;
  quell::Image black(QUELL_TYPE_COLOR, {8, 8}, pool), white(QUELL_TYPE_COLOR, {8, 8}, pool);
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 8; ++y) {
      std::fill_n(black.writable_floats().row(y, c), 8, 0.0F);
      std::fill_n(white.writable_floats().row(y, c), 8, 1.0F);
    }
  const quell::Image result = denoise_twice(QUELL_SOURCE_DIR "/tests/core/runtime/average.json", black, white);
  EXPECT_FLOAT_EQ(result.floats().at(3, 3), 0.25F);  // 0.25 * white + 0.75 * black
}

TEST(InMemoryExample, IsTheListingOfTheReadme) {
  const std::string source = read("tests/core/runtime/in_memory_example_test.cpp");
  const std::string begin = "// listing begins\n";
  const auto from = source.find(begin) + begin.size();
  const std::string listing = source.substr(from, source.find("// listing ends\n") - from);
  EXPECT_LT(std::ranges::count(listing, '\n'), 20);
  EXPECT_NE(read("core/README.md").find(listing), std::string::npos) << "core/README.md shows something else than this:\n"
                                                                     << listing;
}

}  // namespace
