// What flows along an edge in one frame: an image, a camera, values, or nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "quell/image/image.h"

namespace quell {

/// 4x4, row-major, for column vectors.
using Matrix = std::array<double, 16>;
inline constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// The record behind quell_camera, which documents the fields.
class Camera {
 public:
  Matrix world_to_camera = kIdentity;
  Matrix world_to_screen = kIdentity;
  Size size;
  std::array<double, 2> jitter{};
  std::map<std::uint32_t, Matrix> object_to_world;
};

/// A camera made ready for the plugin interface. Immutable, shared by all who hold it.
class CameraRecord {
 public:
  explicit CameraRecord(Camera camera);
  const Camera& camera() const { return camera_; }
  const quell_camera& raw() const { return raw_; }

 private:
  Camera camera_;
  std::vector<std::uint32_t> ids_;
  std::vector<double> matrices_;
  quell_camera raw_{};
};

/// A list of numbers. Copies share them: treat a list that has been handed on as read-only. Making one takes memory, copying and
/// dropping never does.
class Values {
 public:
  using value_type = double;
  using iterator = const double*;
  using const_iterator = const double*;

  Values() = default;
  Values(std::initializer_list<double> values) : Values(std::span<const double>(values.begin(), values.size())) {}
  explicit Values(std::span<const double> values);
  /// Zeros, in memory of the pool.
  Values(std::size_t count, BufferPool& pool);

  std::size_t size() const { return count_; }
  const double* data() const { return count_ > 0 ? static_cast<const double*>(buffer_.data()) : nullptr; }
  const double* begin() const { return data(); }
  const double* end() const { return data() + count_; }
  double operator[](std::size_t i) const { return data()[i]; }
  bool operator==(const Values& other) const { return std::ranges::equal(*this, other); }

  /// The same numbers without those from `count` on.
  Values first(std::size_t count) const;
  const Buffer& buffer() const { return buffer_; }
  std::span<double> writable() { return {const_cast<double*>(data()), count_}; }
  /// What crosses the plugin interface; it points at these numbers.
  quell_values raw() const;

 private:
  std::size_t count_ = 0;
  Buffer buffer_;  // none for an empty list
};

/// Copies share what they hold, and cost no allocation; what an item holds is not changed any more.
class Item {
 public:
  Item() = default;
  Item(Image image) : content_(std::move(image)) {}                                           // NOLINT: an image is an item
  Item(Camera camera) : content_(std::make_shared<const CameraRecord>(std::move(camera))) {}  // NOLINT
  Item(Values values) : content_(std::move(values)) {}                                        // NOLINT

  explicit operator bool() const { return !std::holds_alternative<std::monostate>(content_); }
  /// Null when the item holds something else.
  const Image* image() const { return std::get_if<Image>(&content_); }
  const CameraRecord* camera() const {
    const auto* record = std::get_if<std::shared_ptr<const CameraRecord>>(&content_);
    return record ? record->get() : nullptr;
  }
  const Values* values() const { return std::get_if<Values>(&content_); }
  /// Only of an item that is there.
  PortType type() const;

 private:
  std::variant<std::monostate, Image, std::shared_ptr<const CameraRecord>, Values> content_;
};

/// What is known of an item before it is computed.
struct Shape {
  PortType type = QUELL_TYPE_COLOR;
  Size size;                      ///< 0 x 0 for cameras and values
  std::uint32_t value_count = 0;  ///< for QUELL_TYPE_VALUE
  bool present = true;
};

/// The shape of an item that is there.
Shape shape_of(const Item& item);

}  // namespace quell
