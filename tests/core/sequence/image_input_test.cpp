#include "quell/sequence/image_input.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "quell/sequence/convert.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::ExrContent;
using test::id_values;
using test::make_exr;
using test::message_of;
using test::values;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

class ImageInput : public testing::Test {
 protected:
  Image read(const ExrContent& content, const ImageRequest& request) {
    make_exr(folder_ / "a.exr", content);
    return read_image(folder_ / "a.exr", request, pool_, [&](const std::string& note) { notes_.push_back(note); });
  }
  std::string error(const ExrContent& content, const ImageRequest& request) {
    return message_of(Fault::input, [&] { read(content, request); });
  }
  std::string error_of_file(const std::string& name) {
    return message_of(Fault::input, [&] { read_image(folder_ / name, {QUELL_TYPE_COLOR}, pool_, [](const std::string&) {}); });
  }
  test::TempFolder folder_;
  BufferPool pool_;
  std::vector<std::string> notes_;
};

TEST_F(ImageInput, FindsPlanesByNameInAnyOrder) {
  EXPECT_THAT(values(read({.channels = {"R", "G", "B"}, .pixels = {1, 2, 3}}, {QUELL_TYPE_COLOR})), ElementsAre(1, 2, 3));
  EXPECT_THAT(values(read({.channels = {"B", "A", "R", "G"}, .pixels = {3, 9, 1, 2}}, {QUELL_TYPE_COLOR})), ElementsAre(1, 2, 3));
  EXPECT_THAT(values(read({.channels = {"Z", "X", "Y"}, .pixels = {3, 1, 2}}, {QUELL_TYPE_POSITION})), ElementsAre(1, 2, 3));
  EXPECT_THAT(values(read({.channels = {"r", "g", "b"}, .pixels = {1, 2, 3}}, {QUELL_TYPE_POSITION})), ElementsAre(1, 2, 3));
  EXPECT_THAT(values(read({.channels = {"Y", "X"}, .pixels = {2, 1}}, {QUELL_TYPE_MOTION})), ElementsAre(1, 2));
  EXPECT_THAT(values(read({.channels = {"anything"}, .pixels = {7}}, {QUELL_TYPE_DEPTH})), ElementsAre(7));
  EXPECT_THAT(values(read({.channels = {"R", "G", "B", "A"}, .pixels = {1, 2, 3, 4}}, {QUELL_TYPE_ALPHA})), ElementsAre(4));
  EXPECT_THAT(values(read({.channels = {"b.X", "a.X"}, .pixels = {1, 2}}, {QUELL_TYPE_SCALAR, {"b.X"}})), ElementsAre(1));
  EXPECT_THAT(values(read({.channels = {"A", "B", "C", "D"}, .pixels = {1, 2, 3, 4}}, {QUELL_TYPE_COLOR, {"D", "B", "B"}})),
              ElementsAre(4, 2, 2));
}

TEST_F(ImageInput, TellsTheChannelsFoundAndNeeded) {
  EXPECT_THAT(error({.channels = {"Y"}}, {QUELL_TYPE_COLOR}),
              HasSubstr("a.exr: found 1 channel (Y), but color needs 3 channels (R,G,B or X,Y,Z); name them with \"channels\""));
  EXPECT_THAT(error({.channels = {"X", "Y", "Z"}}, {QUELL_TYPE_DEPTH}),
              HasSubstr("found 3 channels (X,Y,Z), but depth needs 1 channel"));
  EXPECT_THAT(error({.channels = {"X", "Y", "Z"}}, {QUELL_TYPE_MOTION}), HasSubstr("motion needs 2 channels (X,Y, R,G or U,V)"));
  EXPECT_THAT(error({.channels = {"P", "Q", "S"}}, {QUELL_TYPE_COLOR}), HasSubstr("found 3 channels (P,Q,S)"));
  EXPECT_THAT(error({.channels = {"R", "G", "B"}}, {QUELL_TYPE_COLOR, {"R", "G"}}), HasSubstr("2 are named: R,G"));
  EXPECT_THAT(error({.channels = {"depth.Z", "a"}}, {QUELL_TYPE_DEPTH, {"dept.Z"}}),
              HasSubstr("there is no 'dept.Z'; did you mean 'depth.Z'?"));
}

TEST_F(ImageInput, KeepsHalfFloatAndUintValues) {
  const std::vector<double> numbers = {0, -1.5, 65504, 0.0999755859375};  // each is a half
  EXPECT_THAT(values(read({.width = 4, .pixels = numbers, .format = "half"}, {QUELL_TYPE_SCALAR})), ElementsAreArray(numbers));
  EXPECT_THAT(values(read({.width = 2, .pixels = {1e-30F, 3e38F}}, {QUELL_TYPE_SCALAR})), ElementsAre(1e-30F, 3e38F));
  EXPECT_THAT(values(read({.width = 2, .pixels = {3, 70000}, .format = "uint"}, {QUELL_TYPE_SCALAR})), ElementsAre(3, 70000))
      << "not scaled to 0..1";
}

TEST_F(ImageInput, PassesOnWhatIsNotFinite) {
  const auto got = values(read({.width = 3, .pixels = {NAN, kInfinity, -kInfinity}}, {QUELL_TYPE_SCALAR}));
  EXPECT_TRUE(std::isnan(got[0]));
  EXPECT_EQ(got[1], kInfinity);
  EXPECT_EQ(got[2], -kInfinity);
}

TEST_F(ImageInput, NormalsGetUnitLengthAndZeroStays) {
  const auto got = values(
      read({.width = 3, .channels = {"X", "Y", "Z"}, .pixels = {3, 0, 4, 0, 0, 0, 0.1F, -0.1F, 0.1F}}, {QUELL_TYPE_NORMAL}));
  const float third = static_cast<float>(1 / std::sqrt(3.0));
  EXPECT_THAT(got, ElementsAre(0.6F, 0, third, 0, 0, -third, 0.8F, 0, third));
}

TEST_F(ImageInput, DepthWithoutSurfaceIsExactly1e10) {
  const auto got =
      values(read({.width = 7, .pixels = {0, kInfinity, -kInfinity, 1e9F, 1e30F, 9.9e8F, 2.5F}}, {QUELL_TYPE_DEPTH}));
  EXPECT_THAT(got, ElementsAre(1e10F, 1e10F, 1e10F, 1e10F, 1e10F, 9.9e8F, 2.5F));
}

TEST_F(ImageInput, IdsAreIntegersAndTheBackgroundIsNoId) {
  const ExrContent content{.width = 4, .pixels = {-1, 0, 7, 16777216}};
  EXPECT_THAT(id_values(read(content, {QUELL_TYPE_ID})), ElementsAre(QUELL_NO_ID, 0, 7, 16777216));
  EXPECT_THAT(id_values(read(content, {QUELL_TYPE_ID, {}, {.background = -1}})), ElementsAre(QUELL_NO_ID, 0, 7, 16777216));
  EXPECT_THAT(id_values(read({.width = 3, .pixels = {0, 1, 30}, .format = "half"}, {QUELL_TYPE_ID, {}, {.background = 0}})),
              ElementsAre(QUELL_NO_ID, 1, 30));
  EXPECT_THAT(id_values(read({.width = 3, .pixels = {0, 1, 16777217}, .format = "uint"}, {QUELL_TYPE_ID, {}, {.background = 0}})),
              ElementsAre(QUELL_NO_ID, 1, 16777217))
      << "which no float can hold";
  EXPECT_THAT(id_values(read({.width = 2, .pixels = {0, 1}, .format = "uint"}, {QUELL_TYPE_ID})), ElementsAre(0, 1));
}

TEST_F(ImageInput, IdsThatAreNoIndexAreRefusedWithTheirPixel) {
  EXPECT_THAT(
      error({.width = 2, .height = 2, .pixels = {1, 2, 3, 1.5F}}, {QUELL_TYPE_ID}),
      HasSubstr("a.exr: pixel (1, 1) holds 1.5, which is no object index (an integer from 0, or a negative number for the "
                "background)"));
  EXPECT_THAT(error({.pixels = {-1}}, {QUELL_TYPE_ID, {}, {.background = 0}}),
              HasSubstr("pixel (0, 0) holds -1, which is no object index (an integer "
                        "from 0, or 0 for the background)"));
  EXPECT_THAT(error({.pixels = {NAN}}, {QUELL_TYPE_ID}), HasSubstr("holds nan"));
  EXPECT_THAT(error({.pixels = {4294967296.0F}}, {QUELL_TYPE_ID}), HasSubstr("holds 4.2949673e+09"));
}

// Rows of 200 pixels, 150 of them: more than one band of the reader, and tiles that do not divide the size.
TEST_F(ImageInput, LargeScanlineAndTiledFilesComeOutWhole) {
  ExrContent content{.width = 200, .height = 150, .channels = {"R", "G", "B"}};
  for (int i = 0; i < 200 * 150 * 3; ++i) content.pixels.push_back(i);
  for (const int tile : {0, 64, 33}) {
    content.tile = tile;
    const Image image = read(content, {QUELL_TYPE_COLOR});
    const FloatImage view = image.floats();
    for (int y = 0; y < 150; ++y)
      for (int x = 0; x < 200; ++x)
        for (int c = 0; c < 3; ++c) ASSERT_EQ(view.at(x, y, c), static_cast<float>((y * 200 + x) * 3 + c)) << tile;
  }
}

TEST_F(ImageInput, ADataWindowWithinTheImageIsFilledAndSaid) {
  const ExrContent content{.width = 2, .height = 1, .pixels = {5, 6}, .x = 1, .y = 1, .full_width = 4, .full_height = 3};
  EXPECT_THAT(values(read(content, {QUELL_TYPE_SCALAR})), ElementsAre(0, 0, 0, 0, 0, 5, 6, 0, 0, 0, 0, 0));
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_THAT(notes_[0], HasSubstr("the file's pixels cover 2 x 1 of 4 x 3; the rest is filled with nothing"));
  const float far = 1e10F;
  EXPECT_THAT(values(read(content, {QUELL_TYPE_DEPTH})), ElementsAre(far, far, far, far, far, 5, 6, far, far, far, far, far));
  const auto no = QUELL_NO_ID;
  EXPECT_THAT(id_values(read(content, {QUELL_TYPE_ID})), ElementsAre(no, no, no, no, no, 5, 6, no, no, no, no, no));
}

TEST_F(ImageInput, ADataWindowBeyondTheImageIsCropped) {
  ExrContent content{.width = 4, .height = 3, .x = -1, .y = -1, .full_width = 2, .full_height = 2};
  for (int i = 0; i < 12; ++i) content.pixels.push_back(i);
  for (const int tile : {0, 2}) {
    content.tile = tile;
    EXPECT_THAT(values(read(content, {QUELL_TYPE_SCALAR})), ElementsAre(5, 6, 9, 10)) << tile;
  }
  EXPECT_THAT(notes_.at(0), HasSubstr("reach beyond the image of 2 x 2 and are cropped"));
}

TEST_F(ImageInput, ADataWindowBesideTheImageLeavesItEmpty) {
  const ExrContent content{.width = 2, .height = 2, .pixels = {1, 2, 3, 4}, .x = 10, .y = 0, .full_width = 2, .full_height = 1};
  EXPECT_THAT(values(read(content, {QUELL_TYPE_SCALAR})), ElementsAre(0, 0));
}

TEST_F(ImageInput, SmallIntegersCannotBePlacesDistancesOrMotion) {
  OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeUInt8);
  const auto output = OIIO::ImageOutput::create("png");
  const std::uint8_t pixel[3] = {1, 2, 3};
  ASSERT_TRUE(output->open((folder_ / "a.png").string(), spec) && output->write_image(OIIO::TypeUInt8, pixel) && output->close());
  EXPECT_THAT(message_of(Fault::input, [&] { probe_image(folder_ / "a.png", {QUELL_TYPE_POSITION}); }),
              HasSubstr("a.png: holds 8 bit integers, which say 0 to 1 and cannot be position; give files of floats"));
}

TEST_F(ImageInput, ProbingReadsTheHeaderAlone) {
  make_exr(folder_ / "a.exr", {.width = 5, .height = 4, .channels = {"R", "G", "B"}});
  EXPECT_EQ(probe_image(folder_ / "a.exr", {QUELL_TYPE_COLOR}), (Size{5, 4}));
  EXPECT_THAT(message_of(Fault::input, [&] { probe_image(folder_ / "a.exr", {QUELL_TYPE_DEPTH}); }),
              HasSubstr("depth needs 1 channel"));
}

TEST_F(ImageInput, BrokenFilesAreRefusedWithTheReason) {
  make_exr(folder_ / "good.exr", {.width = 64, .height = 64, .channels = {"R", "G", "B"}});
  const std::string good = test::read_bytes(folder_ / "good.exr");
  test::make_text(folder_ / "empty.exr", "");
  test::make_text(folder_ / "text.exr", "this is no image");
  test::make_text(folder_ / "cut_header.exr", good.substr(0, 60));
  test::make_text(folder_ / "cut.exr", good.substr(0, good.size() - 40));
  std::filesystem::create_directory(folder_ / "folder.exr");
  EXPECT_THAT(error_of_file("none.exr"), HasSubstr("none.exr: no such file"));
  EXPECT_THAT(error_of_file("folder.exr"), HasSubstr("folder.exr: not a file"));
  EXPECT_THAT(error_of_file("empty.exr"), HasSubstr("empty.exr: the file is empty"));
  EXPECT_THAT(error_of_file("text.exr"),
              HasSubstr("text.exr: not an image of a known format; OpenEXR, PNG, TIFF, Radiance HDR and PFM are read"));
  EXPECT_THAT(error_of_file("cut_header.exr"), HasSubstr("cut_header.exr: cannot be read: "));
  EXPECT_THAT(error_of_file("cut.exr"), HasSubstr("cut.exr: truncated or damaged: "));
}

// Every place at which a file may have been cut gives an error, not a crash, and not an image.
TEST_F(ImageInput, AFileCutAnywhereIsRefused) {
  make_exr(folder_ / "good.exr", {.width = 20, .height = 40, .channels = {"R", "G", "B"}});
  const std::string good = test::read_bytes(folder_ / "good.exr");
  for (std::size_t length = 0; length < good.size(); length += 7) {
    test::make_text(folder_ / "cut.exr", good.substr(0, length));
    EXPECT_THAT(error_of_file("cut.exr"), HasSubstr("cut.exr: ")) << length;
  }
}

/// Sets the data and display windows' right and bottom edges in an EXR's header.
std::string with_window(std::string bytes, std::int32_t right, std::int32_t bottom) {
  for (const char* name : {"dataWindow", "displayWindow"}) {
    // name, 0, "box2i", 0, size 16, then xMin, yMin, xMax, yMax
    const std::size_t at = bytes.find(name) + std::string(name).size() + 1 + 6 + 4 + 8;
    std::memcpy(bytes.data() + at, &right, sizeof right);
    std::memcpy(bytes.data() + at + 4, &bottom, sizeof bottom);
  }
  return bytes;
}

TEST_F(ImageInput, HugeSizesInTheHeaderAreRefusedBeforeMemoryIsTaken) {
  make_exr(folder_ / "good.exr", {.width = 8, .height = 8, .channels = {"R", "G", "B"}});
  const std::string good = test::read_bytes(folder_ / "good.exr");
  test::make_text(folder_ / "wide.exr", with_window(good, 70000, 7));
  EXPECT_THAT(error_of_file("wide.exr"), HasSubstr("wide.exr: the header claims 70001 x 8 pixels"));
  for (const std::int32_t edge : {1 << 20, std::numeric_limits<std::int32_t>::max()}) {
    test::make_text(folder_ / "huge.exr", with_window(good, edge, edge));
    EXPECT_THAT(error_of_file("huge.exr"), HasSubstr("huge.exr: ")) << edge;
  }
  EXPECT_EQ(pool_.usage().allocated, 0U);
}

}  // namespace
}  // namespace quell
