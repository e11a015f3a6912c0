// A planar image of a port type, in a buffer of the pool.
#pragma once

#include <cstdint>

#include "quell/image/buffer_pool.h"
#include "quell/image/port_type.h"
#include "quell/sdk/frame.h"
#include "quell/sdk/types.h"

namespace quell {

/// Planes of float32 (uint32 for ids). Copies share the pixels: treat an image that has been handed on as read-only.
class Image {
 public:
  static constexpr int kMaxSize = 1 << 16;                        // pixels a side; larger ones come from broken headers
  static constexpr std::size_t kMaxBytes = std::size_t{1} << 40;  // in plans, which may be made on another machine

  Image() = default;
  /// Pixels are unspecified. Throws Error when a size is not within 1..kMaxSize or takes more memory than the machine has,
  /// std::bad_alloc when memory runs out.
  /// `spare_lines` cache lines are added to each row and plane: tests show with it that a pass heeds the strides.
  Image(PortType type, Size size, BufferPool& pool, int spare_lines = 0);

  explicit operator bool() const { return static_cast<bool>(buffer_); }
  PortType type() const { return type_; }
  Size size() const { return size_; }
  int width() const { return size_.width; }
  int height() const { return size_.height; }
  int channels() const { return info(type_).channels; }
  std::size_t bytes() const { return buffer_.bytes(); }
  static std::size_t bytes_needed(PortType type, Size size);
  /// Elements from a row to the next: whole cache lines, with at least 64 bytes after the last pixel.
  static std::ptrdiff_t row_stride(int width);

  /// The same pixels under another type of equal planes and format (a radiance that becomes a history).
  Image as(PortType type) const;
  const Buffer& buffer() const { return buffer_; }

  FloatImage floats() const { return view<const float>(QUELL_FORMAT_F32); }
  IdImage ids() const { return view<const std::uint32_t>(QUELL_FORMAT_U32); }
  FloatOutput writable_floats() { return view<float>(QUELL_FORMAT_F32); }
  IdOutput writable_ids() { return view<std::uint32_t>(QUELL_FORMAT_U32); }
  /// What crosses the plugin interface; it points into this image's pixels.
  quell_image raw() const;

 private:
  void require(quell_format format) const;
  template <class Value>
  ImageView<Value> view(quell_format format) const {
    require(format);
    return {size_.width, size_.height, channels(), row_stride_, plane_stride_, static_cast<Value*>(buffer_.data())};
  }
  PortType type_ = QUELL_TYPE_COLOR;
  Size size_;
  std::ptrdiff_t row_stride_ = 0, plane_stride_ = 0;
  Buffer buffer_;
};

}  // namespace quell
