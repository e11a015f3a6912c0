#include "quell/sequence/convert.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "quell/text/error.h"

namespace quell {
namespace {

constexpr float kFarthestSurface = 1e9F;  // renderers write 1e10 (Cycles), 1e30 or infinity for "nothing hit"

[[noreturn]] void fail_id(const std::string& file, int x, int y, float value, std::optional<std::int64_t> background) {
  std::ostringstream text;
  text.precision(9);
  text << "pixel (" << x << ", " << y << ") holds " << value << ", which is no object index (an integer from 0, or "
       << (background ? std::to_string(*background) : "a negative number") << " for the background)";
  throw Error(Fault::input, file, text.str());
}

template <class Output, class Value>
void fill_rows(Output out, const Rectangle& covered, Value value) {
  for (int c = 0; c < out.channels; ++c) {
    for (int y = 0; y < out.height; ++y) {
      auto* row = out.row(y, c);
      const bool outside = y < covered.y || y >= covered.y + covered.height;
      std::fill(row, row + (outside ? out.width : covered.x), value);
      if (!outside) std::fill(row + covered.x + covered.width, row + out.width, value);
    }
  }
}

}  // namespace

void mark_no_surface(FloatOutput depth) {
  for (int y = 0; y < depth.height; ++y)
    for (float& z : std::span(depth.row(y), static_cast<std::size_t>(depth.width)))
      if (z == 0 || z >= kFarthestSurface || std::isinf(z)) z = QUELL_NO_SURFACE_DEPTH;
}

void convert_ids(FloatImage from, std::optional<std::int64_t> background, const std::string& file, IdOutput to) {
  for (int y = 0; y < from.height; ++y) {
    for (int x = 0; x < from.width; ++x) {
      const float value = from.row(y)[x];
      const bool no_surface = background ? value == static_cast<float>(*background) : value < 0;
      if (no_surface) {
        to.row(y)[x] = QUELL_NO_ID;
      } else if (value >= 0 && value < 4294967295.0F && value == std::floor(value)) {  // the constant rounds to 2^32
        to.row(y)[x] = static_cast<std::uint32_t>(value);
      } else {
        fail_id(file, x, y, value, background);
      }
    }
  }
}

void convert_ids(std::optional<std::int64_t> background, IdOutput ids) {
  if (!background || *background < 0 || *background > std::int64_t{QUELL_NO_ID}) return;
  for (int y = 0; y < ids.height; ++y)
    std::replace(ids.row(y), ids.row(y) + ids.width, static_cast<std::uint32_t>(*background), QUELL_NO_ID);
}

void fill_outside(Image& image, const Rectangle& covered) {
  if (covered == Rectangle{0, 0, image.width(), image.height()}) return;
  if (image.type() == QUELL_TYPE_ID) return fill_rows(image.writable_ids(), covered, QUELL_NO_ID);
  fill_rows(image.writable_floats(), covered, image.type() == QUELL_TYPE_DEPTH ? QUELL_NO_SURFACE_DEPTH : 0.0F);
}

}  // namespace quell
