// quell graph --analyze: what bounds the throughput of a graph on a sequence.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "analysis_text.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// Nodes 'a', 'b' and 'c', of which texts need no more than the names.
Plan plan_of_three() {
  Plan plan;
  const auto graph = std::make_shared<Graph>();
  for (const char* name : {"a", "b", "c"}) {
    PlannedNode& planned = plan.nodes.emplace_back();
    planned.node = static_cast<int>(graph->nodes.size());
    graph->nodes.emplace_back().name = name;
  }
  plan.graph = graph;
  return plan;
}

Analysis bound_by(Analysis::Limit limit, double loop, double work, double io) {
  Analysis analysis;
  if (loop > 0) analysis.cycles = {{.nodes = {0, 2}, .seconds = 2 * loop, .delay = 2}};
  analysis.loop = loop, analysis.work = work, analysis.io = io;
  analysis.limit = limit;
  return analysis;
}

FrameTimes times_of_three(double one, double all, int threads = 4) {
  return {.frames = 5,
          .threads = threads,
          .on_one_thread = {one, one, one},
          .on_all_threads = {all, all, all},
          .source_uses_processor = true,
          .sink_uses_processor = true};
}

TEST(AnalysisText, AlignsTimesAndTerms) {
  FrameTimes times = times_of_three(0.125, 0.0625);
  times.on_one_thread[1] = times.on_all_threads[1] = 1.5;
  times.reading = 0.25;
  const Analysis analysis = bound_by(Analysis::Limit::work, 0.0625, 0.5, 0.0625);
  const Window window{.frames = 6, .bytes_per_frame = 3 << 20, .fixed_bytes = 2048, .reason = "4 threads"};
  EXPECT_EQ(describe(plan_of_three(), times, analysis, window), R"(
time of a frame, one thing after the other: medians of 5 frames
                1 thread    4 threads  speedup
  a           125.000 ms    62.500 ms     2.00
  b          1500.000 ms  1500.000 ms     1.00
  c           125.000 ms    62.500 ms     2.00
  all nodes  1750.000 ms  1625.000 ms     1.08
  reading     250.000 ms
  writing       0.000 ms

slowest cycle of each loop
  a -> c -> a
    125.000 ms / 2 frames = 62.500 ms per frame

what a frame takes at least, with any number of frames in flight
  loops   62.500 ms  the slowest cycle: a frame waits in it for an earlier one
  work   500.000 ms  nodes, reading and writing, shared evenly by 4 threads
  I/O     62.500 ms  reading and writing, if all threads did nothing else
  bound  500.000 ms  per frame at least: at most 2.0 frames/s

work binds (12 % of it reading and writing): more threads on as many processors would help, up to
about 32; then the loop a -> c -> a would bind
a run keeps up to 6 frames in flight (4 threads), each of 3.0 MiB, beside 2.0 KiB of history and
constants
)");
}

TEST(AnalysisText, SaysWhatWouldHelpALoop) {
  const Plan plan = plan_of_three();
  const Analysis analysis = bound_by(Analysis::Limit::loop, 2, 1, 0);
  const std::string others = "; cheaper nodes in it would, and so would a longer delay";
  EXPECT_EQ(explain_limit(plan, times_of_three(1, 1), analysis),
            "the loop a -> c -> a binds: more threads would not help" + others);
  EXPECT_EQ(explain_limit(plan, times_of_three(1.5, 1), analysis),
            "the loop a -> c -> a binds: more threads would help only as far as its nodes run faster on them (1.50 times as fast "
            "on 4 as on 1)" +
                others);
  EXPECT_EQ(explain_limit(plan, times_of_three(1, 1, 1), analysis),
            "the loop a -> c -> a binds: more threads would help only as far as its nodes run faster on them" + others);
}

TEST(AnalysisText, SaysHowManyThreadsWouldHelpWork) {
  const Plan plan = plan_of_three();
  EXPECT_EQ(explain_limit(plan, times_of_three(1, 1), bound_by(Analysis::Limit::work, 0, 0.75, 0)),
            "work binds: more threads on as many processors would help");
  EXPECT_EQ(explain_limit(plan, times_of_three(1, 1), bound_by(Analysis::Limit::work, 1e-5, 0.75, 0)),
            "work binds: more threads on as many processors would help");
  EXPECT_EQ(explain_limit(plan, times_of_three(1, 1), bound_by(Analysis::Limit::work, 0.5, 0.75, 0)),
            "work binds: more threads on as many processors would help, up to about 6; then the loop a -> c -> a would bind");
}

TEST(AnalysisText, SaysWhenReadingAndWritingBind) {
  EXPECT_THAT(explain_limit(plan_of_three(), times_of_three(0, 0), bound_by(Analysis::Limit::io, 0, 0.5, 0.5)),
              StartsWith("reading and writing bind: "));
}

class Analyze : public RunnerTest {
 protected:
  /// With a folder of its own for temporary files.
  Outcome analyze(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "graph");
    arguments.insert(arguments.end(), {"--analyze", "--plugin-path", TEST_PLUGINS});
    fs::create_directories(path("tmp"));
    return Program(arguments, false, {"TMPDIR=" + text("tmp")}).finish();
  }
  /// Whether the file is in a temporary folder.
  bool has_result(const std::string& file) const {
    const std::vector<std::string> folders = list("tmp");
    return std::any_of(folders.begin(), folders.end(),
                       [&](const std::string& folder) { return fs::exists(path("tmp") / folder / file); });
  }
};

TEST_F(Analyze, TellsTimesLoopsAndTheBoundOfTheShippedGraph) {
  const Outcome outcome = analyze({"games202", QUELL_SOURCE_DIR "/graphs/sample", "--threads", "2", "-q"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("nodes, in the order in which they run"));
  const std::string after_plan = outcome.out.substr(std::min(outcome.out.find("\ntime of a frame"), outcome.out.size()));
  EXPECT_THAT(after_plan, HasSubstr("medians of 5 frames\n"));
  EXPECT_THAT(after_plan, ContainsRegex("\n +1 thread +2 threads +speedup\n"
                                        "  filter +[0-9.]+ ms +[0-9.]+ ms +[0-9.]+\n"
                                        "  motion .*\n  reproject .*\n  blend .*\n  all nodes .*\n"
                                        "  reading +[0-9.]+ ms\n  writing +[0-9.]+ ms\n\n"
                                        "slowest cycle of each loop\n"
                                        "  reproject -> blend -> reproject\n"
                                        "    [0-9.]+ ms / 1 frame = [0-9.]+ ms per frame\n\n"
                                        "what a frame takes at least, .*\n"
                                        "  loops +[0-9.]+ ms  .*\n  work +[0-9.]+ ms  .*\n  I/O +[0-9.]+ ms  .*\n"
                                        "  bound +[0-9.]+ ms  per frame at least: at most [0-9.]+ frames/s\n\n"
                                        ".* binds.*"));
  EXPECT_THAT(after_plan, ContainsRegex("\na run keeps up to [0-9]+ frames in flight \\("));
  EXPECT_THAT(after_plan, Not(ContainsRegex("(reading|writing) +0\\.000 ms"))) << "files take time";
  EXPECT_THAT(list("tmp"), IsEmpty());
}

TEST_F(Analyze, MeasuresTheFramesThatAreNamed) {
  make_shot(4);
  EXPECT_THAT(analyze({make_graph(), text("shot")}).out, HasSubstr(": medians of 3 frames\n"));
  EXPECT_THAT(analyze({make_graph(), text("shot"), "--frames", "1-2"}).out, HasSubstr(": medians of 2 frames\n"));
  const Outcome outcome = analyze({make_graph(), "--in", "color=" + text("shot/color.####.exr"), "--threads", "1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("\n +1 thread\n  scale +[0-9.]+ ms\n"));
}

TEST_F(Analyze, FailsWithTheFrameAndLeavesNothingBehind) {
  make_shot(4);
  write_file("shot/color.0003.exr", "this is no image");
  const Outcome outcome = analyze({make_graph(), text("shot"), "-q"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, StartsWith("error: frame 3: "));
  EXPECT_THAT(outcome.err, HasSubstr("color.0003.exr"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("bound")));
  EXPECT_THAT(list("tmp"), IsEmpty());
}

TEST_F(Analyze, CanBeInterruptedAndLeavesNothingBehind) {
  make_shot(4);
  fs::create_directories(path("tmp"));
  Program program({"graph", make_graph(R"({ "wait_from": 3 })"), text("shot"), "--analyze", "--plugin-path", TEST_PLUGINS}, false,
                  {"TMPDIR=" + text("tmp")});
  for (int i = 0; i < 2000 && !has_result("color.0002.exr"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(has_result("color.0002.exr")) << "results are written to a folder below TMPDIR";
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.code, 75);
  EXPECT_THAT(outcome.err, HasSubstr("error: interrupted\n"));
  EXPECT_THAT(list("tmp"), IsEmpty());
}

TEST_F(Analyze, RefusesWhatCannotBe) {
  make_shot(1);
  const Outcome no_sequence = analyze({make_graph()});
  EXPECT_EQ(no_sequence.code, 2);
  EXPECT_THAT(no_sequence.err, StartsWith("error: SEQUENCE: no sequence is given"));
  const Outcome threads = analyze({make_graph(), text("shot"), "--threads", "many"});
  EXPECT_EQ(threads.code, 2);
  EXPECT_EQ(threads.err, "error: --threads: 'many' is not a whole number from 0 to 1024\n");
  const Outcome threads_alone = run({"graph", make_graph(), text("shot"), "--threads", "2"});
  EXPECT_EQ(threads_alone.code, 2);
  EXPECT_THAT(threads_alone.err, StartsWith("error: --threads requires --analyze\n"));
  const Outcome no_folder = Program({"graph", make_graph(), text("shot"), "--analyze", "--plugin-path", TEST_PLUGINS, "-q"},
                                    false, {"TMPDIR=" + text("nowhere")})
                                .finish();
  EXPECT_EQ(no_folder.code, 2);
  EXPECT_THAT(no_folder.err, StartsWith("error: TMPDIR: no temporary folder can be made: "));
}

}  // namespace
}  // namespace quell::app::testing
