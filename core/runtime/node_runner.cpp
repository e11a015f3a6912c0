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
    items_.resize(items.size()), images_.resize(items.size()), values_.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) set_item(i, items[i]);
  }
  quell_port raw() const { return {sizeof(quell_port), static_cast<std::uint32_t>(items_.size()), items_.data()}; }
  // Which the pass may have lowered, in an output.
  std::size_t value_count(std::size_t i) const { return values_[i].count; }

 private:
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
      values_[i] = item.values()->raw();
      items_[i].values = &values_[i];
    }
  }
  std::vector<quell_item> items_;
  std::vector<quell_image> images_;
  std::vector<quell_values> values_;
};

void let_go(PortItems& ports) {
  for (std::vector<Item>& items : ports) std::ranges::fill(items, Item());
}

// Its content may be left as it is found, and it goes back to the pool after each frame like any other buffer.
struct Scratch {
  Buffer frame;
  Buffer slots;
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
  std::vector<void*> slot_pointers;

  Tables(std::string node, const PassInstance& instance, NodeLayout node_layout, const HostServices& host_services,
         BufferPool& buffers)
      : name(std::move(node)),
        pass(instance),
        layout(std::move(node_layout)),
        services(host_services),
        pool(buffers),
        host(host_services, name),
        raw_inputs(pass.desc().input_count),
        raw_outputs(pass.desc().output_count),
        inputs(raw_inputs.size()),
        outputs(raw_outputs.size()),
        slot_pointers(services.executor->slots()) {}

  Image place_image(const Shape& shape, int in_place_of, std::size_t item, const PortItems& in) const {
    if (in_place_of >= 0) {
      const std::vector<Item>& items = in[static_cast<std::size_t>(in_place_of)];
      const Image* image = item < items.size() ? items[item].image() : nullptr;
      const bool fits = image && image->size() == shape.size && info(image->type()).channels == info(shape.type).channels &&
                        info(image->type()).format == info(shape.type).format;
      if (fits && image->buffer().unique()) return image->as(shape.type);
    }
    return Image(shape.type, shape.size, pool);
  }

  Item place(std::size_t output, std::size_t item, const PortItems& in) const {
    const Shape& shape = layout.outputs[output][item];
    if (!shape.present) return {};
    if (shape.type == QUELL_TYPE_VALUE) return Values(shape.value_count, pool);
    return is_image(shape.type) ? Item(place_image(shape, layout.in_place_of[output], item, in)) : Item();
  }

  void place_outputs(const PortItems& in, PortItems& out) const {
    out.resize(layout.outputs.size());
    for (std::size_t o = 0; o < out.size(); ++o) {
      out[o].resize(layout.outputs[o].size());
      for (std::size_t i = 0; i < out[o].size(); ++i) out[o][i] = place(o, i, in);
    }
  }

  Scratch place_scratch() {
    // Whole cache lines, so that two slots never share one.
    const std::size_t slot_bytes = (layout.slot_scratch_bytes + 63) / 64 * 64;
    Scratch scratch;
    if (layout.scratch_bytes > 0) scratch.frame = pool.acquire(layout.scratch_bytes);
    if (slot_bytes == 0) return scratch;
    scratch.slots = pool.acquire(slot_bytes * slot_pointers.size());
    for (std::size_t slot = 0; slot < slot_pointers.size(); ++slot)
      slot_pointers[slot] = static_cast<std::byte*>(scratch.slots.data()) + slot * slot_bytes;
    return scratch;
  }

  quell_exec exec(std::int64_t frame, const Scratch& scratch) const {
    quell_exec call{};
    call.struct_size = sizeof(call);
    call.input_count = static_cast<std::uint32_t>(inputs.size());
    call.output_count = static_cast<std::uint32_t>(outputs.size());
    call.slot_count = static_cast<std::uint32_t>(slot_pointers.size());
    call.frame = frame;
    call.inputs = inputs.data();
    call.outputs = outputs.data();
    call.scratch = scratch.frame ? scratch.frame.data() : nullptr;
    call.slot_scratch = slot_pointers.data();
    return call;
  }

  void compute(std::int64_t frame, const PortItems& in, PortItems& out) {
    place_outputs(in, out);
    const Scratch scratch = place_scratch();
    for (std::size_t i = 0; i < in.size(); ++i) raw_inputs[i].set(in[i]), inputs[i] = raw_inputs[i].raw();
    for (std::size_t o = 0; o < out.size(); ++o) raw_outputs[o].set(out[o]), outputs[o] = raw_outputs[o].raw();

    host.begin(frame);
    const quell_status status = pass.process(host.raw(), exec(frame, scratch));
    if (host.was_cancelled()) throw Cancelled();
    const std::string reason = host.take_error();
    if (status != QUELL_OK) throw Error(Fault::frame, name, reason.empty() ? "the pass failed without giving a reason" : reason);
    for (std::size_t o = 0; o < out.size(); ++o)
      for (std::size_t i = 0; i < out[o].size(); ++i)
        if (const Values* values = out[o][i].values()) out[o][i] = values->first(raw_outputs[o].value_count(i));
  }
};

NodeRunner::NodeRunner(std::string name, const PassInstance& pass, NodeLayout layout, const HostServices& services,
                       BufferPool& pool)
    : tables_(std::make_unique<Tables>(std::move(name), pass, std::move(layout), services, pool)) {}
NodeRunner::~NodeRunner() = default;
NodeRunner::NodeRunner(NodeRunner&&) noexcept = default;

void NodeRunner::run(std::int64_t frame, PortItems& inputs, PortItems& outputs) {
  assert(inputs.size() == tables_->raw_inputs.size());
  try {
    tables_->compute(frame, inputs, outputs);
  } catch (...) {
    let_go(inputs), let_go(outputs);
    throw;
  }
  let_go(inputs);
}

}  // namespace quell
