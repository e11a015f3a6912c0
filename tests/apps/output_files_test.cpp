// What the files of a run hold besides the results: layers, channels that are kept, attributes.
#include <gmock/gmock.h>

#include "quell/sequence/image_file.h"
#include "tests/apps/sample.h"
#include "tests/core/sequence/test_files.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;

class OutputFiles : public RunnerTest {
 protected:
  /// Frames 1..count of R,G,B,A and an object index, 16 x 8, in one file each.
  void make_rich_shot(int count) {
    std::filesystem::create_directories(path("shot"));
    for (int frame = 1; frame <= count; ++frame) {
      test::ExrContent content{.width = 16, .height = 8, .channels = {"R", "G", "B", "A", "mask.Y"}, .pixels = {}};
      for (int i = 0; i < 16 * 8 * 5; ++i) content.pixels.push_back(0.25 * frame + 0.001 * i);
      test::make_exr(path("shot/color." + std::string("000") + std::to_string(frame) + ".exr"), content);
    }
  }
  std::string make_two(const std::string& first = "test_scale", const std::string& params = "{}") {
    write_file("two.json", R"({ "quell": 1, "name": "two", "inputs": { "color": "color" },
  "nodes": { "first": { "pass": ")" +
                               first + R"(", "in": { "color": "color" }, "params": )" + params + R"( },
             "second": { "pass": "test_scale", "in": { "color": "color" } } },
  "outputs": { "half": "first.color", "color": "second.color" } })");
    return text("two.json");
  }
  std::vector<std::string> channels(const std::string& file) const {
    std::vector<std::string> names;
    const ImageFile image(path(file));
    for (const FileChannel& channel : image.channels()) names.push_back(channel.name);
    return names;
  }
  std::string attribute(const std::string& file, const std::string& name) const {
    for (const ImageFile::Attribute& attribute : ImageFile(path(file)).attributes())
      if (attribute.name == name) return attribute.text;
    return "no " + name;
  }
  std::vector<float> plane(const std::string& file, const std::string& channel) const {
    ImageFile image(path(file));
    const std::vector<std::string> names = channels(file);
    const auto place = std::find(names.begin(), names.end(), channel) - names.begin();
    const Rectangle window = image.display_window();
    std::vector<float> values(static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height));
    image.read({static_cast<int>(place)}, window, FloatOutput{window.width, window.height, 1, window.width, 0, values.data()});
    return values;
  }
};

TEST_F(OutputFiles, CanBeOneAFrameWithLayers) {
  make_shot(2);
  const Outcome outcome = run({"run", make_two(), text("shot"), "-o", text("out"), "--layers", "beauty", "--dump", "color"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(list("out"), ElementsAre("beauty.0001.exr", "beauty.0002.exr"));
  EXPECT_THAT(outcome.err, HasSubstr("frames 1-2\n"));
  EXPECT_THAT(outcome.err, HasSubstr("/beauty.####.exr  frames 1-2\n"));
  EXPECT_THAT(channels("out/beauty.0002.exr"),
              ElementsAre("R", "G", "B", "half.R", "half.G", "half.B", "input.color.R", "input.color.G", "input.color.B"));
}

TEST_F(OutputFiles, WithLayersAreReadAgain) {
  make_shot(2);
  EXPECT_EQ(run({"run", make_two(), text("shot"), "-o", text("out"), "--layers", "beauty", "-q", "--set", "first.gain=3"}).code,
            0);
  const std::string in = "color=" + text("out/beauty.####.exr");
  const Outcome check = run({"check", make_graph(), "--in", in});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_EQ(run({"run", make_graph(), "--in", in, "-o", text("again"), "-q"}).code, 0);
  for (const char* name : {"R", "G", "B"})
    EXPECT_EQ(plane("again/color.0002.exr", name), plane("shot/color.0002.exr", name)) << "the plain names are color";
}

TEST_F(OutputFiles, AreNotThereForAFrameThatFailed) {
  make_shot(3);
  const std::string graph = make_two("test_scale", R"({ "at": [2] })");
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("out"), "--layers", "beauty", "-q"}).code, 1);
  EXPECT_THAT(list("out"), ElementsAre("beauty.0001.exr", "beauty.0003.exr"));
}

TEST_F(OutputFiles, TellSizesThatNoFileCanHoldBeforeTheRun) {
  make_shot(1);
  const std::string graph = make_two("test_halve");
  const Outcome layers = run({"run", graph, text("shot"), "-o", text("out"), "--layers", "beauty", "-q"});
  EXPECT_EQ(layers.code, 2);
  EXPECT_EQ(layers.err,
            "error: --layers: the layers of a file have one size, but 'half' has 8 x 4 pixels and 'color' 16 x 8 pixels; leave "
            "--layers out\n");
  write_file("one.json", R"({ "quell": 1, "inputs": { "color": "color" },
  "nodes": { "halve": { "pass": "test_halve", "in": { "color": "color" } } }, "outputs": { "color": "halve.color" } })");
  const Outcome kept = run({"run", text("one.json"), text("shot"), "-o", text("out"), "--keep-channels", "-q"});
  EXPECT_EQ(kept.code, 2);
  EXPECT_EQ(kept.err,
            "error: --keep-channels: the output 'color' has 8 x 4 pixels, but the channels of the input 'color' have 16 x 8 "
            "pixels; leave --keep-channels out\n");
  EXPECT_THAT(list("out"), IsEmpty());
  EXPECT_EQ(run({"run", text("one.json"), text("shot"), "-o", text("out"), "-q"}).code, 0);
}

TEST_F(OutputFiles, KeepWhatTheGraphDoesNotRead) {
  make_rich_shot(2);
  const std::string graph = make_two();
  const std::string in = "color=" + text("shot/color.####.exr") + ":channels=R,G,B";
  const Outcome outcome = run({"run", graph, "--in", in, "-o", text("out"), "--keep-channels"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("kept as they are: A, mask.Y\n"));
  EXPECT_THAT(channels("out/color.0002.exr"), ElementsAre("R", "G", "B", "A", "mask.Y"));
  EXPECT_THAT(channels("out/half.0002.exr"), ElementsAre("R", "G", "B")) << "they go to the main output alone";
  for (const char* name : {"A", "mask.Y"})
    EXPECT_EQ(plane("out/color.0002.exr", name), plane("shot/color.0002.exr", name)) << name;
  EXPECT_EQ(run({"run", graph, "--in", in, "-o", text("plain"), "-q"}).code, 0);
  EXPECT_THAT(channels("plain/color.0002.exr"), ElementsAre("R", "G", "B"));
}

TEST_F(OutputFiles, AreTheSameForAnyNumberOfThreads) {
  make_rich_shot(6);
  const std::string in = "color=" + text("shot/color.####.exr") + ":channels=R,G,B";
  for (const char* threads : {"1", "4"})
    EXPECT_EQ(run({"run", make_two(), "--in", in, "-o", text(threads), "--threads", threads, "--layers", "all", "--keep-channels",
                   "-q"})
                  .code,
              0);
  EXPECT_EQ(contents("1").size(), 6U);
  EXPECT_EQ(contents("1"), contents("4"));
}

TEST_F(OutputFiles, SayThatThereIsNothingToKeep) {
  make_shot(1);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "--keep-channels", "-q"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "warning: --keep-channels: there is no channel that the graph does not read\n");
}

TEST_F(OutputFiles, TellWhichGraphMadeThem) {
  make_rich_shot(1);
  const std::string in = "color=" + text("shot/color.####.exr") + ":channels=R,G,B";
  const auto hash_with = [&](const std::string& gain) {
    EXPECT_EQ(run({"run", make_graph(), "--in", in, "-o", text("out"), "-q", "--set", "scale.gain=" + gain, "--log-json",
                   text("log.jsonl")})
                  .code,
              0);
    return attribute("out/color.0001.exr", "quell:graph_hash");
  };
  const std::string hash = hash_with("2");
  EXPECT_THAT(hash, MatchesRegex("[0-9a-f]{32}"));
  EXPECT_THAT(read_file(path("log.jsonl")), HasSubstr("\"graph_hash\":\"" + hash + "\""));
  EXPECT_THAT(run({"graph", make_graph(), "--set", "scale.gain=2"}).out, ::testing::EndsWith("\nhash\n  " + hash + "\n"));
  EXPECT_THAT(run({"graph", make_graph()}).out, Not(HasSubstr(hash)));
  EXPECT_NE(hash_with("3"), hash);
  EXPECT_EQ(attribute("out/color.0001.exr", "Software"), std::string("quell ") + QUELL_VERSION);
  EXPECT_EQ(attribute("out/color.0001.exr", "quell:version"), QUELL_VERSION);
  EXPECT_EQ(attribute("out/color.0001.exr", "quell:graph"), "small");
  EXPECT_EQ(attribute("out/color.0001.exr", "quell:frame"), "1");
  EXPECT_EQ(attribute("out/color.0001.exr", "DateTime"), attribute("shot/color.0001.exr", "DateTime"));
}

TEST_F(OutputFiles, NeedNamesForLayers) {
  make_shot(1);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "--layers", "", "-q"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: --layers: the name is empty; write one such as 'beauty'\n");
}

}  // namespace
}  // namespace quell::app::testing
