// What flows along an edge in one frame: an image, a camera, values, or nothing.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
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

using Values = std::vector<double>;

/// Copies are cheap and share what they hold; what an item holds is not changed any more.
class Item {
 public:
  Item() = default;
  Item(Image image) : content_(std::move(image)) {}                                           // NOLINT: an image is an item
  Item(Camera camera) : content_(std::make_shared<const CameraRecord>(std::move(camera))) {}  // NOLINT
  Item(Values values) : content_(std::make_shared<const Values>(std::move(values))) {}        // NOLINT

  explicit operator bool() const { return !std::holds_alternative<std::monostate>(content_); }
  /// Null when the item holds something else.
  const Image* image() const { return std::get_if<Image>(&content_); }
  const CameraRecord* camera() const { return get<CameraRecord>(); }
  const Values* values() const { return get<Values>(); }
  /// Only of an item that is there.
  PortType type() const;

 private:
  template <class T>
  const T* get() const {
    const auto* pointer = std::get_if<std::shared_ptr<const T>>(&content_);
    return pointer ? pointer->get() : nullptr;
  }
  std::variant<std::monostate, Image, std::shared_ptr<const CameraRecord>, std::shared_ptr<const Values>> content_;
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
