#include "quell/sequence/image_file.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

#include "tests/core/sequence/test_files.h"

#ifdef __SANITIZE_ADDRESS__
// libpng leaves OpenImageIO's reader of a cut PNG by longjmp, past the destructor of the message that the reader has just
// fetched.
extern "C" const char* __lsan_default_suppressions() { return "leak:ImageInput::geterror"; }
#endif

namespace quell {
namespace {

using test::ExrContent;
using test::make_exr;
using test::make_parts;
using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

class ImageFileOf : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name = "a.exr") const { return folder_ / name; }

  std::vector<std::string> names(const std::string& name = "a.exr") {
    const ImageFile file(path(name));
    std::vector<std::string> result;
    for (const FileChannel& channel : file.channels()) result.push_back(channel.name);
    return result;
  }
  /// Some channels by name, in a window, planes one after the other.
  std::vector<float> read(const std::vector<std::string>& wanted, const Rectangle& window, const std::string& name = "a.exr") {
    ImageFile file(path(name));
    const std::vector<std::string> all = names(name);
    std::vector<int> selected;
    for (const std::string& each : wanted)
      selected.push_back(static_cast<int>(std::find(all.begin(), all.end(), each) - all.begin()));
    const PortType type = wanted.size() == 1 ? QUELL_TYPE_SCALAR : wanted.size() == 2 ? QUELL_TYPE_MOTION : QUELL_TYPE_COLOR;
    Image image(type, {window.width, window.height}, pool_);
    file.read(selected, window, image.writable_floats());
    return test::values(image);
  }
  std::string error(const std::string& name) {
    return message_of(Fault::input, [&] {
      ImageFile file(path(name));
      Image image(QUELL_TYPE_SCALAR, {file.display_window().width, file.display_window().height}, pool_);
      file.read({0}, file.display_window(), image.writable_floats());
    });
  }
  template <class Value>
  void write(const std::string& name, const char* format, int channels, const std::vector<Value>& pixels, int height = 1,
             int orientation = 1) {
    OIIO::ImageSpec spec(static_cast<int>(pixels.size()) / channels / height, height, channels,
                         OIIO::BaseTypeFromC<Value>::value);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (orientation != 1) spec.attribute("Orientation", orientation);
    const auto output = OIIO::ImageOutput::create(format);
    ASSERT_TRUE(output->open(path(name).string(), spec) &&
                output->write_image(OIIO::BaseTypeFromC<Value>::value, pixels.data()) && output->close())
        << output->geterror();
  }

  test::TempFolder folder_;
  BufferPool pool_;
};

TEST_F(ImageFileOf, PartsAreOneListOfChannelsWithTheirPartsNames) {
  make_parts(path(), {{.channels = {"R", "G", "B"}, .pixels = {1, 2, 3}, .format = "half", .part = "rgba"},
                      {.channels = {"Tiefe.Z"}, .pixels = {4}, .part = "Tiefe"},
                      {.channels = {"Y"}, .pixels = {5}, .format = "uint", .part = "Größe der Fläche"}});
  EXPECT_THAT(names(), ElementsAre("rgba.R", "rgba.G", "rgba.B", "Tiefe.Z", "Größe der Fläche.Y"));
  const ImageFile file(path());
  EXPECT_EQ(file.channels()[0].numbers, Numbers::half);
  EXPECT_EQ(file.channels()[3].numbers, Numbers::single);
  EXPECT_EQ(file.channels()[4].numbers, Numbers::uint32);
  EXPECT_THAT(read({"Größe der Fläche.Y", "rgba.G", "Tiefe.Z"}, {0, 0, 1, 1}), ElementsAre(5, 2, 4)) << "across parts";
}

TEST_F(ImageFileOf, PartsHaveDataWindowsOfTheirOwn) {
  make_parts(path(), {{.width = 2,
                       .height = 1,
                       .channels = {"A"},
                       .pixels = {1, 2},
                       .x = 1,
                       .y = 0,
                       .full_width = 3,
                       .full_height = 2,
                       .part = "a"},
                      {.width = 5,
                       .height = 1,
                       .channels = {"A"},
                       .pixels = {3, 4, 5, 6, 7},
                       .x = -1,
                       .y = 1,
                       .full_width = 3,
                       .full_height = 2,
                       .part = "b"}});
  const ImageFile file(path());
  EXPECT_EQ(file.display_window(), (Rectangle{0, 0, 3, 2}));
  EXPECT_EQ(file.data_window(0), (Rectangle{1, 0, 2, 1}));
  EXPECT_EQ(file.data_window(1), (Rectangle{-1, 1, 5, 1}));
  EXPECT_THAT(read({"a.A", "b.A"}, {0, 0, 3, 2}), ElementsAre(0, 1, 2, 0, 0, 0, 0, 0, 0, 4, 5, 6));
  EXPECT_THAT(read({"b.A"}, {-2, 1, 7, 1}), ElementsAre(0, 3, 4, 5, 6, 7, 0)) << "what the display window does not show";
}

TEST_F(ImageFileOf, TiledPartsAreRead) {
  ExrContent first{.width = 70, .height = 50, .channels = {"Y"}, .format = "half", .tile = 32, .part = "a"};
  ExrContent second{.width = 70, .height = 50, .channels = {"Y"}, .tile = 16, .part = "b"};
  for (int i = 0; i < 70 * 50; ++i) first.pixels.push_back(i % 1000), second.pixels.push_back(-i);
  make_parts(path(), {first, second});
  const auto got = read({"a.Y", "b.Y"}, {30, 15, 40, 20});
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) {
      const int i = (15 + y) * 70 + 30 + x;
      ASSERT_EQ(got[static_cast<std::size_t>(y * 40 + x)], static_cast<float>(i % 1000)) << x << "," << y;
      ASSERT_EQ(got[static_cast<std::size_t>(800 + y * 40 + x)], static_cast<float>(-i)) << x << "," << y;
    }
}

TEST_F(ImageFileOf, AnyWindowOfScanLinesAndTilesComesOutAsItIs) {
  ExrContent content{.width = 90, .height = 150, .channels = {"a", "b"}, .x = -3, .y = 5, .full_width = 80, .full_height = 140};
  for (int i = 0; i < 90 * 150; ++i) content.pixels.push_back(i), content.pixels.push_back(i + 0.5);
  for (const int tile : {0, 32, 33})
    for (const Rectangle window :
         {Rectangle{0, 0, 80, 140}, {-10, -10, 20, 30}, {60, 140, 40, 30}, {7, 70, 1, 1}, {200, 0, 5, 5}}) {
      content.tile = tile;
      make_exr(path(), content);
      const auto got = read({"b"}, window);
      for (int y = 0; y < window.height; ++y)
        for (int x = 0; x < window.width; ++x) {
          const int column = window.x + x + 3, row = window.y + y - 5;
          const bool inside = column >= 0 && column < 90 && row >= 0 && row < 150;
          ASSERT_EQ(got[static_cast<std::size_t>(y * window.width + x)],
                    inside ? static_cast<float>(row * 90 + column) + 0.5F : 0.0F)
              << "tiles of " << tile << ", window at " << window.x << "," << window.y << ", pixel " << x << "," << y;
        }
    }
}

TEST_F(ImageFileOf, FormatsMayBeMixedInAPart) {
  OIIO::ImageSpec spec(2, 1, 4, OIIO::TypeFloat);
  spec.channelnames = {"p", "q", "s", "t"};
  spec.channelformats = {OIIO::TypeHalf, OIIO::TypeUInt32, OIIO::TypeFloat, OIIO::TypeHalf};
  struct __attribute__((packed)) Pixel {
    std::uint16_t a;
    std::uint32_t b;
    float c;
    std::uint16_t d;
  };
  const Pixel pixels[2] = {{0x3C00, 4000000000U, 1e-30F, 0x4000}, {0, 7, 3, 0}};  // halves 1 and 2
  const auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output->open(path().string(), spec) && output->write_image(OIIO::TypeUnknown, pixels) && output->close());
  EXPECT_THAT(read({"t", "q", "p"}, {0, 0, 2, 1}), ElementsAre(2, 0, 4000000000.0F, 7, 1, 0));
  EXPECT_THAT(read({"s"}, {0, 0, 2, 1}), ElementsAre(1e-30F, 3));
  ImageFile file(path());
  Image ids(QUELL_TYPE_ID, {2, 1}, pool_);
  file.read(1, {0, 0, 2, 1}, ids.writable_ids());
  EXPECT_THAT(test::id_values(ids), ElementsAre(4000000000U, 7U)) << "which no float can hold";
}

TEST_F(ImageFileOf, IntegersBecomeZeroToOneAndAlphaStaysApart) {
  write<std::uint8_t>("a.png", "png", 4, {255, 51, 0, 51});
  EXPECT_THAT(read({"R", "G", "A"}, {0, 0, 1, 1}, "a.png"), ElementsAre(1, 0.2F, 0.2F)) << "not multiplied with alpha";
  write<std::uint16_t>("b.png", "png", 2, {65535, 13107});
  EXPECT_THAT(read({"Y", "A"}, {0, 0, 1, 1}, "b.png"), ElementsAre(1, 0.2F));
  write<std::uint8_t>("c.tif", "tiff", 4, {255, 51, 0, 51});
  EXPECT_THAT(read({"R", "G", "A"}, {0, 0, 1, 1}, "c.tif"), ElementsAre(1, 0.2F, 0.2F));
  write<std::uint32_t>("d.tif", "tiff", 1, {70000, 3});
  EXPECT_THAT(read({"Y"}, {0, 0, 2, 1}, "d.tif"), ElementsAre(70000, 3));
  write<float>("e.tif", "tiff", 1, {-1.5F, 1e20F});
  EXPECT_THAT(read({"Y"}, {0, 0, 2, 1}, "e.tif"), ElementsAre(-1.5F, 1e20F));
  EXPECT_EQ(ImageFile(path("a.png")).format(), "png");
  EXPECT_EQ(ImageFile(path("e.tif")).format(), "tiff");
}

TEST_F(ImageFileOf, PfmIsReadTheRightWayUpInBothByteOrders) {
  for (const bool big : {false, true}) {
    std::ofstream file(path("a.pfm"), std::ios::binary);
    file << "PF\n1 3\n" << (big ? "1.0" : "-1.0") << "\n";
    for (int i = 0; i < 9; ++i) {
      const float value = static_cast<float>(i) + 0.5F;
      char bytes[4];
      std::memcpy(bytes, &value, 4);
      if (big) std::swap(bytes[0], bytes[3]), std::swap(bytes[1], bytes[2]);
      file.write(bytes, 4);
    }
    file.close();
    EXPECT_THAT(read({"R", "G", "B"}, {0, 0, 1, 3}, "a.pfm"), ElementsAre(6.5, 3.5, 0.5, 7.5, 4.5, 1.5, 8.5, 5.5, 2.5))
        << "the last row of the file is the top one";
    EXPECT_THAT(read({"G"}, {0, 1, 1, 2}, "a.pfm"), ElementsAre(4.5, 1.5));
  }
}

TEST_F(ImageFileOf, HdrIsLinearRadiance) {
  write<float>("a.hdr", "hdr", 3, {1, 2, 4, 0.5F, 0.25F, 0});
  EXPECT_THAT(read({"R", "G", "B"}, {0, 0, 2, 1}, "a.hdr"), ElementsAre(1, 0.5F, 2, 0.25F, 4, 0));
}

TEST_F(ImageFileOf, TheFormatIsToldByTheFirstBytesAlone) {
  make_exr(path("a.png"), {.pixels = {3}});
  EXPECT_EQ(ImageFile(path("a.png")).format(), "openexr");
  test::make_text(path("a.jpg"), "\xFF\xD8\xFF\xE0");
  EXPECT_THAT(error("a.jpg"),
              HasSubstr("a.jpg: not an image of a known format; OpenEXR, PNG, TIFF, Radiance HDR and PFM are read"));
}

TEST_F(ImageFileOf, TurnedPicturesAreRefused) {
  write<std::uint8_t>("a.tif", "tiff", 1, {1, 2}, 1, 6);
  EXPECT_THAT(error("a.tif"), HasSubstr("a.tif: the picture is stored turned or mirrored (orientation 6)"));
}

TEST_F(ImageFileOf, SignedIntegersAreRefused) {
  write<std::int16_t>("a.tif", "tiff", 1, {1, 2});
  EXPECT_THAT(error("a.tif"), HasSubstr("a.tif: the channel 'Y' holds numbers of type int16; half, float and unsigned integers"));
}

TEST_F(ImageFileOf, DeepImagesAreRefused) {
  OIIO::ImageSpec spec(2, 1, 2, OIIO::TypeFloat);
  spec.channelnames = {"A", "Z"};
  spec.deep = true;
  OIIO::DeepData deep;
  deep.init(spec);
  const auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output->open(path().string(), spec) && output->write_deep_image(deep) && output->close());
  EXPECT_THAT(error("a.exr"), HasSubstr("a.exr: a deep image; only flat ones are read"));
}

TEST_F(ImageFileOf, OfMipLevelsTheLargestIsRead) {
  OIIO::ImageBuf source(OIIO::ImageSpec(8, 4, 1, OIIO::TypeFloat));
  for (int i = 0; i < 32; ++i) source.setpixel(i % 8, i / 8, std::array{static_cast<float>(i)});
  ASSERT_TRUE(OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, source, path().string(), OIIO::ImageSpec()));
  const auto levels = OIIO::ImageInput::open(path().string());
  ASSERT_TRUE(levels && levels->seek_subimage(0, 1)) << "the test's file has several levels";
  ASSERT_EQ(names().size(), 1U);
  EXPECT_THAT(read({names()[0]}, {6, 2, 2, 2}), ElementsAre(22, 23, 30, 31));
}

TEST_F(ImageFileOf, TellsPixelAspectMatricesAndOtherAttributes) {
  OIIO::ImageSpec spec(1, 1, 1, OIIO::TypeFloat);
  spec.attribute("PixelAspectRatio", 2.0F);
  float numbers[16];
  for (int i = 0; i < 16; ++i) numbers[i] = static_cast<float>(i);
  spec.attribute("worldToCamera", OIIO::TypeMatrix, numbers);
  spec.attribute("Artist", "Ä. Müller");
  const auto output = OIIO::ImageOutput::create("openexr");
  const float pixel = 0;
  ASSERT_TRUE(output->open(path().string(), spec) && output->write_image(OIIO::TypeFloat, &pixel) && output->close());
  const ImageFile file(path());
  EXPECT_EQ(file.pixel_aspect(), 2);
  ASSERT_TRUE(file.matrix("worldToCamera"));
  EXPECT_EQ((*file.matrix("worldToCamera"))[7], 7);
  EXPECT_FALSE(file.matrix("worldToNDC"));
  std::string told;
  for (const auto& attribute : file.attributes()) told += attribute.name + "=" + attribute.text + "\n";
  EXPECT_THAT(told, HasSubstr("Artist=Ä. Müller\n"));
  EXPECT_THAT(told, testing::Not(HasSubstr("compression")));
}

// Every format, cut at many places: an error that names the file, or the whole image where nothing of it was cut.
TEST_F(ImageFileOf, ACutFileOfAnyFormatIsRefused) {
  std::vector<float> floats(40 * 30 * 3);
  std::vector<std::uint8_t> bytes(floats.size());
  std::uint32_t random = 1;
  for (std::size_t i = 0; i < floats.size(); ++i) {
    random = random * 1664525U + 1013904223U;
    floats[i] = static_cast<float>(random >> 8) / 1e7F, bytes[i] = static_cast<std::uint8_t>(random >> 24);
  }
  write("a.hdr", "hdr", 3, floats, 30);
  write("a.tif", "tiff", 3, floats, 30);
  write("a.png", "png", 3, bytes, 30);
  make_parts(path("a.exr"), {{.width = 20, .height = 20, .channels = {"R", "G"}, .part = "a"},
                             {.width = 20, .height = 20, .channels = {"Z"}, .part = "b"}});
  {
    std::ofstream file(path("a.pfm"), std::ios::binary);
    file << "PF\n40 30\n-1.0\n";
    file.write(reinterpret_cast<const char*>(floats.data()), static_cast<std::streamsize>(floats.size() * 4));
  }
  for (const char* format : {"exr", "hdr", "tif", "png", "pfm"}) {
    const std::string whole = test::read_bytes(path(std::string("a.") + format));
    const std::string name = std::string("cut.") + format;
    for (std::size_t i = 0; i < 40; ++i) {
      const std::size_t length = i * (whole.size() - 20) / 40;
      test::make_text(path(name), whole.substr(0, length));
      const std::string told = message_of(Fault::input, [&] {
        ImageFile file(path(name));
        for (int channel = 0; channel < static_cast<int>(file.channels().size()); ++channel) {
          Image image(QUELL_TYPE_SCALAR, {file.display_window().width, file.display_window().height}, pool_);
          file.read({channel}, file.display_window(), image.writable_floats());
        }
      });
      EXPECT_THAT(told, HasSubstr(name + ": ")) << length << " of " << whole.size() << " bytes";
    }
  }
}

TEST_F(ImageFileOf, HugeSizesInAPfmOrHdrAreRefused) {
  test::make_text(path("a.pfm"), "PF\n100000 100000\n-1.0\nabc");
  EXPECT_THAT(error("a.pfm"), HasSubstr("a.pfm: "));
  test::make_text(path("a.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\nabc");
  EXPECT_THAT(error("a.hdr"), HasSubstr("a.hdr: "));
}

}  // namespace
}  // namespace quell
