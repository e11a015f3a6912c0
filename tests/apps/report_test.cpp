// quell report: the file that it writes. What a browser makes of it is tested in report/report.test.mjs.
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "quell/text/json.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Report : public RunnerTest {
 protected:
  Report() {
    make_shot(4);
    for (int frame = 1; frame <= 4; ++frame) add_image("reference", frame, 0.25F);
    graph_ = make_graph();
  }
  Outcome report(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"report", text("shot")};
    if (std::ranges::none_of(more, [](const std::string& word) { return word.ends_with(".json"); })) arguments.push_back(graph_);
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.insert(arguments.end(), {"-o", text("report.html")});
    return run(arguments);
  }
  /// The data of the report that was written.
  Json data() const {
    const std::string page = read_file(path("report.html"));
    const std::string begin = "<script type=\"application/json\" id=\"report\">";
    const std::size_t start = page.find(begin) + begin.size();
    auto source = std::make_shared<SourceText>();
    source->text = page.substr(start, page.find("</script>", start) - start);
    Diagnostics errors;
    return parse_json(source, errors).value();
  }
  /// "noisy color 1 2", a line for each series of images: kind, name and frames.
  static std::vector<std::string> images(const Json& data) {
    std::vector<std::string> lines;
    for (const Json& image : data.find("images")->elements) {
      std::string line = image.find("kind")->string + " " + image.find("name")->string;
      for (const JsonMember& frame : image.find("frames")->members) line += " " + frame.key;
      lines.push_back(line);
    }
    return lines;
  }
  std::string graph_;
};

TEST_F(Report, HoldsResultsInputsFiguresAndTheGraph) {
  const Outcome outcome = report({});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("written " + text("report.html")));
  EXPECT_THAT(read_file(path("report.html")), StartsWith("<!doctype html>\n<!-- quell report -->\n"));
  const Json report = data();
  EXPECT_THAT(images(report), ElementsAre("noisy color 1 2 3 4", "reference reference 1 2 3 4", "result color 1 2 3 4"));
  const Json& graph = report.find("graphs")->elements.at(0);
  EXPECT_EQ(graph.find("nodes")->elements.size(), 1U);
  EXPECT_EQ(graph.find("nodes")->elements[0].find("seconds")->elements.size(), 4U);
  EXPECT_EQ(graph.find("files")->elements.at(0).find("text")->string, read_file(graph_));
  EXPECT_EQ(graph.find("figures")->find("color")->find("frames")->elements.size(), 4U);
  EXPECT_EQ(report.find("noisy")->find("color")->find("frames")->elements.size(), 4U);
  EXPECT_EQ(report.find("provenance")->find("command")->elements.at(1).string, "report");
}

TEST_F(Report, IsNamedAfterItsFolderHoweverThatIsWritten) {
  for (const std::string& shot : {text("shot"), text("shot") + "/", text("shot") + "/."}) {
    ASSERT_EQ(run({"report", shot, graph_, "-o", text("report.html"), "--inner", "none"}).code, 0);
    EXPECT_EQ(data().find("title")->string, "graph on shot") << shot;
  }
}

TEST_F(Report, DescribesASequenceOnce) {
  write_file("same.json", read_file(graph_));
  const Outcome outcome = report({graph_, text("same.json")});
  const std::size_t first = outcome.err.find("color.####.exr");
  ASSERT_NE(first, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("color.####.exr", first + 1), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("same: 4 frames in "), std::string::npos) << outcome.err;
}

/// A `dot` that does something else beside its drawing, which comes after the run: in the middle of a report.
class ReportMeanwhile : public Report {
 protected:
  Outcome report_with_dot(const std::string& deed) {
    write_file("bin/dot", "#!/bin/sh\n" + deed + "\ncat > /dev/null\necho '<svg></svg>'\n");
    std::filesystem::permissions(path("bin/dot"), std::filesystem::perms::owner_all);
    return Program({"report", text("shot"), graph_, "-o", text("report.html"), "--plugin-path", TEST_PLUGINS}, false,
                   {"PATH=" + text("bin") + ":/usr/bin:/bin"})
        .finish();
  }
};

TEST_F(ReportMeanwhile, TheGraphMayBeChangedOrDeleted) {
  const std::string before = read_file(graph_);
  for (const std::string& deed : {"echo changed > " + graph_, "rm " + graph_}) {
    write_file("graph.json", before);
    const Outcome outcome = report_with_dot(deed);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(data().find("graphs")->elements.at(0).find("files")->elements.at(0).find("text")->string, before) << deed;
  }
}

TEST_F(ReportMeanwhile, ALateInterruptIsHeard) {
  const Outcome outcome = report_with_dot("kill -INT $PPID; sleep 0.2");
  EXPECT_EQ(outcome.code, 75) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("interrupted; no report was written"));
  EXPECT_FALSE(std::filesystem::exists(path("report.html")));
}

TEST_F(ReportMeanwhile, TheDrawingIsMadeInAGroupOfItsOwn) {
  const Outcome outcome = report_with_dot("read -r line < /proc/$$/stat; echo $line | cut -d' ' -f1,5 > " + text("group"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string group = read_file(path("group"));
  const std::size_t space = group.find(' ');
  EXPECT_EQ(group.substr(0, space) + "\n", group.substr(space + 1));
}

TEST_F(Report, KeepsEveryNthFrameAndComputesAll) {
  ASSERT_EQ(report({"--every", "3"}).code, 0);
  const Json report = data();
  EXPECT_THAT(images(report), ElementsAre("noisy color 1 4", "reference reference 1 4", "result color 1 4"));
  EXPECT_EQ(report.find("frames")->elements.size(), 4U);
  EXPECT_EQ(report.find("graphs")->elements[0].find("figures")->find("color")->find("frames")->elements.size(), 4U);
}

TEST_F(Report, KeepsInnerImagesOfOneFrameOrAllOrNone) {
  write_file("two.json", R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {
    "first": {"pass": "test_scale", "in": {"color": "color"}},
    "second": {"pass": "test_scale", "in": {"color": "first.color"}}}, "outputs": {"color": "second.color"}})");
  const auto inner = [&](const std::string& choice) {
    std::vector<std::string> more{text("two.json")};
    if (!choice.empty()) more.insert(more.end(), {"--inner", choice});
    EXPECT_EQ(report(more).code, 0);
    return images(data()).back();
  };
  EXPECT_EQ(inner(""), "inner first.color 4");
  EXPECT_EQ(inner("2"), "inner first.color 2");
  EXPECT_EQ(inner("all"), "inner first.color 1 2 3 4");
  EXPECT_EQ(inner("none"), "result color 1 2 3 4");
  const Outcome outcome = report({"--inner", "7"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--inner: frame 7 is not computed; the frames are 1-4"));
}

TEST_F(Report, KeepsWhatMeansReadOfTheFrameBeforeThoughItIsAResultToo) {
  write_file("past.json", R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {
    "blend": {"pass": "temporal_blend", "in": {"color": "color", "history": {"from": "color", "delay": 1, "initial": "none"}}}},
    "outputs": {"color": "blend.color", "as_it_came": "color"}})");
  ASSERT_EQ(report({text("past.json"), "--every", "3"}).code, 0);
  EXPECT_THAT(images(data()), ::testing::Contains("noisy color 1 3 4"));
}

TEST_F(Report, SetsParametersOfOneGraphByItsLabel) {
  const Outcome outcome = report({graph_, "twice=" + graph_, "--set", "twice:scale.gain=2"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json report = data();
  const auto gain = [&](std::size_t graph) {
    return report.find("graphs")->elements.at(graph).find("nodes")->elements.at(0).find("params")->find("gain")->string;
  };
  EXPECT_EQ(report.find("graphs")->elements.at(1).find("label")->string, "twice");
  EXPECT_EQ(gain(0), "1");
  EXPECT_EQ(gain(1), "2");
}

TEST_F(Report, GraphsOfOneNameAreNumbered) {
  ASSERT_EQ(report({graph_, graph_}).code, 0);
  const Json numbered = data();
  EXPECT_EQ(numbered.find("graphs")->elements.at(0).find("label")->string, "graph");
  EXPECT_EQ(numbered.find("graphs")->elements.at(1).find("label")->string, "graph 2");
  const Outcome outcome = report({"a=" + graph_, "a=" + graph_});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("two graphs have the label 'a'"));
}

TEST_F(Report, WarnsBeforeItBecomesLarge) {
  std::string nodes, from = "color";  // 2048 x 1024 pixels: 12.6 MB of halves a frame, of 4 frames and 2 graphs
  for (int i = 0; i < 7; ++i) {
    const std::string name = "double" + std::to_string(i);
    nodes += (i > 0 ? ", " : "") + ("\"" + name) + R"(": {"pass": "scale", "in": {"image": ")" + from +
             R"("}, "params": {"to": "double"}})";
    from = name + ".image";
  }
  write_file("large.json",
             R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {)" + nodes + R"(}, "outputs": {"color": ")" + from + "\"}}");
  const Outcome outcome = report({text("large.json"), text("large.json"), "--inner", "none", "--reference", "reference"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("MB, which browsers are slow to open; --every N keeps"));
  const std::size_t warned = outcome.err.find("the report will have about "), computed = outcome.err.find("large: 4 frames in ");
  ASSERT_NE(warned, std::string::npos) << outcome.err;
  EXPECT_LT(warned, computed) << outcome.err;
  const Outcome smaller = report({text("large.json"), text("large.json"), "--inner", "none", "--every", "2"});
  EXPECT_THAT(smaller.err, ::testing::Not(HasSubstr("browsers are slow")));
}

TEST_F(Report, ReplacesReportsAndNothingElse) {
  ASSERT_EQ(report({}).code, 0);
  EXPECT_EQ(report({}).code, 0);
  write_file("report.html", "<html>mine</html>");
  const Outcome outcome = report({});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("was not written by this option"));
  EXPECT_EQ(read_file(path("report.html")), "<html>mine</html>");
}

TEST_F(Report, NeedsItsFolderBeforeAnythingIsComputed) {
  const Outcome outcome = run({"report", text("shot"), graph_, "-o", text("nowhere/report.html")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: --out: there is no folder " + text("nowhere") + "; make it first\n");
}

TEST_F(Report, IsThereWithoutReferenceAndWithoutGraphviz) {
  make_shot(2);
  for (int frame = 1; frame <= 4; ++frame)
    std::filesystem::remove(path("shot") / ("reference.000" + std::to_string(frame) + ".exr"));
  const Outcome outcome = Program({"report", text("shot"), graph_, "-o", text("report.html"), "--plugin-path", TEST_PLUGINS},
                                  false, {"PATH=" + text("nowhere")})
                              .finish();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the report will have no drawing of the graph"));
  const Json report = data();
  EXPECT_EQ(report.find("metrics"), nullptr);
  EXPECT_THAT(report.find("graphs")->elements.at(0).find("noDrawing")->string, HasSubstr("is not in PATH"));
}

TEST_F(Report, AFailedFrameIsToldAndHasNoImage) {
  std::ofstream(path("shot/color.0002.exr")) << "no image";
  const Outcome outcome = report({});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(images(data()), ElementsAre("noisy color 1 3 4", "reference reference 1 2 3 4", "result color 1 3 4"));
}

TEST_F(Report, AReferenceThatCannotBeReadCostsItsFiguresAlone) {
  std::ofstream(path("shot/reference.0002.exr")) << "no image";
  const Outcome outcome = report({});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(images(data()), ElementsAre("noisy color 1 2 3 4", "reference reference 1 3 4", "result color 1 2 3 4"));
}

}  // namespace
}  // namespace quell::app::testing
