// quell tune: what it finds, writes and says.
#include <gmock/gmock.h>

#include <csignal>
#include <cstdlib>

#include "quell/text/json.h"
#include "tests/apps/compare_fixture.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Tune : public CompareTest {
 protected:
  // The best gain is 3/4: color is (1/4, frame / 16, 1/2) and the reference 3/4 of it.
  void make_scaled_shot(int count = 4) {
    make_shot(count);
    for (int frame = 1; frame <= count; ++frame) add_image("color", frame, 0.5F), add_image("reference", frame, 0.375F);
  }
  Outcome tune(std::vector<std::string> options, const std::string& params = R"({ "gain": 2 })") {
    std::vector<std::string> arguments = {"tune", make_graph(params), text("shot"), "--params", "scale.gain"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  }
  double found(const char* name) const {
    Diagnostics errors;
    const auto source = std::make_shared<SourceText>(SourceText{"found", read_file(path("found.json"))});
    return parse_json(source, errors)->find(name)->number;
  }
};

TEST_F(Tune, FindsTheGainThatMakesTheReference) {
  make_scaled_shot();
  for (const char* metric : {"psnr", "mse", "relmse", "smape"}) {
    const Outcome outcome = tune({"--metric", metric, "-o", text("found.json"), "--evaluations", "80"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NEAR(found("scale.gain"), 0.75, 0.003) << metric;
  }
}

TEST_F(Tune, WritesWhatRunTakes) {
  make_scaled_shot();
  ASSERT_EQ(tune({"--metric", "mse", "-o", text("found.json"), "-q"}).code, 0);
  const std::string graph = make_graph(R"({ "gain": 2 })");
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("tuned"), "--params", text("found.json"), "--type", "float", "-q"}).code,
            0);
  const Json figures = compare_json({"shot", "tuned"}, {"--metrics", "mse"});
  EXPECT_LT(figure(figures, "mse").number, 1e-5);
}

TEST_F(Tune, ReportsOnTheFramesThatWereHeldOut) {
  make_scaled_shot(5);
  const Outcome outcome = tune({"--metric", "mse", "--evaluations", "40"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("searching scale.gain on frames 1-3; frames 4-5 held out, 40 evaluations\n"));
  EXPECT_THAT(outcome.err, HasSubstr("\n  mse, frames 1-3 "));
  EXPECT_THAT(outcome.err, HasSubstr("\n  mse, held-out frames 4-5 "));
  EXPECT_THAT(outcome.out, HasSubstr("{ \"scale.gain\": 0.7")) << "without --out, what is found is printed, and nothing else";
}

TEST_F(Tune, WarnsWhereWhatItFoundHoldsForItsFramesAlone) {
  make_scaled_shot(4);
  for (int frame = 3; frame <= 4; ++frame) add_image("reference", frame, 1);
  EXPECT_THAT(tune({"--metric", "mse", "-q"}).err,
              HasSubstr("warning: on the frames that were held out, the tuned values are worse"));
  EXPECT_THAT(tune({"--metric", "mse", "-q", "--held-out", "none"}).err, Not(HasSubstr("held out")));
}

TEST_F(Tune, SaysWhatItWouldDo) {
  make_scaled_shot();
  const Outcome outcome = tune({"--dry-run", "--range", "scale.gain=0..1"}, R"({ "gain": 0.5 })");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("would search, by mixed, against " + text("shot/reference.####.exr")));
  EXPECT_THAT(outcome.out, HasSubstr("0..1"));
}

TEST_F(Tune, RefusesWhatItCannotSearch) {
  make_scaled_shot();
  const std::string graph = make_graph(R"({ "gain": 0 })");
  const auto error = [&](std::vector<std::string> options) {
    std::vector<std::string> arguments = {"tune", graph, text("shot"), "-q"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(error({"--params", "scale.gian"}),
              HasSubstr("--params: the graph 'small' has no parameter 'scale.gian'; did you mean"));
  EXPECT_THAT(error({"--params", "scale.gain"}),
              HasSubstr("is 0, which does not say where to search; add --range scale.gain=LOW..HIGH"));
  EXPECT_THAT(error({"--params", "scale.gain,scale.gain", "--range", "scale.gain=0..1"}), HasSubstr("stands there twice"));
  EXPECT_THAT(error({"--params", "scale.gain", "--range", "scale.gain=1..0"}),
              HasSubstr("is not a range; write PARAM=LOW..HIGH"));
  EXPECT_THAT(error({"--params", "scale.gain", "--range", "scale.gain=-1..1"}), HasSubstr("'scale.gain' goes from 0..1e+09"));
  EXPECT_THAT(error({"--params", "scale.gain", "--range", "scale.gain=0..1", "--range", "x=0..1"}),
              HasSubstr("'x' is not among those"));
  EXPECT_THAT(error({"--params", "scale.gain", "--range", "scale.gain=0..1", "--metric", "tpsnr"}),
              HasSubstr("--metric: 'tpsnr' cannot be searched by"));
}

TEST_F(Tune, SaysThatNothingBetterWasFound) {
  make_scaled_shot();
  const Outcome outcome = tune({"--metric", "mse", "--evaluations", "5", "-o", text("found.json")}, R"({ "gain": 0.75 })");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("nothing better than the start was found"));
  EXPECT_EQ(found("scale.gain"), 0.75);
}

TEST_F(Tune, TellsTheMixtureBesideWhatItIsMadeOf) {
  make_scaled_shot();
  const Outcome outcome = tune({"--evaluations", "20", "-o", text("found.json"), "--held-out", "none"});
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("\n  mixed, frames 1-4 +1 +0[.][0-9]+\n"));
}

TEST_F(Tune, RefusesAFileThatItCannotWriteBeforeItSearches) {
  make_scaled_shot();
  for (const bool dry : {false, true}) {
    std::vector<std::string> options{"-o", text("no/such/found.json")};
    if (dry) options.push_back("--dry-run");
    const Outcome outcome = tune(options);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("--out: " + text("no/such/found.json") + " cannot be written: No such file or directory"));
    EXPECT_THAT(outcome.err, Not(HasSubstr("start:")));
  }
}

TEST_F(Tune, TakesValuesThatThePassRefusesForBadOnes) {
  make_scaled_shot();
  const Outcome outcome = tune({"--metric", "mse", "--evaluations", "60", "-o", text("found.json"), "--range",
                                "scale.gain=0.001..1e9", "--everywhere", "-v"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("a gain above 200000 is too much"));
  EXPECT_NEAR(found("scale.gain"), 0.75, 0.05);
}

TEST_F(Tune, SearchesNothingTwice) {
  make_scaled_shot();
  const auto graph = [&](const std::string& second) {
    write_file("two.json", R"({ "quell": 1, "name": "two", "inputs": { "color": "color" },
      "params": { "gain": { "sets": ["a.gain", "b.gain"] } },
      "nodes": { "a": { "pass": "test_scale", "in": { "color": "color" }, "params": { "gain": 2 } },
                 "b": { "pass": "test_scale", "in": { "color": "a.color" }, "params": { "gain": )" +
                               second + R"( } } },
      "outputs": { "color": "b.color" } })");
    return text("two.json");
  };
  const auto error = [&](const std::string& second, const std::string& params) {
    const Outcome outcome = run({"tune", graph(second), text("shot"), "--params", params, "-q"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(error("2", "gain,b.gain"),
              HasSubstr("--params: 'gain' and 'b.gain' set the same parameter; leave one of them out"));
  EXPECT_THAT(error("3", "gain"), HasSubstr("'gain' sets parameters that have different values now, 2 and 3; give it one first"));
}

TEST_F(Tune, SearchesWholeNumbersBetweenWholeNumbers) {
  make_scaled_shot();
  const std::string graph = make_graph(R"({ "wait_from": 100 })");
  const auto dry = [&](const std::string& range) {
    return run({"tune", graph, text("shot"), "--params", "scale.wait_from", "--range", "scale.wait_from=" + range, "-n"});
  };
  EXPECT_THAT(dry("50.5..120.5").out, HasSubstr("51..120"));
  EXPECT_THAT(dry("50.2..50.8").err, HasSubstr("'scale.wait_from' is a whole number, and 50.2..50.8 holds none of them"));
}

TEST_F(Tune, RefusesAFrameThatCannotBeMeasured) {
  make_scaled_shot();
  std::filesystem::remove(path("shot/reference.0002.exr"));
  write_file("shot/reference.0002.exr", "no image");
  const Outcome outcome = tune({"--metric", "mse", "--held-out", "none"});
  EXPECT_NE(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("reference.0002.exr"));
}

TEST_F(Tune, KeepsTheBestWhenItIsInterrupted) {
  make_scaled_shot();
  const std::string graph = make_graph(R"({ "gain": 2 })");
  Program program({"tune", graph, text("shot"), "--params", "scale.gain", "--metric", "mse", "--evaluations", "1000000", "-o",
                   text("found.json"), "--range", "scale.gain=0..1e9", "--plugin-path", TEST_PLUGINS});
  ASSERT_TRUE(program.wait_for_error_text("\nstart: "));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  // It may have ended before the signal came.
  if (outcome.code == 0) GTEST_SKIP() << "the search was faster than the signal";
  EXPECT_EQ(outcome.code, 75) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the best of them are kept"));
  EXPECT_LE(found("scale.gain"), 2);
}

// From both sides a search ends where one from nearby does, on a part of the sample.
TEST_F(Tune, BringsAWrongParameterBack) {
  const auto mse = [&](const char* sigma) {
    const Outcome outcome = quell({"tune",
                                   "svgf",
                                   QUELL_SOURCE_DIR "/graphs/sample",
                                   "--crop",
                                   "100,60,96,64",
                                   "--frames",
                                   "1-4",
                                   "--held-out",
                                   "none",
                                   "--params",
                                   "sigma_l",
                                   "--range",
                                   "sigma_l=0.1..200",
                                   "--metric",
                                   "relmse",
                                   "--set",
                                   std::string("sigma_l=") + sigma,
                                   "--evaluations",
                                   "30",
                                   "-o",
                                   text("found.json")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    // "relmse, frames 1-4    0.0531    0.0402": the last number of the line.
    const std::size_t line = outcome.out.find("relmse, frames 1-4");
    if (line == std::string::npos) ADD_FAILURE() << outcome.out;
    const std::string row = outcome.out.substr(line, outcome.out.find('\n', line) - line);
    return std::strtod(row.substr(row.find_last_of(' ')).c_str(), nullptr);
  };
  const double tuned = mse("4");
  EXPECT_GT(tuned, 0);
  EXPECT_LE(mse("0.2"), 1.02 * tuned);
  EXPECT_LE(mse("150"), 1.02 * tuned);
}

}  // namespace
}  // namespace quell::app::testing
