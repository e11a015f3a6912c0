#include "quell/image/item.h"

#include <cassert>

namespace quell {

CameraRecord::CameraRecord(Camera camera) : camera_(std::move(camera)) {
  for (const auto& [id, matrix] : camera_.object_to_world) {
    ids_.push_back(id);
    matrices_.insert(matrices_.end(), matrix.begin(), matrix.end());
  }
  raw_.struct_size = sizeof(raw_);
  raw_.width = camera_.size.width;
  raw_.height = camera_.size.height;
  std::ranges::copy(camera_.world_to_camera, raw_.world_to_camera);
  std::ranges::copy(camera_.world_to_screen, raw_.world_to_screen);
  std::ranges::copy(camera_.jitter, raw_.jitter);
  raw_.object_count = static_cast<std::uint32_t>(ids_.size());
  raw_.object_ids = ids_.data();
  raw_.object_to_world = matrices_.data();
}

Values::Values(std::span<const double> values) : count_(values.size()) {
  if (count_ == 0) return;
  buffer_ = Buffer::allocate(values.size_bytes());
  std::ranges::copy(values, writable().begin());
}

Values::Values(std::size_t count, BufferPool& pool) : count_(count) {
  if (count_ == 0) return;
  buffer_ = pool.acquire(count * sizeof(double));
  std::ranges::fill(writable(), 0.0);
}

Values Values::first(std::size_t count) const {
  Values shorter = *this;
  shorter.count_ = std::min(count, count_);
  return shorter;
}

quell_values Values::raw() const {
  return {sizeof(quell_values), static_cast<std::uint32_t>(count_), const_cast<double*>(data())};  // NOLINT: read-only for inputs
}

PortType Item::type() const {
  assert(*this);
  if (image()) return image()->type();
  return camera() ? QUELL_TYPE_CAMERA : QUELL_TYPE_VALUE;
}

Shape shape_of(const Item& item) {
  Shape shape{item.type(), {}, 0, true};
  if (item.image()) shape.size = item.image()->size();
  if (item.values()) shape.value_count = static_cast<std::uint32_t>(item.values()->size());
  return shape;
}

}  // namespace quell
