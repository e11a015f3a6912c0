#include "quell/sequence/file_sink.h"

#include <OpenImageIO/imageio.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>

#include "quell/sequence/camera_file.h"
#include "quell/sequence/image_writer.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::load_exr;
using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class FileSinkTo : public testing::Test {
 protected:
  /// One row of pixels, given plane after plane.
  Item image(PortType type, const std::vector<float>& planes) {
    const int channels = info(type).channels;
    Image made(type, {static_cast<int>(planes.size()) / channels, 1}, pool_);
    const FloatOutput view = made.writable_floats();
    for (int c = 0; c < channels; ++c)
      for (int x = 0; x < view.width; ++x) view.at(x, 0, c) = planes[static_cast<std::size_t>(c * view.width + x)];
    return made;
  }
  FileSinkOptions options() { return {.folder = folder_ / "out"}; }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    if (!std::filesystem::exists(folder_ / "out")) return found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out"))
      found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  test::TempFolder folder_;
  BufferPool pool_;
};

TEST_F(FileSinkTo, WritesHalfForColorAndFloatForTheRest) {
  FileSink sink(options());
  sink.write("color", 7, image(QUELL_TYPE_COLOR, {1, 2, 3}));
  sink.write("filter.albedo", 7, image(QUELL_TYPE_ALBEDO, {1, 2, 3}));
  sink.write("normal", -3, image(QUELL_TYPE_NORMAL, {0.6F, 0, 0.8F}));
  EXPECT_THAT(names(), ElementsAre("color.0007.exr", "filter.albedo.0007.exr", "normal.-0003.exr"))
      << "no temporary file is left";
  const auto color = load_exr(folder_ / "out/color.0007.exr");
  EXPECT_THAT(color.channels, ElementsAre("R:half", "G:half", "B:half"));
  EXPECT_THAT(color.pixels, ElementsAre(1, 2, 3));
  EXPECT_EQ(color.compression, "zip");
  EXPECT_THAT(load_exr(folder_ / "out/filter.albedo.0007.exr").channels, ElementsAre("R:half", "G:half", "B:half"));
  const auto normal = load_exr(folder_ / "out/normal.-0003.exr");
  EXPECT_THAT(normal.channels, ElementsAre("X:float", "Y:float", "Z:float"));
  EXPECT_THAT(normal.pixels, ElementsAre(0.6F, 0, 0.8F));
  EXPECT_THAT(sink.written(), ElementsAre(folder_ / "out/color.0007.exr", folder_ / "out/filter.albedo.0007.exr",
                                          folder_ / "out/normal.-0003.exr"));
}

TEST_F(FileSinkTo, TypeAndCompressionCanBeChosen) {
  FileSinkOptions chosen = options();
  chosen.type = PixelType::single;
  chosen.compression = "piz";
  chosen.padding = 1;
  FileSink floats(chosen);
  floats.write("color", 7, image(QUELL_TYPE_COLOR, {0.1F, 1e6F, 3}));
  const auto color = load_exr(folder_ / "out/color.7.exr");
  EXPECT_THAT(color.channels, ElementsAre("R:float", "G:float", "B:float"));
  EXPECT_THAT(color.pixels, ElementsAre(0.1F, 1e6F, 3));
  EXPECT_EQ(color.compression, "piz");
  EXPECT_EQ(floats.clamped_pixels(), 0U);
  chosen.type = PixelType::half;
  FileSink halves(chosen);
  halves.write("depth", 7, image(QUELL_TYPE_DEPTH, {2.5F, 1e10F}));
  const auto depth = load_exr(folder_ / "out/depth.7.exr");
  EXPECT_THAT(depth.channels, ElementsAre("Z:half"));
  EXPECT_THAT(depth.pixels, ElementsAre(2.5F, 65504));
  EXPECT_EQ(halves.clamped_pixels(), 1U);
}

TEST_F(FileSinkTo, EveryCompressionIsWritten) {
  for (const std::string& compression : exr_compressions()) {
    FileSinkOptions chosen = options();
    chosen.compression = compression;
    FileSink(chosen).write(compression, 0, image(QUELL_TYPE_COLOR, {0.5F, 1, 2}));
    const auto file = load_exr(folder_ / "out" / (compression + ".0000.exr"));
    EXPECT_EQ(file.compression, compression);
    EXPECT_NEAR(file.pixels.at(0), 0.5, 1e-3) << compression;
  }
}

TEST_F(FileSinkTo, ValuesBeyondHalfAreClampedAndPixelsCounted) {
  const float infinity = std::numeric_limits<float>::infinity();
  FileSink sink(options());
  // Five pixels: within, above, far above and below in one pixel, infinite, NaN.
  sink.write("color", 0,
             image(QUELL_TYPE_COLOR, {65504, 65505, 1e30F, infinity, NAN,  //
                                      1, 1, -1e30F, 1, 1,                  //
                                      1, 1, 1, 1, 1}));
  const auto file = load_exr(folder_ / "out/color.0000.exr");
  EXPECT_EQ(file.pixels[0], 65504);
  EXPECT_EQ(file.pixels[3], 65504);
  EXPECT_EQ(file.pixels[6], 65504);
  EXPECT_EQ(file.pixels[7], -65504);
  EXPECT_EQ(file.pixels[9], 65504);
  EXPECT_TRUE(std::isnan(file.pixels[12]));
  EXPECT_EQ(sink.clamped_pixels(), 3U);
}

TEST_F(FileSinkTo, IdsAreWrittenAsIntegers) {
  Image ids(QUELL_TYPE_ID, {3, 1}, pool_);
  ids.writable_ids().at(0, 0) = 5;
  ids.writable_ids().at(1, 0) = 16777217;
  ids.writable_ids().at(2, 0) = QUELL_NO_ID;
  FileSink(options()).write("id", 0, ids);
  const auto file = load_exr(folder_ / "out/id.0000.exr");
  EXPECT_THAT(file.channels, ElementsAre("Y:uint"));
  const std::string want = test::read_bytes(folder_ / "out/id.0000.exr");
  // Small images are stored uncompressed by zip when that is not larger; the indices end the file.
  const std::uint32_t expected[3] = {5, 16777217, QUELL_NO_ID};
  EXPECT_EQ(std::memcmp(want.data() + want.size() - sizeof expected, expected, sizeof expected), 0);
}

TEST_F(FileSinkTo, TheSameImageGivesTheSameBytes) {
  for (const char* output : {"a", "b"}) {
    FileSinkOptions chosen = options();
    chosen.formats = {FileFormat::exr, FileFormat::png};
    FileSink(chosen).write(output, 0, image(QUELL_TYPE_COLOR, {1, 2, 3}));
  }
  EXPECT_EQ(test::read_bytes(folder_ / "out/a.0000.exr"), test::read_bytes(folder_ / "out/b.0000.exr"));
  EXPECT_EQ(test::read_bytes(folder_ / "out/a.0000.png"), test::read_bytes(folder_ / "out/b.0000.png"));
  const std::string bytes = test::read_bytes(folder_ / "out/a.0000.exr");
  EXPECT_EQ(bytes.find("20"), std::string::npos) << "the time of writing must not be in the file";
}

/// IEC 61966-2-1, in double.
int srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return static_cast<int>(std::floor(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055) + 0.5));
}

TEST_F(FileSinkTo, PngHoldsTheSrgbCurve) {
  FileSinkOptions chosen = options();
  chosen.formats = {FileFormat::png};
  std::vector<float> ramp;
  for (int i = -2; i <= 1030; ++i) ramp.push_back(static_cast<float>(i) / 1024);
  ramp.insert(ramp.end(), {0.001F, 0.0031308F, 0.0032F, std::numeric_limits<float>::infinity(), NAN});
  FileSink(chosen).write("mask", 0, image(QUELL_TYPE_MASK, ramp));
  const auto input = OIIO::ImageInput::open((folder_ / "out/mask.0000.png").string());
  ASSERT_TRUE(input);
  ASSERT_EQ(input->spec().nchannels, 1);
  ASSERT_EQ(input->spec().format, OIIO::TypeUInt8);
  std::vector<std::uint8_t> got(ramp.size());
  ASSERT_TRUE(input->read_image(0, 0, 0, 1, OIIO::TypeUInt8, got.data()));
  for (std::size_t i = 0; i < ramp.size() - 1; ++i) EXPECT_EQ(got[i], srgb(ramp[i])) << ramp[i];
  EXPECT_EQ(got.back(), 0) << "NaN";
  // By hand: 0.5 is 1.055 * 0.5^(1/2.4) - 0.055 = 0.73536, times 255 = 187.5; 0.2 is 0.48453, 123.6.
  EXPECT_EQ(to_srgb8(0.2F), 124);
  EXPECT_EQ(to_srgb8(0.5F), 188);
  EXPECT_EQ(to_srgb8(1.0F), 255);
}

TEST_F(FileSinkTo, PngHoldsColorAndSinglePlanesOnly) {
  FileSinkOptions chosen = options();
  chosen.formats = {FileFormat::png};
  FileSink png(chosen);
  png.write("color", 1, image(QUELL_TYPE_COLOR, {0, 1, 1, 0, 0, 0}));
  const auto file = load_exr(folder_ / "out/color.0001.png");
  EXPECT_THAT(file.channels, ElementsAre("R:uint8", "G:uint8", "B:uint8"));
  EXPECT_THAT(file.pixels, ElementsAre(0, 1, 0, 1, 0, 0));
  EXPECT_EQ(message_of(Fault::usage,
                       [&] {
                         png.write("normal", 1, image(QUELL_TYPE_NORMAL, {0, 0, 1}));
                       }),
            "normal: PNG cannot hold an image of type normal; choose exr");
  EXPECT_THAT(message_of(Fault::usage, [&] { png.files("id", 1, QUELL_TYPE_ID); }), HasSubstr("cannot hold an image of type id"));
  chosen.formats = {FileFormat::exr, FileFormat::png};
  const FileSink both(chosen);
  EXPECT_THAT(both.files("normal", 1, QUELL_TYPE_NORMAL), ElementsAre(folder_ / "out/normal.0001.exr"));
  EXPECT_THAT(both.files("color", 1, QUELL_TYPE_COLOR),
              ElementsAre(folder_ / "out/color.0001.exr", folder_ / "out/color.0001.png"));
}

TEST_F(FileSinkTo, CamerasAndValuesBecomeText) {
  FileSink sink(options());
  Camera camera;
  camera.size = {640, 360};
  camera.world_to_camera[3] = 0.1;
  camera.world_to_screen[7] = -1.0 / 3;
  camera.object_to_world[4][11] = 1e-17;
  sink.write("camera", 2, camera);
  const Camera back = read_json_camera(folder_ / "out/camera.0002.json");
  EXPECT_EQ(back.size, camera.size);
  EXPECT_EQ(back.world_to_camera, camera.world_to_camera);
  EXPECT_EQ(back.world_to_screen, camera.world_to_screen);
  EXPECT_EQ(back.object_to_world, camera.object_to_world);
  sink.write("exposure", 2, Values{0.5, NAN, -3});
  EXPECT_EQ(test::read_bytes(folder_ / "out/exposure.0002.json"), "{\"frame\": 2, \"values\": [0.5, null, -3]}\n");
}

TEST_F(FileSinkTo, AnExistingFileIsReplaced) {
  std::filesystem::create_directories(folder_ / "out");
  test::make_text(folder_ / "out/color.0001.exr", "old");
  FileSink(options()).write("color", 1, image(QUELL_TYPE_COLOR, {1, 2, 3}));
  EXPECT_THAT(load_exr(folder_ / "out/color.0001.exr").pixels, ElementsAre(1, 2, 3));
  EXPECT_THAT(names(), ElementsAre("color.0001.exr"));
}

TEST_F(FileSinkTo, AFailedWriteLeavesNothing) {
  FileSink sink(options());
  std::filesystem::create_directories(folder_ / "out/color.0001.exr");  // a folder where the file should be
  EXPECT_THAT(message_of(Fault::frame,
                         [&] {
                           sink.write("color", 1, image(QUELL_TYPE_COLOR, {1, 2, 3}));
                         }),
              HasSubstr("out/color.0001.exr: cannot be written: "));
  EXPECT_THAT(message_of(Fault::frame,
                         [&] {
                           sink.write("no/folder", 1, image(QUELL_TYPE_COLOR, {1, 2, 3}));
                         }),
              HasSubstr("out/no/folder.0001.exr: cannot be written: "))
      << "the message names the final file, not the temporary one";
  EXPECT_THAT(names(), ElementsAre("color.0001.exr"));
  EXPECT_THAT(sink.written(), IsEmpty());
  test::make_text(folder_ / "file", "x");
  EXPECT_THAT(message_of(Fault::frame,
                         [&] {
                           FileSink({.folder = folder_ / "file"}).write("color", 1, image(QUELL_TYPE_COLOR, {1, 2, 3}));
                         }),
              HasSubstr("file: the folder cannot be made: "));
}

/// As on a full disk: files of this process cannot grow beyond so many bytes.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : former_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &former_);
    rlimit limit = former_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, former_handler_);
  }

 private:
  void (*former_handler_)(int);
  rlimit former_{};
};

TEST_F(FileSinkTo, AFileThatDoesNotArriveWholeIsAFailedWrite) {
  FileSinkOptions png = options();
  png.formats = {FileFormat::png};
  const auto message = [&](const FileSinkOptions& chosen, const char* output, const Item& item) {
    return message_of(Fault::frame, [&] { FileSink(chosen).write(output, 1, item); });
  };
  const std::string out = (folder_ / "out").string();
  const Item color = image(QUELL_TYPE_COLOR, {1, 2, 3});
  // 20 bytes are less than any of the files, and than a stream's buffer: some failures show only when the file is closed.
  const FileSizeLimit limit(20);
  EXPECT_EQ(message(options(), "color", color), out + "/color.0001.exr: cannot be written: File too large");
  EXPECT_EQ(message(png, "color", color), out + "/color.0001.png: cannot be written: File too large");
  EXPECT_EQ(message(options(), "exposure", Values{0.5}), out + "/exposure.0001.json: cannot be written: File too large");
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(FileSinkTo, NothingIsTouchedBeforeTheFirstWrite) {
  const FileSink sink(options());
  sink.files("color", 1, QUELL_TYPE_COLOR);
  EXPECT_THAT(folder_.names(), IsEmpty());
}

}  // namespace
}  // namespace quell
