#include "tests/bench/frame.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "quell/sequence/sequence.h"

namespace quell::bench {
namespace {

namespace fs = std::filesystem;

const fs::path kCourse = fs::path(QUELL_SOURCE_DIR) / "../shared/data/games202-box";
const fs::path kSample = fs::path(QUELL_SOURCE_DIR) / "graphs/sample";
constexpr std::int64_t kFrame = 5;

/// Where pixel i of a row lies in the row of `length` that is continued by its mirror images.
int mirrored(int i, int length) {
  i %= 2 * length;
  return i < length ? i : 2 * length - 1 - i;
}

Image continued(const Image& image, Size size, BufferPool& pool) {
  Image larger(image.type(), size, pool);
  const FloatImage from = image.floats();
  const FloatOutput to = larger.writable_floats();
  for (int c = 0; c < from.channels; ++c)
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) to.row(y, c)[x] = from.at(mirrored(x, from.width), mirrored(y, from.height), c);
  return larger;
}

float luminance(const FloatImage& color, int x, int y) {
  return 0.2126F * color.at(x, y, 0) + 0.7152F * color.at(x, y, 1) + 0.0722F * color.at(x, y, 2);
}

Image local_variance(const Image& image, BufferPool& pool) {
  Image variance(QUELL_TYPE_VARIANCE, image.size(), pool);
  const FloatImage color = image.floats();
  const FloatOutput to = variance.writable_floats();
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      float sum = 0, sum2 = 0, count = 0;
      for (int v = std::max(0, y - 1); v <= std::min(color.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(color.width - 1, x + 1); ++u) {
          const float l = luminance(color, u, v);
          sum += l, sum2 += l * l, ++count;
        }
      to.row(y, 0)[x] = std::max(0.0F, sum2 / count - sum * sum / (count * count));
    }
  return variance;
}

}  // namespace

BenchFrame make_frame(Size size) {
  static BufferPool pool;
  const bool is_course = fs::is_directory(kCourse);
  const std::unique_ptr<Sequence> sequence = Sequence::open(is_course ? kCourse : kSample);
  const auto read = [&](std::string_view input) { return continued(*sequence->read(input, kFrame, pool).image(), size, pool); };
  BenchFrame frame{read("color"), read("normal"), read("position"), read("depth"), {}, ""};
  frame.variance = local_variance(frame.color, pool);
  frame.from = is_course ? "the course's box scene" : "graphs/sample (the course's box scene is not beside the repository)";
  return frame;
}

}  // namespace quell::bench
