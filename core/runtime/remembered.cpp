#include "quell/runtime/remembered.h"

#include <algorithm>
#include <cstring>

#include "quell/runtime/sanitize.h"

namespace quell {
namespace {

bool is_of(const Item& item, const Shape& shape) {
  const Shape found = shape_of(item);
  return found.type == shape.type && found.size == shape.size && found.value_count == shape.value_count;
}

}  // namespace

void Remembered::expect(const std::string& name, const Shape& shape) {
  const std::scoped_lock lock(mutex_);
  values_.try_emplace(name, Value{shape, {}, false});
}

void Remembered::forget(std::string_view name) {
  const std::scoped_lock lock(mutex_);
  if (const auto found = values_.find(name); found != values_.end()) values_.erase(found);
}

void Remembered::forget_all() {
  const std::scoped_lock lock(mutex_);
  values_.clear();
  pool_.trim();
}

void Remembered::forget_others(const std::set<std::string>& names) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(values_, [&](const auto& value) { return !names.contains(value.first); });
  pool_.trim();
}

bool Remembered::expects(std::string_view name) const {
  const std::scoped_lock lock(mutex_);
  const auto found = values_.find(name);
  return found != values_.end() && !found->second.is_unfit;
}

std::optional<Shape> Remembered::shape(std::string_view name) const {
  const std::scoped_lock lock(mutex_);
  const auto found = values_.find(name);
  return found == values_.end() ? std::nullopt : std::optional(found->second.shape);
}

Item Remembered::find(std::string_view name, std::int64_t frame) const {
  const std::scoped_lock lock(mutex_);
  const auto found = values_.find(name);
  if (found == values_.end()) return {};
  const auto item = found->second.items.find(frame);
  return item == found->second.items.end() ? Item() : item->second;
}

bool Remembered::has_all(std::string_view name, const std::vector<std::int64_t>& frames) const {
  const std::scoped_lock lock(mutex_);
  const auto found = values_.find(name);
  if (found == values_.end() || found->second.is_unfit) return false;
  return std::ranges::all_of(frames, [&](std::int64_t frame) { return found->second.items.contains(frame); });
}

// So that the pool of the run that made it can go.
Item Remembered::copy(const Item& item) {
  if (const Values* values = item.values()) {
    Values numbers(values->size(), pool_);
    std::ranges::copy(*values, numbers.writable().begin());
    return numbers;
  }
  const Image* image = item.image();
  if (!image) return item;  // cameras are shared by all who hold them
  Image twin(image->type(), image->size(), pool_);
  const quell_image from = image->raw(), to = twin.raw();
  const auto row = [](const quell_image& of, int y, int c) {
    return static_cast<char*>(of.data) + (c * of.plane_stride + y * of.row_stride) * std::ptrdiff_t{sizeof(float)};
  };
  for (int c = 0; c < image->channels(); ++c)
    for (int y = 0; y < image->height(); ++y)
      std::memcpy(row(to, y, c), row(from, y, c), static_cast<std::size_t>(image->width()) * sizeof(float));
  return twin;
}

void Remembered::put(std::string_view name, std::int64_t frame, const Item& item, bool is_input) {
  if (!expects(name)) return;
  Item twin;
  const std::optional<Shape> expected = shape(name);
  bool fits = item && expected && is_of(item, *expected);
  if (fits) {
    twin = copy(item);
    fits = is_input || sanitize(twin, alone_, pool_) == 0;
  }
  const std::scoped_lock lock(mutex_);
  const auto found = values_.find(name);
  if (found == values_.end() || found->second.is_unfit) return;
  if (fits) {
    found->second.items[frame] = std::move(twin);
  } else if (!is_input) {
    found->second.is_unfit = true;
    found->second.items.clear();
  }
}

std::optional<Shape> RememberingSource::shape(std::string_view input) {
  const bool is_fed = fed_.contains(std::string(input));
  std::optional<Shape> shape = is_fed ? memory_.shape(input) : source_.shape(input);
  const std::scoped_lock lock(mutex_);
  shapes_[std::string(input)] = shape;
  return shape;
}

Item RememberingSource::read(std::string_view input, std::int64_t frame, BufferPool& pool) {
  if (Item known = memory_.find(input, frame)) return known;
  try {
    Item item = read_source(input, frame, pool);
    memory_.put(input, frame, item, true);
    return item;
  } catch (...) {
    steady_ = false;
    throw;
  }
}

Item RememberingSource::read_source(std::string_view input, std::int64_t frame, BufferPool& pool) {
  Item item = source_.read(input, frame, pool);
  const std::scoped_lock lock(mutex_);
  const auto planned = shapes_.find(input);
  if (!item || planned == shapes_.end() || !planned->second || !is_of(item, *planned->second)) steady_ = false;
  return item;
}

void RememberingSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  if (output.starts_with(kMark)) return memory_.put(output.substr(kMark.size()), frame, item, false);
  try {
    sink_.write(output, frame, item);
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    failed_.insert(frame);
    throw;
  }
}

bool RememberingSink::has_failed(std::int64_t frame) const {
  const std::scoped_lock lock(mutex_);
  return failed_.contains(frame);
}

}  // namespace quell
