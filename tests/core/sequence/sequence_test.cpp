#include "quell/sequence/sequence.h"

#include <cstring>
#include <thread>

#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::make_exr;
using test::make_text;
using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SequenceOf : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void make_image(const std::string& name, std::vector<std::string> channels, float value) {
    make_exr(folder_ / name,
             {.width = 4, .height = 2, .channels = channels, .pixels = std::vector<double>(8 * channels.size(), value)});
  }
  void make_color(const std::string& name, float value = 1) { make_image(name, {"R", "G", "B"}, value); }
  std::unique_ptr<Sequence> open(const std::vector<std::string>& in = {}, const char* frames = nullptr) {
    SequenceOptions options{in, {}};
    if (frames) options.frames = FrameRange::parse(frames);
    return Sequence::open(folder_.path(), options);
  }
  Item read(const std::string& input, std::int64_t frame, Sequence& sequence) { return sequence.read(input, frame, pool_); }
  std::string read_error(const std::string& input, std::int64_t frame, Sequence& sequence) {
    return message_of(Fault::input, [&] { read(input, frame, sequence); });
  }
  test::TempFolder folder_;
  BufferPool pool_;
};

TEST_F(SequenceOf, AFolderServesItsInputs) {
  make_color("color.0001.exr", 0.5F);
  make_image("depth.0001.exr", {"Z"}, 3);
  const auto sequence = open();
  EXPECT_EQ(sequence->shape("color")->size, (Size{4, 2}));
  EXPECT_EQ(sequence->shape("color")->type, QUELL_TYPE_COLOR);
  EXPECT_EQ(sequence->shape("depth")->type, QUELL_TYPE_DEPTH);
  EXPECT_EQ(sequence->shape("normal"), std::nullopt);
  EXPECT_THAT(test::values(*read("depth", 1, *sequence).image()), testing::Each(3));
  EXPECT_EQ(sequence->padding(), 4);
}

TEST_F(SequenceOf, WhatWasRecognizedCanBePrinted) {
  make_color("beauty_0.exr");
  make_color("beauty_1.exr");
  make_image("depth_0.exr", {"Y"}, 1);
  EXPECT_EQ(open()->describe(), folder_.path().string() +
                                    ": GAMES202 course layout\n"
                                    "  color  beauty_%d.exr  frames 0-1\n"
                                    "  depth  depth_%d.exr   frames 0");
}

TEST_F(SequenceOf, FramesAreThoseOfAllRequiredInputs) {
  for (const char* frame : {"1", "2", "4", "5"}) make_color(std::string("color_") + frame + ".exr");
  for (const char* frame : {"2", "3", "4"}) make_image(std::string("depth_") + frame + ".exr", {"Z"}, 1);
  const auto sequence = open();
  EXPECT_THAT(sequence->frames({"color", "depth"}), ElementsAre(2, 4));
  EXPECT_THAT(sequence->frames({"color"}), ElementsAre(1, 2, 4, 5));
  EXPECT_THAT(open({}, "2-3")->frames({"color", "depth"}), ElementsAre(2, 3))
      << "frames asked for are run even when files are missing";
  ASSERT_EQ(sequence->inputs().size(), 2U);
  EXPECT_EQ(sequence->inputs()[1].input, "depth");
  EXPECT_EQ(sequence->inputs()[1].pattern, path("depth_%d.exr"));
  EXPECT_THAT(sequence->inputs()[1].frames, ElementsAre(2, 3, 4));
}

TEST_F(SequenceOf, ValuesComeFromNumbersListsAndWhatTheRunnerWrites) {
  for (const char* frame : {"1", "2", "3", "4"}) make_color(std::string("color_") + frame + ".exr");
  make_text(folder_ / "cut_1.json", "{\"frame\": 1, \"values\": [1]}\n");
  make_text(folder_ / "cut_2.json", "[0]");
  make_text(folder_ / "cut_3.json", "0.5");
  make_text(folder_ / "cut_4.json", "{\"value\": 1}");
  const auto sequence = open({"cut=" + path("cut_%d.json")});
  sequence->expect("cut", QUELL_TYPE_VALUE);
  EXPECT_EQ(sequence->shape("cut")->value_count, 1U);
  for (const auto& [frame, value] : {std::pair{1, 1.0}, {2, 0.0}, {3, 0.5}})
    EXPECT_EQ(*read("cut", frame, *sequence).values(), Values{value}) << frame;
  EXPECT_THAT(read_error("cut", 4, *sequence), testing::HasSubstr("1:1: error: the key \"values\" is missing"));
}

TEST_F(SequenceOf, AFrameMissingInTheMiddleIsNamed) {
  for (const char* frame : {"0001", "0003"}) make_color(std::string("color.") + frame + ".exr");
  for (const char* frame : {"0001", "0002", "0003"}) make_image(std::string("depth.") + frame + ".exr", {"Z"}, 1);
  const auto sequence = open();
  const auto missing = sequence->missing({"color", "depth"});
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_EQ(missing[0].input, "color");
  EXPECT_EQ(missing[0].frame, 2);
  EXPECT_EQ(missing[0].file, folder_ / "color.0002.exr");
  EXPECT_EQ(read_error("color", 2, *sequence),
            path("color.0002.exr") + ": the input 'color' has no file for frame 2; color.####.exr has frames 1,3");
  EXPECT_THAT(open({}, "3-4")->missing({"depth"}).at(0).file, folder_ / "depth.0004.exr");
  EXPECT_THAT(open({}, "1,3")->missing({"color", "depth"}), IsEmpty());
}

TEST_F(SequenceOf, OfMillionsOfMissingFramesTheFirstAreTold) {
  make_color("color.0001.exr");
  const auto missing = open({}, "0-9999999")->missing({"color"});
  ASSERT_EQ(missing.size(), Sequence::kMostMissing);
  EXPECT_EQ(missing[0].frame, 0);
  EXPECT_EQ(missing[1].frame, 2);
}

TEST_F(SequenceOf, AnInputThatIsNotThereIsToldWithWhatIs) {
  make_color("color.0001.exr");
  const auto sequence = open({"depth=" + path("z_%d.exr")});
  EXPECT_EQ(message_of(Fault::input, [&] { sequence->frames({"colour"}); }),
            folder_.path().string() +
                ": one file for each buffer: the sequence has no input 'colour'; did you mean 'color'?; it has "
                "'color' and 'depth'; add it with --in colour=PATTERN");
  EXPECT_THAT(message_of(Fault::input, [&] { sequence->frames({"depth"}); }),
              HasSubstr("z_%d.exr: there is no file of this name for the input 'depth' (--in depth="));
}

TEST_F(SequenceOf, AConventionThatTheGraphsTypeDoesNotHaveIsRefused) {
  make_image("flow.0001.exr", {"X", "Y"}, 0.5F);
  const std::string option = "flow=" + path("flow.####.exr") + ":unit=uv";
  const auto sequence = open({option});
  sequence->expect("flow", QUELL_TYPE_MOTION);
  EXPECT_THAT(test::values(*read("flow", 1, *sequence).image()),
              testing::UnorderedElementsAre(2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1));
  const auto other = open({option});
  other->expect("flow", QUELL_TYPE_MOMENTS);
  EXPECT_EQ(read_error("flow", 1, *other), "--in " + option + ": unit is a convention of motion, not of moments");
}

TEST_F(SequenceOf, WhatNeedsACameraNamesTheSequenceWithoutOne) {
  make_image("depth.0001.exr", {"Z"}, 3);
  EXPECT_THAT(read_error("depth", 1, *open({"depth=" + path("depth.####.exr") + ":depth=ray"})),
              HasSubstr("the sequence has no camera; add one with --in camera=PATTERN"));
}

TEST_F(SequenceOf, OptionsAddAndOverrideAndResolveAmbiguities) {
  make_color("beauty_1.exr", 1);
  make_color("color.0001.exr", 2);
  make_color("other_1.exr", 3);
  EXPECT_THAT(message_of(Fault::input, [&] { open(); }), HasSubstr("several files could be the input 'color'"));
  const auto chosen = open({"color=" + path("color.####.exr"), "albedo=" + path("other_%d.exr")});
  EXPECT_EQ(test::values(*read("color", 1, *chosen).image())[0], 2);
  EXPECT_EQ(test::values(*read("albedo", 1, *chosen).image())[0], 3);
  EXPECT_EQ(chosen->shape("albedo")->type, QUELL_TYPE_ALBEDO);
  const auto last = open({"color=" + path("color.####.exr"), "color=" + path("other_%d.exr")});
  EXPECT_EQ(test::values(*read("color", 1, *last).image())[0], 3) << "later options win";
}

TEST_F(SequenceOf, OptionsAloneAreASequence) {
  make_color("a_7.exr");
  const auto sequence = Sequence::open({}, {{"color=" + path("a_%d.exr")}, {}});
  EXPECT_THAT(sequence->frames({"color"}), ElementsAre(7));
  EXPECT_EQ(message_of(Fault::usage, [] { Sequence::open({}); }),
            "no sequence: name a folder or a sequence.json, or give inputs such as --in color=beauty_%d.exr");
}

TEST_F(SequenceOf, ASequenceFileInTheFolderIsUsed) {
  make_color("one_1.exr", 5);
  make_color("one_2.exr", 5);
  make_text(folder_ / "sequence.json",
            R"({"quell_sequence": 1, "name": "mine", "frames": "2-3", "inputs": {"color": "one_%d.exr"}})");
  const auto sequence = open();
  EXPECT_THAT(sequence->describe(), testing::StartsWith(path("sequence.json") + ": mine\n"));
  EXPECT_THAT(sequence->frames({"color"}), ElementsAre(2, 3));
  EXPECT_THAT(open({}, "1")->frames({"color"}), ElementsAre(1)) << "--frames wins";
  EXPECT_EQ(test::values(*read("color", 2, *Sequence::open(folder_ / "sequence.json")).image())[0], 5);
}

TEST_F(SequenceOf, WhatIsNoSequenceIsRefused) {
  make_color("a_1.exr");
  EXPECT_THAT(message_of(Fault::input, [&] { Sequence::open(folder_ / "none"); }), HasSubstr("none: no such folder or file"));
  test::make_text(folder_ / "a_1.txt", "no image");
  EXPECT_THAT(message_of(Fault::input, [&] { Sequence::open(folder_ / "a_1.txt"); }),
              HasSubstr("a_1.txt: not an image of a known format"));
  EXPECT_THAT(message_of(Fault::input, [&] { Sequence::open(folder_ / "b_#.exr"); }),
              HasSubstr("b_#.exr: there is no file of this name"));
  EXPECT_THAT(message_of(Fault::input, [&] { open({"color=" + path("none/a_%d.exr")}); }),
              HasSubstr("none: the folder cannot be read"));
}

TEST_F(SequenceOf, PaddingUnlikeTheDisksIsWarnedOf) {
  make_color("color.0001.exr");
  EXPECT_THAT(open()->warnings(), IsEmpty());
  const auto sequence = Sequence::open({}, {{"color=" + path("color.%d.exr")}, {}});
  EXPECT_THAT(
      sequence->warnings(),
      ElementsAre(path("color.%d.exr") + ": no file is named like this pattern of 'color'; the folder has color.0001.exr, where "
                                         "the pattern says color.1.exr (#### is a number of four digits, %d one without "
                                         "leading zeros)"));
}

TEST_F(SequenceOf, TheGraphsTypeDecidesTheConversion) {
  make_image("thing_1.exr", {"X", "Y", "Z"}, 2);
  const auto sequence = open();
  EXPECT_THAT(message_of(Fault::input, [&] { sequence->shape("thing"); }),
              HasSubstr("the type of the input 'thing' is not known; state it: --in thing=PATTERN:type=scalar"));
  sequence->expect("thing", QUELL_TYPE_NORMAL);
  sequence->expect("absent", QUELL_TYPE_NORMAL);
  EXPECT_EQ(sequence->shape("thing")->type, QUELL_TYPE_NORMAL);
  EXPECT_FLOAT_EQ(test::values(*read("thing", 1, *sequence).image())[0], 0.57735027F);
  const auto wrong = open();
  wrong->expect("thing", QUELL_TYPE_DEPTH);
  EXPECT_THAT(message_of(Fault::input, [&] { wrong->shape("thing"); }),
              HasSubstr("found 3 channels (X,Y,Z), but depth needs 1 channel"));
}

TEST_F(SequenceOf, AStatedTypeMustBeTheGraphs) {
  make_image("n_1.exr", {"X", "Y", "Z"}, 2);
  const auto sequence = Sequence::open({}, {{"n=" + path("n_%d.exr") + ":type=normal"}, {}});
  EXPECT_EQ(sequence->shape("n")->type, QUELL_TYPE_NORMAL);
  EXPECT_THAT(message_of(Fault::input, [&] { sequence->expect("n", QUELL_TYPE_COLOR); }),
              HasSubstr("the input 'n' is stated to be normal, but the graph wants color"));
}

TEST_F(SequenceOf, IdsBackgroundIsZeroBesideSidecarsAndNegativeElsewhere) {
  make_image("id.0001.exr", {"Y"}, 0);
  EXPECT_EQ(test::id_values(*read("id", 1, *open()).image())[0], 0U);
  make_text(folder_ / "frame.0001.json", test::sidecar_text(4, 2));
  EXPECT_EQ(test::id_values(*read("id", 1, *open()).image())[0], QUELL_NO_ID);
  EXPECT_EQ(test::id_values(*read("id", 1, *open({"id=" + path("id.####.exr")})).image())[0], QUELL_NO_ID);
  EXPECT_EQ(test::id_values(*read("id", 1, *open({"id=" + path("id.####.exr") + ":background=-1"})).image())[0], 0U);
  make_text(folder_ / "s.json", R"({"quell_sequence": 1, "inputs": {"id": "id.####.exr"}})");
  EXPECT_EQ(test::id_values(*read("id", 1, *Sequence::open(folder_ / "s.json")).image())[0], QUELL_NO_ID);
}

TEST_F(SequenceOf, CamerasComeFromBothFormats) {
  make_text(folder_ / "frame.0001.json",
            test::sidecar_text(640, 360, "\"3\": {\"object_to_world\": " + test::kIdentityText + "}"));
  const auto sidecar = open();
  EXPECT_EQ(sidecar->shape("camera")->type, QUELL_TYPE_CAMERA);
  const Item camera = read("camera", 1, *sidecar);
  EXPECT_EQ(camera.camera()->camera().size, (Size{640, 360}));
  EXPECT_TRUE(camera.camera()->camera().object_to_world.contains(3));

  std::string bytes(4 + 2 * 64, '\0');
  for (std::size_t i = 0; i < 8; ++i) {  // two identities
    const float one = 1;
    std::memcpy(bytes.data() + 4 + (i / 4) * 64 + (i % 4) * 20, &one, sizeof one);
  }
  make_text(folder_ / "m_1.mat", bytes);
  const auto alone = Sequence::open({}, {{"camera=" + path("m_%d.mat")}, {}});
  EXPECT_THAT(read_error("camera", 1, *alone), HasSubstr("does not tell the resolution, and the sequence has no image"));
  make_color("c_1.exr");
  const auto both = Sequence::open({}, {{"camera=" + path("m_%d.mat"), "color=" + path("c_%d.exr")}, {}});
  EXPECT_EQ(read("camera", 1, *both).camera()->camera().size, (Size{4, 2})) << "the images' size";
}

TEST_F(SequenceOf, WarningsOfReadingAreKeptOnce) {
  make_exr(folder_ / "color_1.exr", {.width = 2, .height = 1, .channels = {"R", "G", "B"}, .full_width = 4, .full_height = 2});
  const auto sequence = open();
  std::filesystem::copy_file(folder_ / "color_1.exr", folder_ / "color_2.exr");
  for (const int frame : {1, 1, 2}) read("color", frame, *sequence);
  EXPECT_THAT(sequence->warnings(), ElementsAre(HasSubstr("color_%d.exr: the file's pixels cover 2 x 1 of 4 x 2")));
}

TEST_F(SequenceOf, FramesMayBeReadFromSeveralThreads) {
  for (int frame = 0; frame < 8; ++frame) make_color("color_" + std::to_string(frame) + ".exr", static_cast<float>(frame));
  const auto sequence = open();
  std::vector<float> got(8);
  std::vector<std::jthread> threads;
  for (int frame = 0; frame < 8; ++frame)
    threads.emplace_back([&, frame] {
      sequence->shape("color");
      got[static_cast<std::size_t>(frame)] = test::values(*read("color", frame, *sequence).image())[0];
    });
  threads.clear();
  EXPECT_THAT(got, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
}

}  // namespace
}  // namespace quell
