// Items of a port as the C interface wants them, and where those of outputs lie. Private to this box.
#pragma once

#include <cstdint>
#include <vector>

#include "quell/image/item.h"
#include "quell/sdk/abi.h"

namespace quell {

using PortItems = std::vector<std::vector<Item>>;  // items of each port

/// The pointers lead into this object, which must not move while they are used. Keeps its tables, so that nothing is allocated
/// once it has held as many items.
class RawPort {
 public:
  void set(const std::vector<Item>& items);
  /// Instead of an item: an image of which only some rows are there.
  void set_image(std::size_t i, const quell_image& image);
  quell_port raw() const { return {sizeof(quell_port), static_cast<std::uint32_t>(items_.size()), items_.data()}; }
  /// Which the pass may have lowered, in an output.
  std::size_t value_count(std::size_t i) const { return values_[i].count; }

 private:
  void set_item(std::size_t i, const Item& item);
  std::vector<quell_item> items_;
  std::vector<quell_image> images_;
  std::vector<quell_values> values_;
};

/// Memory for an item of an output: that of `replaced`, which may be null, where it fits and nobody else holds it.
Item place_item(const Shape& shape, const Image* replaced, BufferPool& pool);
/// The image at item `i` of the input that an output takes the place of; null when there is none. `input` may be -1.
const Image* item_in_place_of(const PortItems& inputs, int input, std::size_t i);

}  // namespace quell
