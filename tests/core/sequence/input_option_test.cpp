#include "quell/sequence/input_spec.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

std::string error(const std::string& text) {
  return message_of(Fault::usage, [&] { parse_input_option(text); });
}

TEST(InputOption, NamesAnInputAndItsFiles) {
  const InputSpec spec = parse_input_option("color=render/beauty_%d.exr");
  EXPECT_EQ(spec.name, "color");
  EXPECT_EQ(spec.pattern.text(), "render/beauty_%d.exr");
  EXPECT_FALSE(spec.type || spec.conventions != Conventions{} || spec.camera);
  EXPECT_EQ(spec.usual_type(), QUELL_TYPE_COLOR);
}

TEST(InputOption, TakesSettings) {
  const InputSpec id = parse_input_option("id=ID_%d.exr:background=-1");
  EXPECT_EQ(id.pattern.name(), "ID_%d.exr");
  EXPECT_EQ(id.conventions.background, -1);
  const InputSpec layer = parse_input_option("n=m.####.exr:type=normal:channels=View Layer.N.X,V.Y,V.Z");
  EXPECT_EQ(layer.type, QUELL_TYPE_NORMAL);
  EXPECT_THAT(layer.channels, ElementsAre("View Layer.N.X", "V.Y", "V.Z"));
  EXPECT_EQ(parse_input_option("camera=c_%d.txt:format=mat").camera_format(), CameraFormat::mat);
}

TEST(InputOption, TakesConventionsInAnyOrder) {
  const InputSpec motion = parse_input_option("mv=a_%d.exr:unit=uv:sign=current-previous:type=motion:y=up");
  EXPECT_EQ(motion.type, QUELL_TYPE_MOTION);
  EXPECT_EQ(describe(motion.conventions), "sign=current-previous, unit=uv, y=up");
  EXPECT_EQ(describe(parse_input_option("camera=a_%d.exr:ndc=-1..1:y=up").conventions), "y=up, ndc=-1..1");
}

TEST(InputOption, ConventionsOfOtherTypesAreRefused) {
  EXPECT_THAT(error("color=a_%d.exr:unit=uv"), HasSubstr("unit is a convention of motion, not of color"));
  EXPECT_THAT(error("x=a_%d.exr:space=camera:type=depth"),
              HasSubstr("space is a convention of normal and position, not of depth"));
  EXPECT_EQ(error("x=a_%d.exr:space=camera"), "") << "the type is not known yet";
  EXPECT_THAT(error("depth=a_%d.exr:depth=rays"),
              HasSubstr("depth must be 'axis', 'ray' or 'reciprocal', found 'rays'; did you mean 'ray'?"));
}

TEST(InputOption, AColonInAFileNameIsNoSetting) {
  EXPECT_EQ(parse_input_option("color=a:b_%d.exr").pattern.name(), "a:b_%d.exr");
}

TEST(InputOption, MistakesAreToldWithAnExample) {
  EXPECT_EQ(error("beauty_%d.exr"),
            "--in beauty_%d.exr: an input is given as name=pattern; an example: --in id=ID_%d.exr:background=-1");
  EXPECT_THAT(error("=a_%d.exr"), HasSubstr("'' cannot be an input's name"));
  EXPECT_THAT(error("a b=a_%d.exr"), HasSubstr("'a b' cannot be an input's name"));
  EXPECT_THAT(error("id=a_%d.exr:backgruond=0"), HasSubstr("there is no setting 'backgruond'; did you mean 'background'?"));
  EXPECT_THAT(error("id=a_%d.exr:background=none"), HasSubstr("background must be an integer"));
  EXPECT_THAT(error("id=a_%d.exr:type=colour"), HasSubstr("there is no type 'colour'"));
  EXPECT_THAT(error("id=a_%d.exr:format=xml"), HasSubstr("it is json, mat or header"));
  EXPECT_THAT(error("id=a_%d.exr:channels=R,,B"), HasSubstr("a channel's name is empty"));
  EXPECT_THAT(error("color=beauty.exr"), HasSubstr("the pattern has no frame number"));
}

TEST(InputSpec, KnowsTheUsualTypeOfAName) {
  const auto type = [](const std::string& name) { return parse_input_option(name + "=x_%d.exr").usual_type(); };
  EXPECT_EQ(type("normal"), QUELL_TYPE_NORMAL);
  EXPECT_EQ(type("reference"), QUELL_TYPE_COLOR);
  EXPECT_EQ(type("emission"), QUELL_TYPE_COLOR);
  EXPECT_EQ(type("noisy"), QUELL_TYPE_COLOR);
  EXPECT_EQ(type("camera"), QUELL_TYPE_CAMERA);
  EXPECT_EQ(type("whatever"), std::nullopt);
}

TEST(InputSpec, TellsTheCameraFormatByTheExtension) {
  EXPECT_EQ(parse_input_option("camera=m_%d.mat").camera_format(), CameraFormat::mat);
  EXPECT_EQ(parse_input_option("camera=m_%d.json").camera_format(), CameraFormat::json);
  EXPECT_EQ(parse_input_option("camera=m_%d.exr").camera_format(), CameraFormat::header);
  EXPECT_EQ(parse_input_option("camera=m_%d.tif:format=header").camera_format(), CameraFormat::header);
  EXPECT_THAT(message_of(Fault::input, [] { parse_input_option("camera=m_%d.txt").camera_format(); }),
              HasSubstr("m_%d.txt: the camera's format is not told by the file name; state \"json\", \"mat\" or \"header\""));
}

}  // namespace
}  // namespace quell
