// PSNR and SSIM against scikit-image's.
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "quell/sequence/sequence.h"
#include "tests/core/metrics/test_pairs.h"

namespace quell {
namespace {

namespace fs = std::filesystem;
using namespace test;

struct Expected {
  double psnr = 0, ssim = 0;
};

/// Display values as the transform defines them, for the script.
void write(const Image& image, DisplayTransform display, const fs::path& file) {
  std::vector<double> values;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < 3; ++c) values.push_back(to_display(display, static_cast<double>(image.floats().at(x, y, c))));
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(double)));
}

/// Nothing where scikit-image is missing.
std::optional<Expected> ask_skimage(const ImagePair& pair, DisplayTransform display) {
  const fs::path folder = fs::path(testing::TempDir()) / ("quell_skimage_" + std::to_string(getpid()));
  fs::create_directories(folder);
  write(pair.reference, display, folder / "reference");
  write(pair.image, display, folder / "image");
  const std::string files = "'" + (folder / "reference").string() + "' '" + (folder / "image").string() + "'";
  const std::string command = QUELL_PYTHON " '" QUELL_SOURCE_DIR "/tests/core/metrics/skimage_scores.py' " + files + " " +
                              std::to_string(pair.image.width()) + " " + std::to_string(pair.image.height()) + " > '" +
                              (folder / "scores").string() + "' 2>&1";
  const int status = std::system(command.c_str());
  Expected expected;
  std::ifstream scores(folder / "scores");
  const bool is_whole = static_cast<bool>(scores >> expected.psnr >> expected.ssim);
  fs::remove_all(folder);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) return std::nullopt;
  if (status != 0 || !is_whole) throw std::runtime_error("the script fails: " + command);
  return expected;
}

Image sample(std::string_view input) {
  static BufferPool pool;
  return *Sequence::open(fs::path(QUELL_SOURCE_DIR) / "graphs/sample")->read(input, 3, pool).image();
}

/// The mean of the 3 x 3 pixels around each.
Image blur(const Image& image) {
  return test_image(QUELL_TYPE_COLOR, image.size(), [&](int x, int y, int c) {
    float sum = 0;
    for (int v = y - 1; v <= y + 1; ++v)
      for (int u = x - 1; u <= x + 1; ++u)
        sum += image.floats().at(std::clamp(u, 0, image.width() - 1), std::clamp(v, 0, image.height() - 1), c);
    return sum / 9;
  });
}

struct Row {
  const char* name;
  ImagePair (*make)();
  DisplayTransform display;
};
const Row kRows[] = {
    {"SampleAndItsNoise",
     [] {
       return ImagePair{sample("reference"), sample("color")};
     },
     DisplayTransform::reinhard},
    {"SampleAndItsBlur",
     [] {
       return ImagePair{sample("reference"), blur(sample("reference"))};
     },
     DisplayTransform::srgb},
    {"NoiseOfAnOddSize",
     [] {
       return make_pair({65, 47});
     },
     DisplayTransform::none},
};

class AgainstSkimage : public ::testing::TestWithParam<Row> {};

TEST_P(AgainstSkimage, PsnrAndSsimAgree) {
  const ImagePair pair = GetParam().make();
  const std::optional<Expected> expected = ask_skimage(pair, GetParam().display);
  if (!expected) GTEST_SKIP() << "scikit-image is not there; it is Debian's python3-skimage";
  EXPECT_NEAR(figure({pair, {}, {}}, Metric::psnr, GetParam().display), expected->psnr, 1e-4);
  EXPECT_NEAR(figure({pair, {}, {}}, Metric::ssim, GetParam().display), expected->ssim, 1e-4);
  EXPECT_LT(expected->ssim, 0.99);  // pairs that are too alike would show nothing
}

INSTANTIATE_TEST_SUITE_P(Three, AgainstSkimage, ::testing::ValuesIn(kRows), [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace quell
