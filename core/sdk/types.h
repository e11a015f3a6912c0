// What the SDK's parts share: port types, image views, the error of a pass.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "quell/sdk/abi.h"

namespace quell {

/// A set of port types; `kColor | kAlbedo` accepts either. The meanings stand at quell_type in abi.h.
using Types = std::uint32_t;
inline constexpr Types kColor = QUELL_TYPE_BIT(QUELL_TYPE_COLOR);
inline constexpr Types kAlbedo = QUELL_TYPE_BIT(QUELL_TYPE_ALBEDO);
inline constexpr Types kNormal = QUELL_TYPE_BIT(QUELL_TYPE_NORMAL);
inline constexpr Types kPosition = QUELL_TYPE_BIT(QUELL_TYPE_POSITION);
inline constexpr Types kDepth = QUELL_TYPE_BIT(QUELL_TYPE_DEPTH);
inline constexpr Types kId = QUELL_TYPE_BIT(QUELL_TYPE_ID);
inline constexpr Types kMotion = QUELL_TYPE_BIT(QUELL_TYPE_MOTION);
inline constexpr Types kMoments = QUELL_TYPE_BIT(QUELL_TYPE_MOMENTS);
inline constexpr Types kVariance = QUELL_TYPE_BIT(QUELL_TYPE_VARIANCE);
inline constexpr Types kScalar = QUELL_TYPE_BIT(QUELL_TYPE_SCALAR);
inline constexpr Types kMask = QUELL_TYPE_BIT(QUELL_TYPE_MASK);
inline constexpr Types kAlpha = QUELL_TYPE_BIT(QUELL_TYPE_ALPHA);
inline constexpr Types kCamera = QUELL_TYPE_BIT(QUELL_TYPE_CAMERA);
inline constexpr Types kValue = QUELL_TYPE_BIT(QUELL_TYPE_VALUE);
/// Every image of float planes.
inline constexpr Types kAnyFloatImage =
    kColor | kAlbedo | kNormal | kPosition | kDepth | kMotion | kMoments | kVariance | kScalar | kMask | kAlpha;
inline constexpr Types kAnyImage = kAnyFloatImage | kId;

/// A planar image that somebody else owns. `Value` is float or uint32_t, const for inputs. False when absent.
template <class Value>
struct ImageView {
  int width = 0, height = 0, channels = 0;
  std::ptrdiff_t row_stride = 0, plane_stride = 0;  ///< in elements
  Value* data = nullptr;

  explicit operator bool() const { return data != nullptr; }
  /// The first pixel of row `y` of channel `c`. At least 64 bytes past the row's end may be read.
  Value* row(int y, int c = 0) const { return data + c * plane_stride + y * row_stride; }
  Value& at(int x, int y, int c = 0) const { return row(y, c)[x]; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  // A view to write to may be read from.
  operator ImageView<const Value>() const { return {width, height, channels, row_stride, plane_stride, data}; }
};

using FloatImage = ImageView<const float>;
using FloatOutput = ImageView<float>;
using IdImage = ImageView<const std::uint32_t>;
using IdOutput = ImageView<std::uint32_t>;

/// Thrown by Frame::parallel_rows when the run was cancelled; a pass lets it through.
struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace quell
