#include "quell/runtime/sanitize.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

// All ones in the exponent: NaN or infinity. Bits are compared so that no compiler option can remove the test.
bool is_finite(float value) { return (std::bit_cast<std::uint32_t>(value) & 0x7f800000u) != 0x7f800000u; }
bool is_finite(double value) {
  constexpr std::uint64_t kExponent = 0x7ff0000000000000u;
  return (std::bit_cast<std::uint64_t>(value) & kExponent) != kExponent;
}

// Reading from memory is all that takes time here, so that what comes next is asked for beforehand. What is asked for may lie
// outside of the image; that is harmless.
QUELL_PLAIN_LOOP int count_non_finite(const float* row, int width) {
  constexpr int kBlock = 64, kAhead = 512;  // floats
  int found = 0;                            // as wide as a float, so that the loop becomes one of vectors
  for (int begin = 0; begin < width; begin += kBlock) {
    for (int line = 0; line < kBlock; line += 16) __builtin_prefetch(row + begin + kAhead + line);
    const int end = std::min(begin + kBlock, width);
    for (int x = begin; x < end; ++x) found += is_finite(row[x]) ? 0 : 1;
  }
  return found;
}

std::int64_t count_non_finite(const FloatImage& image, Executor& executor) {
  constexpr int kRows = 16;  // of a plane, one after the other
  const std::int64_t bands = (image.height + kRows - 1) / kRows;
  std::atomic<std::int64_t> total{0};
  executor.run(bands * image.channels, [&](std::int64_t chunk, std::uint32_t) {
    const int c = static_cast<int>(chunk / bands), first = static_cast<int>(chunk % bands) * kRows;
    std::int64_t found = 0;
    for (int y = first; y < std::min(first + kRows, image.height); ++y) found += count_non_finite(image.row(y, c), image.width);
    if (found > 0) total += found;
  });
  return total;
}

std::int64_t sanitize_values(Item& item, BufferPool& pool) {
  const Values& values = *item.values();
  const auto is_bad = [](double value) { return !is_finite(value); };
  const std::int64_t count = std::ranges::count_if(values, is_bad);
  if (count == 0) return 0;
  Values clean = values.buffer().unique() ? values : Values(values.size(), pool);
  std::ranges::replace_copy_if(values, clean.writable().begin(), is_bad, 0.0);
  item = std::move(clean);
  return count;
}

}  // namespace

std::string describe(const ReplacedValues& replaced) {
  return replaced.input + ": " + std::to_string(replaced.count) +
         (replaced.count == 1 ? " value was NaN or infinite and counts as " : " values were NaN or infinite and count as ") +
         (replaced.type == QUELL_TYPE_DEPTH ? "1e10 (no surface)" : "0");
}

std::int64_t sanitize(Item& item, Executor& executor, BufferPool& pool) {
  if (item.values()) return sanitize_values(item, pool);
  const Image* image = item.image();
  if (!image || info(image->type()).format != QUELL_FORMAT_F32) return 0;
  const std::int64_t count = count_non_finite(image->floats(), executor);
  if (count == 0) return 0;

  Image clean = image->buffer().unique() ? *image : Image(image->type(), image->size(), pool);
  const FloatImage in = image->floats();
  const FloatOutput out = clean.writable_floats();
  const float replacement = image->type() == QUELL_TYPE_DEPTH ? QUELL_NO_SURFACE_DEPTH : 0.0F;
  executor.run(in.height, [&](std::int64_t row, std::uint32_t) {
    const int y = static_cast<int>(row);
    for (int c = 0; c < in.channels; ++c)
      std::transform(in.row(y, c), in.row(y, c) + in.width, out.row(y, c),
                     [&](float value) { return is_finite(value) ? value : replacement; });
  });
  item = std::move(clean);
  return count;
}

}  // namespace quell
