// What goes from the file of a frame's picture to the files of its results, seen with OpenImageIO itself.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>

#include "quell/sequence/file_sink.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

namespace fs = std::filesystem;
using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

using Bytes = std::vector<unsigned char>;

/// A part of an original: its header, and pixels as bytes of the file's own numbers.
struct Part {
  OIIO::ImageSpec spec;
  Bytes pixels;
};

/// Channels named as `name:format`; every byte of the pixels is its place, times 37, so that halves and floats are of all kinds,
/// NaN among them.
Part make_part(int width, int height, const std::vector<std::string>& channels) {
  Part part;
  part.spec = OIIO::ImageSpec(width, height, static_cast<int>(channels.size()), OIIO::TypeFloat);
  part.spec.channelnames.clear();
  for (const std::string& channel : channels) {
    part.spec.channelnames.push_back(channel.substr(0, channel.find(':')));
    part.spec.channelformats.emplace_back(channel.substr(channel.find(':') + 1).c_str());
  }
  part.pixels.resize(part.spec.image_bytes(true));
  for (std::size_t i = 0; i < part.pixels.size(); ++i) part.pixels[i] = static_cast<unsigned char>(i * 37 + i / 256);
  return part;
}

void write_parts(const fs::path& file, const std::vector<Part>& parts, const char* format = "openexr") {
  const auto output = OIIO::ImageOutput::create(format);
  std::vector<OIIO::ImageSpec> specs;
  for (const Part& part : parts) specs.push_back(part.spec);
  bool ok = specs.size() == 1 ? output->open(file.string(), specs[0])
                              : output->open(file.string(), static_cast<int>(specs.size()), specs.data());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) ok = ok && output->open(file.string(), specs[i], OIIO::ImageOutput::AppendSubimage);
    ok = ok && output->write_image(OIIO::TypeUnknown, parts[i].pixels.data());
  }
  ASSERT_TRUE(ok && output->close()) << output->geterror();
}

/// A file's first part.
Part read_part(const fs::path& file) {
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) throw std::runtime_error(file.string() + ": " + OIIO::geterror());
  Part part{input->spec(), {}};
  part.pixels.resize(part.spec.image_bytes(true));
  input->read_image(0, 0, 0, part.spec.nchannels, OIIO::TypeUnknown, part.pixels.data());
  return part;
}

/// The bytes of one channel, pixel after pixel.
Bytes channel(const Part& part, const std::string& name) {
  const int index = part.spec.channelindex(name);
  if (index < 0) throw std::logic_error("no channel " + name);
  const std::size_t size = part.spec.channelformat(index).size(), step = part.spec.pixel_bytes(true);
  Bytes bytes;
  for (std::size_t at = part.spec.pixel_bytes(0, index, true); at < part.pixels.size(); at += step)
    bytes.insert(bytes.end(), part.pixels.begin() + static_cast<std::ptrdiff_t>(at),
                 part.pixels.begin() + static_cast<std::ptrdiff_t>(at + size));
  return bytes;
}

std::vector<std::string> channels(const Part& part) {
  std::vector<std::string> names;
  for (int c = 0; c < part.spec.nchannels; ++c)
    names.push_back(part.spec.channelnames[static_cast<std::size_t>(c)] + ":" + part.spec.channelformat(c).c_str());
  return names;
}

std::vector<int> windows(const Part& part) {
  const OIIO::ImageSpec& s = part.spec;
  return {s.x, s.y, s.width, s.height, s.full_x, s.full_y, s.full_width, s.full_height};
}

class OriginalOf : public testing::Test {
 protected:
  fs::path file() const { return folder_ / "beauty.exr"; }
  /// A sink for one image, `color`, whose picture is R,G,B of file().
  FileSinkOptions options(bool keep = false) {
    FileSinkOptions chosen{.folder = folder_ / "out"};
    chosen.attributes = {{"Software", "quell 1.2"}, {"quell:graph_hash", "abc"}};
    chosen.images = {{"color", QUELL_TYPE_COLOR}};
    chosen.keep_channels = keep;
    chosen.original = [this](std::int64_t) { return std::optional(original_); };
    return chosen;
  }
  /// Color of that size: pixel (x, y) is x, y, 1.
  Image picture(int width, int height) {
    Image image(QUELL_TYPE_COLOR, {width, height}, pool_);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const FloatOutput view = image.writable_floats();
        view.at(x, y, 0) = static_cast<float>(x), view.at(x, y, 1) = static_cast<float>(y), view.at(x, y, 2) = 1;
      }
    return image;
  }
  Part result(const FileSinkOptions& chosen, int width, int height) {
    FileSink(chosen).write("color", 7, picture(width, height));
    return read_part(folder_ / "out/color.0007.exr");
  }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    if (!fs::exists(folder_ / "out")) return found;
    for (const auto& entry : fs::directory_iterator(folder_ / "out")) found.push_back(entry.path().filename().string());
    return found;
  }

  test::TempFolder folder_;
  BufferPool pool_;
  Original original_{folder_ / "beauty.exr", {"R", "G", "B"}, {"R", "G", "B"}, std::nullopt};
};

TEST_F(OriginalOf, HandsItsAttributesOnWithTheirTypes) {
  Part part = make_part(2, 1, {"R:half", "G:half", "B:half"});
  float matrix[16];
  for (int i = 0; i < 16; ++i) matrix[i] = static_cast<float>(i) / 3;
  part.spec.attribute("worldToCamera", OIIO::TypeMatrix44, matrix);
  part.spec.attribute("worldToNDC", OIIO::TypeMatrix44, matrix);
  const int rate[2] = {24000, 1001};
  part.spec.attribute("FramesPerSecond", OIIO::TypeRational, rate);
  const float primaries[8] = {0.64F, 0.33F, 0.3F, 0.6F, 0.15F, 0.06F, 0.3127F, 0.329F};
  part.spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), primaries);
  part.spec.attribute("Copyright", "größer & co");
  part.spec.attribute("utcOffset", 3600.0F);
  part.spec.attribute("spp", 4);
  part.spec.attribute("DateTime", "2020:01:02 03:04:05");
  part.spec.attribute("cycles.ViewLayer.samples", "4");
  part.spec.attribute("Software", "renderer 3");
  part.spec.attribute("quell:graph_hash", "of another run");
  part.spec.attribute("cryptomatte/1/name", "object");
  part.spec.attribute("compression", "piz");
  write_parts(file(), {part});
  const OIIO::ImageSpec got = result(options(), 2, 1).spec;
  const auto same_matrix = [&](const char* name) {
    const OIIO::ParamValue* value = got.find_attribute(name, OIIO::TypeMatrix44);
    return value && std::memcmp(value->data(), matrix, sizeof matrix) == 0;
  };
  EXPECT_TRUE(same_matrix("worldToCamera"));
  EXPECT_TRUE(same_matrix("worldToNDC"));
  const OIIO::ParamValue* fps = got.find_attribute("FramesPerSecond", OIIO::TypeRational);
  ASSERT_TRUE(fps);
  EXPECT_EQ(std::memcmp(fps->data(), rate, sizeof rate), 0);
  const OIIO::ParamValue* colors = got.find_attribute("chromaticities");
  ASSERT_TRUE(colors && colors->type() == OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
  EXPECT_EQ(std::memcmp(colors->data(), primaries, sizeof primaries), 0);
  EXPECT_EQ(got.get_string_attribute("Copyright"), "größer & co");
  EXPECT_EQ(got.get_float_attribute("utcOffset"), 3600);
  EXPECT_TRUE(got.find_attribute("spp", OIIO::TypeInt));
  EXPECT_EQ(got.get_int_attribute("spp"), 4);
  EXPECT_EQ(got.get_string_attribute("DateTime"), "2020:01:02 03:04:05") << "when the picture was made stays true";
  EXPECT_EQ(got.get_string_attribute("cycles.ViewLayer.samples"), "4");
  EXPECT_EQ(got.get_string_attribute("Software"), "quell 1.2");
  EXPECT_EQ(got.get_string_attribute("quell:graph_hash"), "abc");
  EXPECT_EQ(got.get_int_attribute("quell:frame"), 7);
  EXPECT_EQ(got.get_string_attribute("compression"), "zip");
  EXPECT_FALSE(got.find_attribute("cryptomatte/1/name")) << "without its channels it would be wrong";
}

TEST_F(OriginalOf, GivesPngTheTexts) {
  Part part = make_part(2, 1, {"R:half", "G:half", "B:half"});
  part.spec.attribute("Copyright", "someone");
  part.spec.attribute("PixelAspectRatio", 2.0F);
  part.spec.attribute(std::string(80, 'n'), "longer than PNG has room for");
  write_parts(file(), {part});
  FileSinkOptions chosen = options();
  chosen.formats = {FileFormat::png};
  FileSink(chosen).write("color", 7, picture(2, 1));
  const OIIO::ImageSpec got = read_part(folder_ / "out/color.0007.png").spec;
  EXPECT_EQ(got.get_string_attribute("Copyright"), "someone");
  EXPECT_EQ(got.get_string_attribute("Software"), "quell 1.2");
  EXPECT_EQ(got.get_string_attribute("quell:graph_hash"), "abc");
  EXPECT_EQ(got.get_string_attribute("quell:frame"), "7");
  EXPECT_EQ(got.get_float_attribute("PixelAspectRatio"), 2);
  for (const OIIO::ParamValue& value : got.extra_attribs) EXPECT_FALSE(value.name().string().starts_with("nnn"));
}

TEST_F(OriginalOf, HandsItsWindowsAndPixelAspectOn) {
  Part part = make_part(4, 2, {"R:half", "G:half", "B:half"});
  part.spec.x = 3, part.spec.y = -2;
  part.spec.full_x = -5, part.spec.full_y = -7, part.spec.full_width = 20, part.spec.full_height = 30;
  part.spec.attribute("PixelAspectRatio", 2.0F);
  write_parts(file(), {part});
  const Part got = result(options(), 20, 30);
  EXPECT_EQ(windows(got), windows(part));
  EXPECT_EQ(got.spec.get_float_attribute("PixelAspectRatio"), 2);
  // Its first pixel is that at 3 + 5, -2 + 7 of the image: half 8 is 0x4800, half 5 is 0x4500.
  EXPECT_THAT(Bytes(got.pixels.begin(), got.pixels.begin() + 4), ElementsAre(0x00, 0x48, 0x00, 0x45));
}

TEST_F(OriginalOf, IsCutToItsDisplayWindowWhereItReachesBeyond) {
  Part part = make_part(8, 6, {"R:half", "G:half", "B:half"});
  part.spec.x = -2, part.spec.y = -1;
  part.spec.full_x = part.spec.full_y = 0, part.spec.full_width = 4, part.spec.full_height = 3;
  write_parts(file(), {part});
  EXPECT_THAT(windows(result(options(), 4, 3)), ElementsAre(0, 0, 4, 3, 0, 0, 4, 3));
}

TEST_F(OriginalOf, LeavesACroppedResultWhereItWasCutOut) {
  Part part = make_part(20, 10, {"R:half", "G:half", "B:half", "A:half"});
  part.spec.x = part.spec.full_x = 100, part.spec.y = part.spec.full_y = -50;
  write_parts(file(), {part});
  original_.window = Rectangle{4, 3, 5, 2};
  const Part got = result(options(true), 5, 2);
  EXPECT_THAT(windows(got), ElementsAre(104, -47, 5, 2, 100, -50, 20, 10));
  const Bytes whole = channel(part, "A");
  Bytes cut(whole.begin() + 2 * (3 * 20 + 4), whole.begin() + 2 * (3 * 20 + 9));
  cut.insert(cut.end(), whole.begin() + 2 * (4 * 20 + 4), whole.begin() + 2 * (4 * 20 + 9));
  EXPECT_EQ(channel(got, "A"), cut);
}

TEST_F(OriginalOf, LeavesAResultOfAnotherSizeItsOwnWindows) {
  Part part = make_part(4, 2, {"R:half", "G:half", "B:half", "A:half"});
  part.spec.x = part.spec.full_x = 9;
  part.spec.attribute("PixelAspectRatio", 2.0F);
  write_parts(file(), {part});
  const Part got = result(options(), 2, 1);
  EXPECT_THAT(windows(got), ElementsAre(0, 0, 2, 1, 0, 0, 2, 1));
  EXPECT_EQ(got.spec.get_float_attribute("PixelAspectRatio"), 2);
  fs::remove_all(folder_ / "out");
  EXPECT_THAT(message_of(Fault::frame, [&] { result(options(true), 2, 1); }),
              HasSubstr("its channels cannot be kept: they have 4 x 2 pixels, and the result 2 x 1"));
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(OriginalOf, KeepsChannelsBitForBit) {
  const Part part = make_part(70, 130, {"R:half", "G:half", "B:half", "A:half", "crypto.r:float", "id:uint", "Z:half"});
  write_parts(file(), {part});
  original_.read.emplace_back("Z");
  const Part got = result(options(true), 70, 130);
  EXPECT_THAT(channels(got), UnorderedElementsAre("R:half", "G:half", "B:half", "A:half", "crypto.r:float", "id:uint"));
  for (const char* name : {"A", "crypto.r", "id"}) EXPECT_EQ(channel(got, name), channel(part, name)) << name;
  EXPECT_NE(channel(got, "R"), channel(part, "R"));
}

TEST_F(OriginalOf, KeepsChannelsOfTiles) {
  Part part = make_part(70, 50, {"R:half", "G:half", "B:half", "A:half"});
  part.spec.tile_width = 32, part.spec.tile_height = 24;
  part.spec.x = 5, part.spec.y = -3, part.spec.full_x = 0, part.spec.full_y = 0;
  part.spec.full_width = 60, part.spec.full_height = 40;
  write_parts(file(), {part});
  const Part got = result(options(true), 60, 40);
  EXPECT_THAT(windows(got), ElementsAre(5, 0, 55, 40, 0, 0, 60, 40));
  const Bytes whole = channel(part, "A"), kept = channel(got, "A");
  for (std::ptrdiff_t y = 0; y < 40; ++y)
    EXPECT_TRUE(std::equal(kept.begin() + y * 55 * 2, kept.begin() + (y + 1) * 55 * 2, whole.begin() + (y + 3) * 70 * 2)) << y;
}

TEST_F(OriginalOf, KeepsChannelsOfAllParts) {
  Part beauty = make_part(70, 50, {"R:half", "G:half", "B:half", "A:half"});
  beauty.spec.attribute("oiio:subimagename", "rgba");
  Part other = make_part(30, 20, {"Y:uint"});
  other.spec.attribute("oiio:subimagename", "id");
  other.spec.x = 10, other.spec.y = 5, other.spec.full_x = other.spec.full_y = 0;
  other.spec.full_width = 70, other.spec.full_height = 50;
  write_parts(file(), {beauty, other});
  original_ = {file(), {"rgba.R", "rgba.G", "rgba.B"}, {"rgba.R", "rgba.G", "rgba.B"}, std::nullopt};
  const Part got = result(options(true), 70, 50);
  EXPECT_THAT(channels(got), ElementsAre("R:half", "G:half", "B:half", "A:half", "id.Y:uint"))
      << "the picture's layer loses its name, alpha as R, G and B";
  EXPECT_EQ(channel(got, "A"), channel(beauty, "A"));
  const Bytes ids = channel(got, "id.Y"), want = channel(other, "Y");
  EXPECT_TRUE(std::equal(want.begin(), want.begin() + 30 * 4, ids.begin() + (5 * 70 + 10) * 4)) << "its first row";
  EXPECT_TRUE(std::all_of(ids.begin(), ids.begin() + 5 * 70 * 4, [](unsigned char byte) { return byte == 0; })) << "above it";
}

TEST_F(OriginalOf, LeavesChannelsOutThatAResultHasTheNameOf) {
  const Part part = make_part(2, 1, {"View.R:half", "View.G:half", "View.B:half", "View.A:half", "A:half", "R:float"});
  write_parts(file(), {part});
  original_ = {file(), {"View.R", "View.G", "View.B"}, {"View.R", "View.G", "View.B"}, std::nullopt};
  const FileSinkOptions chosen = options(true);
  const FileSink::KeptChannels told = FileSink(chosen).kept_channels(7);
  EXPECT_EQ(told.kept.size(), 1U);
  EXPECT_EQ(told.kept.at(0), "A");
  EXPECT_THAT(told.left_out, UnorderedElementsAre("A", "R"));
  const Part got = result(chosen, 2, 1);
  EXPECT_THAT(channels(got), ElementsAre("R:half", "G:half", "B:half", "A:half"));
  EXPECT_EQ(channel(got, "A"), channel(part, "View.A")) << "the alpha of the picture, not the one beside its layer";
  FileSinkOptions layers = chosen;
  layers.layers = "all";
  layers.images = {{"first", QUELL_TYPE_COLOR}, {"View", QUELL_TYPE_ALPHA}};
  EXPECT_THAT(FileSink(layers).kept_channels(7).kept, ElementsAre("A"));
}

TEST_F(OriginalOf, TurnsIntegersThatExrHasNotIntoFloats) {
  Part part = make_part(2, 1, {"R:uint16", "G:uint16", "B:uint16", "A:uint16"});
  part.spec = OIIO::ImageSpec(2, 1, 4, OIIO::TypeUInt16);
  const std::uint16_t pixels[8] = {1, 2, 3, 65535, 4, 5, 6, 1};
  std::memcpy(part.pixels.data(), pixels, sizeof pixels);
  part.spec.attribute("oiio:UnassociatedAlpha", 1);
  original_.file = folder_ / "beauty.tif";
  write_parts(original_.file, {part}, "tiff");
  const Part got = result(options(true), 2, 1);
  EXPECT_THAT(channels(got), ElementsAre("R:half", "G:half", "B:half", "A:float"));
  const float want[2] = {1, 1.0F / 65535.0F};
  Bytes bytes(sizeof want);
  std::memcpy(bytes.data(), want, sizeof want);
  EXPECT_EQ(channel(got, "A"), bytes);
}

TEST_F(OriginalOf, GivesPngItsAlphaAndDividesColorByIt) {
  Part part = make_part(4, 70, {"R:float", "G:float", "B:float", "A:float"});
  for (std::size_t pixel = 0; pixel < 4 * 70; ++pixel) {
    const float values[4] = {0, 0, 0, static_cast<float>(pixel % 4) / 2};  // 0, 1/2, 1, 3/2
    std::memcpy(part.pixels.data() + pixel * sizeof values, values, sizeof values);
  }
  write_parts(file(), {part});
  FileSinkOptions chosen = options(true);
  chosen.formats = {FileFormat::png};
  Image image(QUELL_TYPE_COLOR, {4, 70}, pool_);
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 70; ++y) std::fill_n(image.writable_floats().row(y, c), 4, 0.25F);
  FileSink(chosen).write("color", 7, image);
  OIIO::ImageSpec as_it_is;
  as_it_is.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open((folder_ / "out/color.0007.png").string(), &as_it_is);
  ASSERT_TRUE(input);
  ASSERT_EQ(input->spec().nchannels, 4);
  Bytes got(4 * 70 * 4);
  ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeUInt8, got.data()));
  // sRGB of 1/4, 1/2, 1/4 and 1/6, by hand: 0.53710, 0.73536, 0.53710 and 0.44505, times 255; alpha 0, 127.5, 255, above.
  const Bytes row = {137, 137, 137, 0, 188, 188, 188, 128, 137, 137, 137, 255, 113, 113, 113, 255};
  for (std::size_t y : {0, 1, 63, 64, 69})
    EXPECT_TRUE(std::equal(row.begin(), row.end(), got.begin() + static_cast<std::ptrdiff_t>(y * row.size()))) << y;
}

TEST_F(OriginalOf, ThatCannotBeReadIsNamedAndLeavesNothing) {
  const auto message = [&](bool keep) { return message_of(Fault::input, [&] { result(options(keep), 70, 130); }); };
  EXPECT_EQ(message(false), file().string() + ": no such file");
  write_parts(file(), {make_part(70, 130, {"R:half", "G:half", "B:half", "A:half"})});
  fs::resize_file(file(), fs::file_size(file()) * 2 / 3);
  EXPECT_THAT(message(true), HasSubstr("beauty.exr: truncated or damaged: "));
  EXPECT_THAT(names(), IsEmpty());
}

}  // namespace
}  // namespace quell
