// quell graph --dot and --svg.
#include <gmock/gmock.h>

#include <filesystem>
#include <regex>
#include <set>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class DrawingCommand : public RunnerTest {
 protected:
  // A `dot` that does what a line of shell says.
  std::string path_with_dot(const std::string& line) {
    std::filesystem::create_directories(path("bin"));
    write_file("bin/dot", "#!/bin/sh\n" + line + "\n");
    std::filesystem::permissions(path("bin/dot"), std::filesystem::perms::owner_all);
    return "PATH=" + text("bin") + ":/usr/bin:/bin";
  }
  Outcome draw_with(const std::string& variable, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"graph", make_graph(), "--svg", "--plugin-path", TEST_PLUGINS};
    words.insert(words.end(), more.begin(), more.end());
    return Program(words, false, {variable}).finish();
  }
};

TEST_F(DrawingCommand, PrintsTheLanguageOfDot) {
  const Outcome outcome = run({"graph", make_graph(), "--dot"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, StartsWith("digraph "));
  EXPECT_THAT(outcome.out, HasSubstr("\"input color\" -> \"scale\":i0_0:w"));
}

TEST_F(DrawingCommand, PrintsSvgThatGraphvizDraws) {
  const Outcome outcome = run({"graph", make_graph(), "--svg"});
  EXPECT_EQ(outcome.code, 0) << "the package graphviz is needed: " << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, StartsWith("<?xml "));
  EXPECT_THAT(outcome.out, HasSubstr("<title>scale</title>"));
}

TEST_F(DrawingCommand, WritesToAFileAndReplacesNothingElse) {
  const std::string graph = make_graph();
  for (const char* format : {"--dot", "--svg"}) {
    const std::string file = text(std::string("drawn") + format);
    EXPECT_EQ(run({"graph", graph, format, "-o", file}).code, 0);
    EXPECT_EQ(run({"graph", graph, format, "-o", file}).out, "");
    EXPECT_EQ(read_file(file), run({"graph", graph, format}).out);
  }
  const Outcome outcome = run({"graph", graph, "--dot", "-o", graph});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("was not written by this option"));
}

TEST_F(DrawingCommand, DrawsForASequenceWhatItHas) {
  make_shot(1);
  write_file("optional.json", R"({ "quell": 1, "inputs": { "color": "color", "albedo": { "type": "albedo", "optional": true } },
  "nodes": { "side": { "pass": "test_scale", "in": { "color": "albedo" } },
             "scale": { "pass": "test_scale", "in": { "color": "color" } } },
  "outputs": { "color": "scale.color" } })");
  EXPECT_THAT(run({"graph", text("optional.json"), text("shot"), "--dot"}).out, HasSubstr("left out: input albedo, side<"));
  EXPECT_THAT(run({"graph", text("optional.json"), "--without", "albedo", "--dot"}).out,
              HasSubstr("left out: input albedo, side<"));
  EXPECT_THAT(run({"graph", text("optional.json"), "--dot"}).out, HasSubstr("left out: side<"));
}

TEST_F(DrawingCommand, SaysWhichPackageIsMissing) {
  const Outcome outcome = draw_with("PATH=" + text("empty"), {"-o", text("drawn.svg")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(
      outcome.err,
      "error: --svg: Graphviz' program 'dot' is not in PATH; install it (on Debian: apt install graphviz), or use --dot and "
      "draw the graph elsewhere\n");
  EXPECT_FALSE(std::filesystem::exists(path("drawn.svg")));
}

TEST_F(DrawingCommand, TellsHowDotFails) {
  Outcome outcome = draw_with(path_with_dot("echo 'no such format' >&2; exit 3"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: --svg: Graphviz' program 'dot' failed with status 3; it says:\nno such format\n");
  outcome = draw_with(path_with_dot("kill -9 $$"));
  EXPECT_EQ(outcome.err, "error: --svg: Graphviz' program 'dot' was ended by signal 9\n");
  outcome = draw_with(path_with_dot("echo '<?xml ?><svg>'"));
  EXPECT_EQ(outcome.err, "error: --svg: Graphviz' program 'dot' wrote no whole drawing\n");
  EXPECT_EQ(outcome.out, "");
}

TEST_F(DrawingCommand, PassesOnWhatDotWarnsOf) {
  const Outcome outcome = draw_with(path_with_dot("cat > /dev/null; echo 'a font is missing' >&2; echo '<svg></svg>'"));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "warning: dot: a font is missing\n");
  EXPECT_EQ(outcome.out, "<svg></svg>\n");
}

TEST_F(DrawingCommand, TakesOneDrawingAtATime) {
  const std::string graph = make_graph();
  EXPECT_EQ(run({"graph", graph, "--dot", "--svg"}).err, "error: --svg: it cannot stand beside --dot; choose one of them\n");
  EXPECT_EQ(run({"graph", graph, "-o", text("x")}).err, "error: --out: it is for drawings; add --dot or --svg\n");
  EXPECT_EQ(run({"graph", graph, "--dot", "--analyze"}).code, 2);
}

// Layouts differ between versions of Graphviz; what is drawn does not.
std::set<std::string> drawn_things(const std::string& svg) {
  static const std::regex title("<title>([^<]*)</title>");
  std::set<std::string> things;
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), title); it != std::sregex_iterator(); ++it) things.insert((*it)[1]);
  return things;
}

TEST_F(DrawingCommand, OfTheShippedGraphIsTheOneInItsReadme) {
  const std::set<std::string> now = drawn_things(quell({"graph", "games202", "--svg"}).out);
  EXPECT_GE(now.size(), 20u);
  EXPECT_EQ(now, drawn_things(read_file(QUELL_SOURCE_DIR "/graphs/images/games202.svg")))
      << "`quell graph games202 --svg -o graphs/images/games202.svg` renews the picture";
}

}  // namespace
}  // namespace quell::app::testing
