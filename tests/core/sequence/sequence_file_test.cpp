#include "quell/sequence/sequence_file.h"

#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

class SequenceFileText : public testing::Test {
 protected:
  SequenceFile read(const std::string& text) {
    test::make_text(folder_ / "s.json", text);
    return read_sequence_file(folder_ / "s.json");
  }
  /// The error's text without the folder's name.
  std::string error(const std::string& text) {
    std::string message = message_of(Fault::input, [&] { read(text); });
    const std::string path = folder_.path().string() + "/";
    for (std::size_t at = message.find(path); at != std::string::npos; at = message.find(path)) message.erase(at, path.size());
    return message;
  }
  std::string input_error(const std::string& input) { return error("{\"quell_sequence\": 1, \"inputs\": {" + input + "}}"); }
  test::TempFolder folder_;
};

TEST_F(SequenceFileText, AGraphIsCalledOne) {
  const std::string text = error(R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {}})");
  EXPECT_THAT(text, testing::StartsWith("s.json:1:1: error: this is a graph, not a sequence; a sequence is a folder of images"));
  EXPECT_THAT(text, testing::Not(HasSubstr("unknown key")));
}

TEST_F(SequenceFileText, ReadsEverything) {
  const SequenceFile file = read(R"({
    // comments and trailing commas are allowed
    "quell_sequence": 1, "name": "box", "doc": "A box.", "frames": "1-8x2",
    "inputs": {
      "color": "color_1spp.####.exr",
      "glow": {"file": "sub/g_%d.exr", "type": "color", "channels": ["r.R", "r.G", "r.B"], "doc": "what shines"},
      "id": {"file": "id.####.exr", "background": 0},
      "camera": {"file": "frame_%d.dat", "format": "json"},
    },
  })");
  EXPECT_EQ(file.name, "box");
  EXPECT_EQ(file.doc, "A box.");
  EXPECT_THAT(file.frames->frames(), ElementsAre(1, 3, 5, 7));
  ASSERT_EQ(file.inputs.size(), 4U);
  EXPECT_EQ(file.inputs.at("color").pattern.path(3), folder_ / "color_1spp.0003.exr");
  EXPECT_EQ(file.inputs.at("glow").pattern.path(3), folder_ / "sub/g_3.exr");
  EXPECT_EQ(file.inputs.at("glow").type, QUELL_TYPE_COLOR);
  EXPECT_THAT(file.inputs.at("glow").channels, ElementsAre("r.R", "r.G", "r.B"));
  EXPECT_EQ(file.inputs.at("id").conventions.background, 0);
  EXPECT_EQ(file.inputs.at("camera").camera, CameraFormat::json);
}

TEST_F(SequenceFileText, EveryMistakeIsToldAtItsPlace) {
  EXPECT_EQ(
      error("{\n"
            "  \"quell_sequence\": 2,\n"
            "  \"frames\": \"8-1\",\n"
            "  \"input\": {},\n"
            "  \"inputs\": {\"color\": \"color.exr\", \"id\": {\"fil\": 3}}\n"
            "}"),
      "s.json:2:21: error: expected 1, the only version of this format, found 2\n"
      "      \"quell_sequence\": 2,\n"
      "                        ^\n"
      "s.json:3:16: error: the range descends; write 1-8 (frames always run in ascending order)\n"
      "      \"frames\": \"8-1\",\n"
      "                   ^\n"
      "s.json:4:3: error: unknown key \"input\"; did you mean 'inputs'?; known here: 'quell_sequence', 'name', 'doc', 'frames' "
      "and "
      "'inputs'\n"
      "      \"input\": {},\n"
      "      ^\n"
      "s.json:5:24: error: the pattern has no frame number; write the frame number as %d, %04d or ####\n"
      "      \"inputs\": {\"color\": \"color.exr\", \"id\": {\"fil\": 3}}\n"
      "                           ^\n"
      "s.json:5:42: error: the key \"file\" is missing; write \"file\": \"id.####.exr\"\n"
      "      \"inputs\": {\"color\": \"color.exr\", \"id\": {\"fil\": 3}}\n"
      "                                             ^\n"
      "s.json:5:43: error: unknown key \"fil\"; did you mean 'file'?; known here: 'file', 'type', 'layer', 'channels', 'format', "
      "'doc', 'sign', 'unit', 'y', 'jitter', 'depth', 'space', 'encoding', 'background', 'alpha', 'transfer', 'vectors', "
      "'ndc' and 'w'\n"
      "      \"inputs\": {\"color\": \"color.exr\", \"id\": {\"fil\": 3}}\n"
      "                                              ^");
}

TEST_F(SequenceFileText, ReadsConventions) {
  const SequenceFile file = read(R"({"quell_sequence": 1, "inputs": {
    "motion": {"file": "mv.####.exr", "unit": "uv", "sign": "current-previous", "y": "up", "jitter": "included"},
    "n": {"file": "n.####.exr", "encoding": "unsigned", "type": "normal", "space": "camera"},
    "color": {"file": "c.####.png", "transfer": "linear"}}})");
  EXPECT_EQ(describe(file.inputs.at("motion").conventions), "sign=current-previous, unit=uv, y=up, jitter=included");
  EXPECT_EQ(describe(file.inputs.at("n").conventions), "space=camera, encoding=unsigned");
  EXPECT_EQ(describe(file.inputs.at("color").conventions), "transfer=linear");
}

TEST_F(SequenceFileText, ChecksConventions) {
  EXPECT_THAT(input_error("\"motion\": {\"file\": \"a_%d.exr\", \"unit\": \"pixel\"}"),
              HasSubstr("s.json:1:73: error: unit must be 'pixels', 'uv' or 'ndc', found 'pixel'; did you mean 'pixels'?"));
  EXPECT_THAT(input_error("\"motion\": {\"file\": \"a_%d.exr\", \"unit\": 1}"),
              HasSubstr("expected 'pixels', 'uv' or 'ndc', found 1"));
  EXPECT_THAT(input_error("\"depth\": {\"file\": \"a_%d.exr\", \"sign\": \"previous-current\"}"),
              HasSubstr("sign is a convention of motion, not of depth"));
  EXPECT_THAT(input_error("\"motion\": {\"file\": \"a_%d.exr\", \"sing\": \"x\"}"), HasSubstr("did you mean 'sign'?"));
}

TEST_F(SequenceFileText, RequiresVersionAndInputs) {
  EXPECT_THAT(error("{}"), HasSubstr("s.json:1:1: error: the key \"quell_sequence\" is missing; write \"quell_sequence\": 1"));
  EXPECT_THAT(error("{}"), HasSubstr("the key \"inputs\" is missing"));
  EXPECT_THAT(error("[]"), HasSubstr("expected an object with \"quell_sequence\": 1"));
  EXPECT_THAT(error("{\"quell_sequence\": \"1\", \"inputs\": []}"), HasSubstr("found \"1\""));
  EXPECT_THAT(error("{\"quell_sequence\": 1, \"inputs\": []}"), HasSubstr("expected an object: {\"color\""));
  EXPECT_THAT(error("{\"quell_sequence\": 1 \"inputs\": {}}"), HasSubstr("s.json:1:22: error"));
  EXPECT_THAT(error(""), HasSubstr("s.json"));
}

TEST_F(SequenceFileText, ChecksEachInput) {
  EXPECT_THAT(input_error("\"a b\": \"a_%d.exr\""), HasSubstr("an input's name has letters, digits and underscores"));
  EXPECT_THAT(input_error("\"a\": 5"), HasSubstr("expected a file pattern, or an object with \"file\", found 5"));
  EXPECT_THAT(input_error("\"a\": {\"file\": 5}"), HasSubstr("expected a file pattern such as"));
  EXPECT_THAT(input_error("\"a\": {\"file\": \"a_%d_%d.exr\"}"), HasSubstr("a second frame number"));
  EXPECT_THAT(input_error("\"a\": {\"file\": \"a_%d.exr\", \"type\": \"colr\"}"),
              HasSubstr("there is no type \"colr\"; did you mean 'color'?"));
  EXPECT_THAT(input_error("\"color\": {\"file\": \"a_%d.exr\", \"channels\": [\"R\"]}"),
              HasSubstr("color needs 3 channels, 1 are named"));
  EXPECT_THAT(input_error("\"color\": {\"file\": \"a_%d.exr\", \"channels\": \"RGB\"}"),
              HasSubstr("expected a list of channel names"));
  EXPECT_THAT(input_error("\"color\": {\"file\": \"a_%d.exr\", \"background\": 0}"),
              HasSubstr("background is a convention of id, not of color"));
  EXPECT_THAT(input_error("\"id\": {\"file\": \"a_%d.exr\", \"background\": 0.5}"), HasSubstr("expected an integer"));
  EXPECT_THAT(input_error("\"color\": {\"file\": \"a_%d.exr\", \"format\": \"mat\"}"), HasSubstr("only a camera has a format"));
  EXPECT_THAT(input_error("\"camera\": {\"file\": \"a_%d.mat\", \"format\": \"xml\"}"),
              HasSubstr("expected \"json\", \"mat\" or \"header\""));
  EXPECT_THAT(input_error("\"a\": \"a_%d.exr\", \"a\": \"b_%d.exr\""), HasSubstr("s.json:1:"));
}

TEST_F(SequenceFileText, MustBeThere) {
  EXPECT_THAT(message_of(Fault::input, [&] { read_sequence_file(folder_ / "none.json"); }), HasSubstr("none.json"));
}

}  // namespace
}  // namespace quell
