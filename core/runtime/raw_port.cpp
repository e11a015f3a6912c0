#include "quell/runtime/raw_port.h"

namespace quell {

void RawPort::set(const std::vector<Item>& items) {
  items_.resize(items.size()), images_.resize(items.size()), values_.resize(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) set_item(i, items[i]);
}

void RawPort::set_image(std::size_t i, const quell_image& image) {
  images_[i] = image;
  items_[i] = {sizeof(quell_item), image.type, &images_[i], nullptr, nullptr};
}

void RawPort::set_item(std::size_t i, const Item& item) {
  items_[i] = {sizeof(quell_item), 0, nullptr, nullptr, nullptr};
  if (!item) return;
  items_[i].type = static_cast<std::uint32_t>(item.type());
  if (item.image()) {
    images_[i] = item.image()->raw();
    items_[i].image = &images_[i];
  } else if (item.camera()) {
    items_[i].camera = &item.camera()->raw();
  } else {
    values_[i] = item.values()->raw();
    items_[i].values = &values_[i];
  }
}

Item place_item(const Shape& shape, const Image* replaced, BufferPool& pool) {
  if (!shape.present) return {};
  if (shape.type == QUELL_TYPE_VALUE) return Values(shape.value_count, pool);
  if (!is_image(shape.type)) return {};
  const bool fits = replaced && replaced->size() == shape.size && info(replaced->type()).channels == info(shape.type).channels &&
                    info(replaced->type()).format == info(shape.type).format;
  if (fits && replaced->buffer().unique()) return replaced->as(shape.type);
  return Image(shape.type, shape.size, pool);
}

const Image* item_in_place_of(const PortItems& inputs, int input, std::size_t i) {
  if (input < 0) return nullptr;
  const std::vector<Item>& items = inputs[static_cast<std::size_t>(input)];
  return i < items.size() ? items[i].image() : nullptr;
}

}  // namespace quell
