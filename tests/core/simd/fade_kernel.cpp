// Darkens what is bright: color 2^-(luminance / knee). Rows [y0, y1).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fade_kernel.cpp"  // from the project's root
#include <hwy/foreach_target.h>

#include "quell/sdk/types.h"
#include "quell/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fade::HWY_NAMESPACE {
using namespace quell::simd::HWY_NAMESPACE;

void FadeRows(const quell::FloatImage& in, float knee, const quell::FloatOutput& out, int y0, int y1) {
  const V gain = set(1 / knee), limit = set(127 * knee);
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < out.width; x += lanes()) {
      const V3 color = load(in.row(y) + x, in.plane_stride);
      const V weight = exp2_negative(luminance(color), gain, limit);
      store(mul(weight, color), out.width - x, out.row(y) + x, out.plane_stride);
    }
}

}  // namespace fade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE  // once, not for every vector unit
namespace fade {

HWY_EXPORT(FadeRows);
void fade_rows(const quell::FloatImage& in, float knee, const quell::FloatOutput& out, int y0, int y1) {
  HWY_DYNAMIC_DISPATCH(FadeRows)(in, knee, out, y0, y1);
}

}  // namespace fade
#endif
