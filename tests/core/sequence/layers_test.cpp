// Which layer of a file is taken for an input: doubt, choice by the user, and what is told when nothing fits.
#include "quell/sequence/layers.h"

#include <cmath>

#include "quell/sequence/renderer_names.h"
#include "quell/sequence/sequence.h"
#include "tests/core/sequence/layout_rows.h"

namespace quell {
namespace {

using test::make_channels;
using test::message_of;
using test::values;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<FileChannel> channels(const std::vector<std::string>& names) {
  std::vector<FileChannel> result;
  for (const std::string& name : names) result.push_back({name});
  return result;
}

/// "Layer: channels" of every candidate.
std::vector<std::string> candidates(const std::vector<std::string>& names, const std::string& input, PortType type) {
  std::vector<std::string> result;
  for (const Selection& selection : recognize(channels(names), input, type)) {
    std::string text = selection.layer + ":";
    for (const int index : selection.channels) text += " " + names[static_cast<std::size_t>(index)];
    result.push_back(text);
  }
  return result;
}

TEST(Layers, AreChannelsWithEqualNamesUpToTheLastDot) {
  const auto layers = group_layers(channels({"R", "a.b.X", "Z", "a.b.Y", "a.Z"}));
  ASSERT_EQ(layers.size(), 3U);
  EXPECT_EQ(layers[0].name, "");
  EXPECT_THAT(layers[0].channels, ElementsAre(0, 2));
  EXPECT_EQ(layers[1].name, "a.b");
  EXPECT_THAT(layers[1].channels, ElementsAre(1, 3));
}

TEST(Layers, AlphaIsThatOfTheSameLayer) {
  const auto names = channels({"A", "b.R", "b.a", "c.R"});
  EXPECT_EQ(find_alpha(names, 1), 2);
  EXPECT_EQ(find_alpha(names, 3), std::nullopt);
}

TEST(Recognition, PatternsMatchTheEndOfANameInWholeParts) {
  EXPECT_TRUE(matches("Normal", "normal"));
  EXPECT_TRUE(matches("Normal", "View Layer.Normal"));
  EXPECT_FALSE(matches("Normal", "Denoising Normal"));
  EXPECT_FALSE(matches("Normal", "View.AbNormal"));
  EXPECT_TRUE(matches("*.Normal", "a.b.Normal"));
  EXPECT_FALSE(matches("*.Normal", "Normal"));
  EXPECT_TRUE(matches("", ""));
  EXPECT_FALSE(matches("", "a"));
}

TEST(Recognition, TheBestRankWinsAndEqualOnesAreAllTold) {
  EXPECT_THAT(candidates({"geo_normal.X", "geo_normal.Y", "geo_normal.Z", "sh_normal.X", "sh_normal.Y", "sh_normal.Z"}, "normal",
                         QUELL_TYPE_NORMAL),
              ElementsAre("sh_normal: sh_normal.X sh_normal.Y sh_normal.Z"));
  EXPECT_THAT(candidates({"a.Depth.Z", "b.Depth.Z"}, "depth", QUELL_TYPE_DEPTH),
              ElementsAre("a.Depth: a.Depth.Z", "b.Depth: b.Depth.Z"));
}

// As quell itself writes inner images beside a result.
TEST(Recognition, ALayerThatOnlyEndsInTheInputsNameIsWorseThanPlainChannelsAndTheWholeName) {
  EXPECT_THAT(candidates({"R", "G", "B", "filter.color.R", "filter.color.G", "filter.color.B"}, "color", QUELL_TYPE_COLOR),
              ElementsAre(": R G B"));
  EXPECT_THAT(candidates({"filter.albedo.R", "filter.albedo.G", "filter.albedo.B", "albedo.R", "albedo.G", "albedo.B"}, "albedo",
                         QUELL_TYPE_ALBEDO),
              ElementsAre("albedo: albedo.R albedo.G albedo.B"));
  EXPECT_THAT(candidates({"a.albedo.R", "a.albedo.G", "a.albedo.B", "b.albedo.R", "b.albedo.G", "b.albedo.B"}, "albedo",
                         QUELL_TYPE_ALBEDO),
              ElementsAre("a.albedo: a.albedo.R a.albedo.G a.albedo.B", "b.albedo: b.albedo.R b.albedo.G b.albedo.B"));
}

TEST(Recognition, AnInputOfAnotherNameIsServedByItsTypeButForColors) {
  EXPECT_THAT(candidates({"N.X", "N.Y", "N.Z"}, "surface", QUELL_TYPE_NORMAL), ElementsAre("N: N.X N.Y N.Z"));
  EXPECT_THAT(candidates({"R", "G", "B"}, "diffuse", QUELL_TYPE_COLOR), ElementsAre());
  EXPECT_THAT(candidates({"R", "G", "B", "diffuse.R", "diffuse.G", "diffuse.B"}, "diffuse", QUELL_TYPE_COLOR),
              ElementsAre("diffuse: diffuse.R diffuse.G diffuse.B"));
  EXPECT_THAT(candidates({"R", "G", "B"}, "reference", QUELL_TYPE_COLOR), ElementsAre());
}

TEST(Recognition, APlaneOfAVectorIsNoImageOfItsOwn) {
  EXPECT_THAT(candidates({"X", "Y", "Z"}, "depth", QUELL_TYPE_DEPTH), ElementsAre());
}

TEST(Recognition, EveryRowOfTheTableIsWellFormed) {
  for (const auto rows : {renderer_names(), renderer_file_names()})
    for (const RendererName& row : rows) {
      const std::string_view first = row.channels.substr(0, row.channels.find('|'));
      const auto planes = 1 + std::count(first.begin(), first.end(), ',');
      EXPECT_EQ(planes, info(row.type).channels) << row.renderer << " " << row.layer;
      EXPECT_FALSE(row.source.empty()) << row.renderer << " " << row.layer;
      EXPECT_FALSE(find_misplaced(row.conventions, row.type)) << row.renderer << " " << row.layer;
    }
}

class LayersOf : public testing::Test {
 protected:
  LayersOf() {
    std::vector<test::TwoPixels> all;
    for (const char* view : {"Vorn", "Hinten links, größer"})
      for (const char* channel : {".Combined.R", ".Combined.G", ".Combined.B", ".Normal.X", ".Normal.Y", ".Normal.Z", ".Depth.Z"})
        all.push_back({std::string(view) + channel, view[0] == 'V' ? 1.0 : 2.0, 0.0});
    make_channels(folder_ / "two.0001.exr", all);
  }
  std::string file() const { return (folder_ / "two.####.exr").string(); }
  std::unique_ptr<Sequence> open(const std::vector<std::string>& in, const std::string& sequence = "two.####.exr") {
    SequenceOptions options;
    options.in = in;
    return Sequence::open(sequence.empty() ? "" : folder_ / sequence, options);
  }
  std::vector<float> read(Sequence& sequence, const std::string& input) {
    BufferPool pool;
    return values(*sequence.read(input, 1, pool).image());
  }
  std::string error(const std::vector<std::string>& in, const std::string& input, const std::string& sequence = "two.####.exr") {
    return message_of(Fault::input, [&] { open(in, sequence)->shape(input); });
  }
  test::TempFolder folder_;
};

TEST_F(LayersOf, TwoViewLayersAreInDoubtAndTheMessageShowsHowToChoose) {
  EXPECT_THAT(error({}, "color"),
              HasSubstr("two.0001.exr: several layers could be the input 'color':\n"
                        "  Hinten links, größer.Combined.R,Hinten links, größer.Combined.G,Hinten links, größer.Combined.B  "
                        "(Blender)  choose it with --in 'color=" +
                        file() +
                        ":Hinten links, größer.Combined'\n"
                        "  Vorn.Combined.R,Vorn.Combined.G,Vorn.Combined.B  (Blender)  choose it with --in color=" +
                        file() + ":Vorn.Combined"));
  EXPECT_THAT(error({}, "depth"), HasSubstr("choose it with --in depth=" + file() + ":Vorn.Depth.Z"));
}

TEST_F(LayersOf, ALayerOrAChannelCanBeChosenByName) {
  EXPECT_THAT(read(*open({"color=" + file() + ":Hinten links, größer.Combined"}), "color"), ElementsAre(2, 0, 2, 0, 2, 0));
  EXPECT_THAT(read(*open({"depth=" + file() + ":Vorn.Depth.Z"}), "depth"), ElementsAre(1, 1e10F));
  EXPECT_THAT(read(*open({"n=" + file() + ":Vorn.Normal:type=normal:encoding=unsigned"}, ""), "n").size(), testing::Eq(6U));
  EXPECT_THAT(open({"color=" + file() + ":Vorn.Combined"})->describe(), HasSubstr("Vorn.Combined: R,G,B (Blender)"));
  EXPECT_THAT(open({"color=" + file() + ":Vorn.Combined"})->channels_read("color", 1),
              ElementsAre("Vorn.Combined.R", "Vorn.Combined.G", "Vorn.Combined.B"));
}

TEST_F(LayersOf, ASequenceFileCanChooseALayer) {
  test::make_text(folder_ / "sequence.json",
                  R"({"quell_sequence": 1, "inputs": {"normal": {"file": "two.####.exr", "layer": "Vorn.Normal"}}})");
  const float third = static_cast<float>(1 / std::sqrt(3.0));
  EXPECT_THAT(read(*open({}, "sequence.json"), "normal"), ElementsAre(third, 0, third, 0, third, 0));
}

TEST_F(LayersOf, AMisspeltLayerIsToldWithSuggestions) {
  const std::string misspelt = error({"color=" + file() + ":Vorn.Combinde"}, "color");
  EXPECT_THAT(misspelt, HasSubstr("two.0001.exr: there is no layer or channel 'Vorn.Combinde'; did you mean 'Vorn.Combined'"));
  EXPECT_THAT(misspelt, HasSubstr("; the file has the layers 'Hinten links, größer.Combined', "));
  EXPECT_THAT(misspelt, HasSubstr("'Vorn.Normal'"));
  EXPECT_THAT(error({"color=" + file() + ":Vorn.Depth.Z"}, "color"),
              HasSubstr("'Vorn.Depth.Z' is a single channel, but color needs 3"));
  EXPECT_THAT(error({"color=" + file() + ":Vorn.Depth"}, "color"),
              HasSubstr("the layer 'Vorn.Depth' has Z, but color needs 3 channels"));
}

TEST_F(LayersOf, AFileInWhichNothingIsRecognizedIsToldWithItsLayers) {
  make_channels(folder_ / "odd.0001.exr", {{"foo.p", 1, 1}, {"foo.q", 1, 1}, {"bar", 1, 1}});
  EXPECT_THAT(message_of(Fault::input, [&] { open({}, "odd.####.exr"); }),
              HasSubstr("odd.0001.exr: no input is recognized by the names of its layers:\n  without a layer, 1 channel\n  foo"));
  EXPECT_THAT(
      error({"normal=" + (folder_ / "odd.####.exr").string()}, "normal", ""),
      HasSubstr("nothing in this file is recognized as the input 'normal' (normal needs 3 channels (R,G,B or X,Y,Z)); it has:\n"
                "  without a layer  (bar)\n  foo  (p,q)\nname what to read, for example: --in normal="));
}

TEST_F(LayersOf, InputsOfAnyNameAreFoundOnceTheirTypeIsKnown) {
  make_channels(folder_ / "one.0001.exr", {{"R", 1, 1}, {"G", 1, 1}, {"B", 1, 1}, {"N.X", 0, 0}, {"N.Y", 1, 1}, {"N.Z", 0, 0}});
  const auto sequence = open({}, "one.####.exr");
  EXPECT_EQ(sequence->shape("surface"), std::nullopt);
  sequence->expect("surface", QUELL_TYPE_NORMAL);
  EXPECT_THAT(read(*sequence, "surface"), ElementsAre(0, 0, 1, 1, 0, 0));
  sequence->expect("thickness", QUELL_TYPE_SCALAR);
  EXPECT_EQ(sequence->shape("thickness"), std::nullopt);
}

TEST_F(LayersOf, ASingleFileIsItsFrameAlone) {
  make_channels(folder_ / "s.0007.exr", {{"R", 1, 1}, {"G", 1, 1}, {"B", 1, 1}});
  make_channels(folder_ / "s.0008.exr", {{"R", 1, 1}, {"G", 1, 1}, {"B", 1, 1}});
  EXPECT_THAT(open({}, "s.0007.exr")->frames({"color"}), ElementsAre(7));
  EXPECT_THAT(open({}, "s.####.exr")->frames({"color"}), ElementsAre(7, 8));
  make_channels(folder_ / "still.exr", {{"R", 1, 1}, {"G", 1, 1}, {"B", 1, 1}});
  const auto still = open({}, "still.exr");
  EXPECT_THAT(still->frames({"color"}), ElementsAre(1));
  BufferPool pool;
  EXPECT_THAT(message_of(Fault::input, [&] { still->read("color", 2, pool); }), HasSubstr("has no file for frame 2"));
}

TEST_F(LayersOf, TheCameraStandsBesideOrInTheHeader) {
  make_channels(folder_ / "s.0007.exr", {{"R", 1, 1}, {"G", 1, 1}, {"B", 1, 1}});
  test::make_turned_camera(folder_ / "camera.0007.json");
  const auto sequence = open({}, "s.####.exr");
  BufferPool pool;
  EXPECT_EQ(sequence->read("camera", 7, pool).camera()->camera().size, (Size{2, 1}));
  test::make_turned_camera(folder_ / "frame.0007.json");
  EXPECT_THAT(message_of(Fault::input,
                         [&] {
                           Sequence::open(folder_ / "s.####.exr", {.wanted = std::vector<std::string>{"color", "camera"}});
                         }),
              HasSubstr("several files could be the input 'camera':\n  camera.####.json\n  frame.####.json\nsay which"));
}

TEST_F(LayersOf, AFolderWithAMultiLayerFileIsRecognized) {
  test::TempFolder folder;
  make_channels(folder / "my render-01.0001.exr",
                {{"R", 1, 1}, {"G", 1, 1}, {"B", 1, 1}, {"Z", 5, 5}, {"N.X", 0, 0}, {"N.Y", 1, 1}, {"N.Z", 0, 0}});
  const auto sequence = Sequence::open(folder.path());
  EXPECT_THAT(sequence->describe(), HasSubstr(": files with several layers\n"));
  EXPECT_THAT(sequence->describe(), HasSubstr("  normal  my render-01.####.exr  frames 1  N: X,Y,Z (Arnold)"));
  EXPECT_THAT(read(*sequence, "depth"), ElementsAre(5, 5));
  make_channels(folder / "depth.0001.exr", {{"Y", 6, 6}});
  EXPECT_THAT(read(*Sequence::open(folder.path()), "depth"), ElementsAre(6, 6)) << "a file named after an input goes first";
}

TEST_F(LayersOf, OnePictureInSeveralFormatsIsTakenFromTheBest) {
  test::TempFolder folder;
  make_channels(folder / "color.0001.exr", {{"R", 1, 1}, {"G", 1, 1}, {"B", 1, 1}});
  test::make_text(folder / "color.0001.png", "");
  EXPECT_THAT(Sequence::open(folder.path())->describe(), HasSubstr("color.####.exr"));
}

}  // namespace
}  // namespace quell
