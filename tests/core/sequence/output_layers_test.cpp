// Images of a frame as layers of one file.
#include <OpenImageIO/imageio.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <thread>

#include "quell/sequence/file_sink.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

namespace fs = std::filesystem;
using test::load_exr;
using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class OutputLayers : public testing::Test {
 protected:
  /// One image a type; every value is `value`.
  Image image(PortType type, double value, Size size = {3, 2}) {
    Image made(type, size, pool_);
    for (int c = 0; c < made.channels(); ++c)
      for (int y = 0; y < size.height; ++y) {
        if (type == QUELL_TYPE_ID)
          std::fill_n(made.writable_ids().row(y, c), size.width, static_cast<std::uint32_t>(value));
        else
          std::fill_n(made.writable_floats().row(y, c), size.width, static_cast<float>(value));
      }
    return made;
  }
  FileSinkOptions options() const {
    FileSinkOptions chosen{.folder = folder_ / "out"};
    chosen.layers = "beauty";
    chosen.images = {{"id", QUELL_TYPE_ID}, {"color", QUELL_TYPE_COLOR}, {"input.normal", QUELL_TYPE_NORMAL}};
    return chosen;
  }
  void write_frame(FileSink& sink, std::int64_t frame) {
    sink.write("id", frame, image(QUELL_TYPE_ID, 4294967295.0));
    sink.write("color", frame, image(QUELL_TYPE_COLOR, 0.5F));
    sink.write("input.normal", frame, image(QUELL_TYPE_NORMAL, 0.1F));
  }
  std::vector<std::string> names(const std::string& folder = "out") const {
    std::vector<std::string> found;
    if (!fs::exists(folder_ / folder)) return found;
    for (const auto& entry : fs::directory_iterator(folder_ / folder)) found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  test::TempFolder folder_;
  BufferPool pool_;
};

TEST_F(OutputLayers, GoIntoOneFileWithNumbersOfTheirOwn) {
  FileSink sink(options());
  EXPECT_THAT(sink.files("input.normal", 3, QUELL_TYPE_NORMAL), ElementsAre(folder_ / "out/beauty.0003.exr"));
  write_frame(sink, 3);
  EXPECT_THAT(names(), ElementsAre("beauty.0003.exr"));
  EXPECT_THAT(sink.written(), ElementsAre(folder_ / "out/beauty.0003.exr"));
  const auto file = OIIO::ImageInput::open((folder_ / "out/beauty.0003.exr").string());
  ASSERT_TRUE(file);
  EXPECT_THAT(load_exr(folder_ / "out/beauty.0003.exr").channels,
              ElementsAre("R:half", "G:half", "B:half", "id.Y:uint", "input.normal.X:float", "input.normal.Y:float",
                          "input.normal.Z:float"));
  std::vector<std::uint32_t> ids(6);
  ASSERT_TRUE(file->read_image(0, 0, 3, 4, OIIO::TypeUInt32, ids.data()));
  EXPECT_EQ(ids, std::vector<std::uint32_t>(6, QUELL_NO_ID));
  std::vector<float> normals(6);
  ASSERT_TRUE(file->read_image(0, 0, 4, 5, OIIO::TypeFloat, normals.data()));
  EXPECT_EQ(normals, std::vector<float>(6, 0.1F));
}

TEST_F(OutputLayers, AreWrittenWithTheLastOfThem) {
  FileSink sink(options());
  sink.write("color", 2, image(QUELL_TYPE_COLOR, 1));
  sink.write("input.normal", 1, image(QUELL_TYPE_NORMAL, 0));
  sink.write("id", 2, image(QUELL_TYPE_ID, 1));
  sink.write("color", 1, image(QUELL_TYPE_COLOR, 1));
  EXPECT_THAT(names(), IsEmpty());
  sink.write("input.normal", 2, image(QUELL_TYPE_NORMAL, 0));
  EXPECT_THAT(names(), ElementsAre("beauty.0002.exr"));
  sink.write("id", 1, image(QUELL_TYPE_ID, 1));
  EXPECT_THAT(names(), ElementsAre("beauty.0001.exr", "beauty.0002.exr"));
  EXPECT_EQ(pool_.usage().in_use, 0U) << "nothing is held any longer";
}

TEST_F(OutputLayers, HaveTheSameBytesInWhateverOrderTheyCome) {
  FileSink sink(options());
  write_frame(sink, 1);
  FileSinkOptions other = options();
  other.folder = folder_ / "other";
  FileSink late(other);
  late.write("input.normal", 1, image(QUELL_TYPE_NORMAL, 0.1F));
  late.write("color", 1, image(QUELL_TYPE_COLOR, 0.5F));
  late.write("id", 1, image(QUELL_TYPE_ID, 4294967295.0));
  EXPECT_EQ(test::read_bytes(folder_ / "out/beauty.0001.exr"), test::read_bytes(folder_ / "other/beauty.0001.exr"));
}

TEST_F(OutputLayers, OfManyFramesAreWrittenAtATime) {
  FileSink sink(options());
  constexpr int kFrames = 24;
  std::vector<std::jthread> threads;
  for (int first = 0; first < 4; ++first)
    threads.emplace_back([&, first] {
      for (int frame = first; frame < kFrames; frame += 4) write_frame(sink, frame);
    });
  threads.clear();
  EXPECT_EQ(names().size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(pool_.usage().in_use, 0U);
}

TEST_F(OutputLayers, GoBesideOtherFormats) {
  FileSinkOptions chosen = options();
  chosen.formats = {FileFormat::exr, FileFormat::png};
  FileSink sink(chosen);
  write_frame(sink, 1);
  sink.write("exposure", 1, Values{0.5});
  EXPECT_THAT(names(), ElementsAre("beauty.0001.exr", "color.0001.png", "exposure.0001.json"));
}

TEST_F(OutputLayers, WithoutColorLeaveTheFirstImageItsPlainNames) {
  FileSinkOptions chosen = options();
  chosen.images = {{"depth", QUELL_TYPE_DEPTH}, {"blend.color", QUELL_TYPE_COLOR}};
  FileSink sink(chosen);
  sink.write("depth", 1, image(QUELL_TYPE_DEPTH, 1));
  sink.write("blend.color", 1, image(QUELL_TYPE_COLOR, 1));
  EXPECT_THAT(load_exr(folder_ / "out/beauty.0001.exr").channels,
              ElementsAre("Z:float", "blend.color.R:half", "blend.color.G:half", "blend.color.B:half"));
}

TEST_F(OutputLayers, ThatCannotBeWrittenAreNotHeld) {
  FileSink sink(options());
  fs::create_directories(folder_ / "out/beauty.0001.exr");  // a folder where the file should be
  EXPECT_THAT(message_of(Fault::frame, [&] { write_frame(sink, 1); }), HasSubstr("out/beauty.0001.exr: cannot be written: "));
  sink.write("color", 2, image(QUELL_TYPE_COLOR, 1));
  EXPECT_THAT(message_of(Fault::frame, [&] { sink.write("no/folder", 2, Values{1}); }), HasSubstr("cannot be written"));
  sink.write("color", 3, image(QUELL_TYPE_COLOR, 1));
  EXPECT_THAT(message_of(Fault::frame, [&] { sink.write("id", 3, Item()); }), HasSubstr("nothing to write in frame 3"));
  sink.write("color", 4, image(QUELL_TYPE_COLOR, 1));
  EXPECT_THAT(message_of(Fault::frame, [&] { sink.write("other", 4, image(QUELL_TYPE_COLOR, 1)); }),
              HasSubstr("other: this image is not among the layers"));
  EXPECT_THAT(names(), ElementsAre("beauty.0001.exr"));
  EXPECT_EQ(pool_.usage().in_use, 0U) << "what came of the frame before is let go";
  write_frame(sink, 2);
  EXPECT_THAT(names(), ElementsAre("beauty.0001.exr", "beauty.0002.exr"));
}

TEST_F(OutputLayers, OfDifferentSizesAreRefused) {
  FileSink sink(options());
  sink.write("id", 1, image(QUELL_TYPE_ID, 1));
  sink.write("color", 1, image(QUELL_TYPE_COLOR, 1, {6, 4}));
  EXPECT_THAT(message_of(Fault::frame, [&] { sink.write("input.normal", 1, image(QUELL_TYPE_NORMAL, 1)); }),
              HasSubstr("the images of frame 1 differ in size"));
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(OutputLayers, NeedANameAndAFormatThatHasThem) {
  FileSinkOptions chosen = options();
  chosen.formats = {FileFormat::png};
  EXPECT_THAT(message_of(Fault::usage, [&] { FileSink{chosen}; }), HasSubstr("--layers: only EXR files have layers"));
  for (const char* name : {"a/b", ".hidden"}) {
    chosen = options();
    chosen.layers = name;
    EXPECT_THAT(message_of(Fault::usage, [&] { FileSink{chosen}; }), HasSubstr("cannot be the name of files")) << name;
  }
}

TEST_F(OutputLayers, ThatDoNotArriveWholeAreAFailedWrite) {
  FileSink sink(options());
  rlimit former{};
  getrlimit(RLIMIT_FSIZE, &former);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = former;
  limit.rlim_cur = 100;  // as on a full disk: less than the header
  setrlimit(RLIMIT_FSIZE, &limit);
  const std::string message = message_of(Fault::frame, [&] { write_frame(sink, 1); });
  setrlimit(RLIMIT_FSIZE, &former);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(message, (folder_ / "out").string() + "/beauty.0001.exr: cannot be written: File too large");
  EXPECT_THAT(names(), IsEmpty());
  EXPECT_EQ(pool_.usage().in_use, 0U);
}

}  // namespace
}  // namespace quell
