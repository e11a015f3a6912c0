#include "quell/runtime/node_runner.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "quell/sdk/types.h"

namespace quell {
namespace {

// The items of one port as the C interface wants them. The pointers lead into this object, which must not move while they are
// used.
class RawPort {
 public:
  void set(const std::vector<Item>& items) {
    resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) set_item(i, items[i]);
  }
  // An output's values are written by the pass, so they need a place of their own.
  void set_output(const std::vector<Item>& items, const std::vector<Shape>& shapes) {
    set(items);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (!shapes[i].present || shapes[i].type != QUELL_TYPE_VALUE) continue;
      numbers_[i].assign(shapes[i].value_count, 0.0);
      values_[i] = {sizeof(quell_values), shapes[i].value_count, numbers_[i].data()};
      items_[i].type = QUELL_TYPE_VALUE;
      items_[i].values = &values_[i];
    }
  }
  quell_port raw() const { return {sizeof(quell_port), static_cast<std::uint32_t>(items_.size()), items_.data()}; }
  Values written_values(std::size_t i) const {
    const auto count = std::min<std::size_t>(values_[i].count, numbers_[i].size());
    return {numbers_[i].begin(), numbers_[i].begin() + static_cast<std::ptrdiff_t>(count)};
  }

 private:
  void resize(std::size_t count) { items_.resize(count), images_.resize(count), values_.resize(count), numbers_.resize(count); }
  void set_item(std::size_t i, const Item& item) {
    items_[i] = {sizeof(quell_item), 0, nullptr, nullptr, nullptr};
    if (!item) return;
    items_[i].type = static_cast<std::uint32_t>(item.type());
    if (item.image()) {
      images_[i] = item.image()->raw();
      items_[i].image = &images_[i];
    } else if (item.camera()) {
      items_[i].camera = &item.camera()->raw();
    } else {
      numbers_[i] = *item.values();
      values_[i] = {sizeof(quell_values), static_cast<std::uint32_t>(numbers_[i].size()), numbers_[i].data()};
      items_[i].values = &values_[i];
    }
  }
  std::vector<quell_item> items_;
  std::vector<quell_image> images_;
  std::vector<quell_values> values_;
  std::vector<Values> numbers_;
};

// Memory for a slot's scratch may be left uninitialized, and is given back after each frame like any other buffer.
struct Scratch {
  Buffer frame;
  Buffer slots;
  std::vector<void*> slot_pointers;
};

}  // namespace

struct NodeRunner::Tables {
  std::string name;
  const PassInstance& pass;
  NodeLayout layout;
  const HostServices& services;
  BufferPool& pool;
  Host host;
  std::vector<RawPort> raw_inputs, raw_outputs;
  std::vector<quell_port> inputs, outputs;
  Scratch scratch;

  Tables(std::string node, const PassInstance& instance, NodeLayout node_layout, const HostServices& host_services,
         BufferPool& buffers)
      : name(std::move(node)),
        pass(instance),
        layout(std::move(node_layout)),
        services(host_services),
        pool(buffers),
        host(host_services),
        raw_inputs(pass.desc().input_count),
        raw_outputs(pass.desc().output_count),
        inputs(raw_inputs.size()),
        outputs(raw_outputs.size()) {}

  static bool needs_buffer(const Shape& shape) { return shape.present && is_image(shape.type); }

  Image place(std::size_t output, std::size_t item, PortItems& in) {
    const Shape& shape = layout.outputs[output][item];
    if (const int source = layout.in_place_of[output]; source >= 0) {
      const std::vector<Item>& items = in[static_cast<std::size_t>(source)];
      const Image* image = item < items.size() ? items[item].image() : nullptr;
      const bool fits = image && image->size() == shape.size && info(image->type()).channels == info(shape.type).channels &&
                        info(image->type()).format == info(shape.type).format;
      if (fits && image->buffer().unique()) return image->as(shape.type);
    }
    return Image(shape.type, shape.size, pool);
  }

  void place_outputs(PortItems& in, PortItems& out) {
    out.assign(layout.outputs.size(), {});
    for (std::size_t o = 0; o < layout.outputs.size(); ++o)
      for (std::size_t i = 0; i < layout.outputs[o].size(); ++i)
        out[o].push_back(needs_buffer(layout.outputs[o][i]) ? Item(place(o, i, in)) : Item());
  }

  void place_scratch() {
    const std::size_t slots = services.executor->slots();
    // Whole cache lines, so that two slots never share one.
    const std::size_t slot_bytes = (layout.slot_scratch_bytes + 63) / 64 * 64;
    if (layout.scratch_bytes > 0) scratch.frame = pool.acquire(layout.scratch_bytes);
    if (slot_bytes > 0) scratch.slots = pool.acquire(slot_bytes * slots);
    scratch.slot_pointers.assign(slots, nullptr);
    if (slot_bytes == 0) return;
    for (std::size_t slot = 0; slot < slots; ++slot)
      scratch.slot_pointers[slot] = static_cast<std::byte*>(scratch.slots.data()) + slot * slot_bytes;
  }

  quell_exec exec(std::int64_t frame) const {
    quell_exec call{};
    call.struct_size = sizeof(call);
    call.input_count = static_cast<std::uint32_t>(inputs.size());
    call.output_count = static_cast<std::uint32_t>(outputs.size());
    call.slot_count = services.executor->slots();
    call.frame = frame;
    call.inputs = inputs.data();
    call.outputs = outputs.data();
    call.scratch = scratch.frame ? scratch.frame.data() : nullptr;
    call.slot_scratch = scratch.slot_pointers.data();
    return call;
  }
};

NodeRunner::NodeRunner(std::string name, const PassInstance& pass, NodeLayout layout, const HostServices& services,
                       BufferPool& pool)
    : tables_(std::make_unique<Tables>(std::move(name), pass, std::move(layout), services, pool)) {}
NodeRunner::~NodeRunner() = default;
NodeRunner::NodeRunner(NodeRunner&&) noexcept = default;

void NodeRunner::run(std::int64_t frame, PortItems& inputs, PortItems& outputs) {
  Tables& t = *tables_;
  assert(inputs.size() == t.raw_inputs.size());
  t.place_outputs(inputs, outputs);
  t.place_scratch();
  for (std::size_t i = 0; i < inputs.size(); ++i) t.raw_inputs[i].set(inputs[i]), t.inputs[i] = t.raw_inputs[i].raw();
  for (std::size_t o = 0; o < outputs.size(); ++o)
    t.raw_outputs[o].set_output(outputs[o], t.layout.outputs[o]), t.outputs[o] = t.raw_outputs[o].raw();

  t.host.take_error();
  const quell_status status = t.pass.process(t.host.raw(), t.exec(frame));
  t.scratch = {};
  inputs.clear();
  const std::string reason = t.host.take_error();
  if (status == QUELL_CANCELLED && t.services.cancelled && t.services.cancelled()) throw Cancelled();
  if (status != QUELL_OK) throw Error(Fault::frame, t.name, reason.empty() ? "the pass failed without giving a reason" : reason);
  for (std::size_t o = 0; o < outputs.size(); ++o)
    for (std::size_t i = 0; i < outputs[o].size(); ++i)
      if (t.layout.outputs[o][i].present && t.layout.outputs[o][i].type == QUELL_TYPE_VALUE)
        outputs[o][i] = t.raw_outputs[o].written_values(i);
}

}  // namespace quell
