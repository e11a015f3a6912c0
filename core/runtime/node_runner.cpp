#include "quell/runtime/node_runner.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "quell/runtime/raw_port.h"
#include "quell/sdk/types.h"

namespace quell {
namespace {

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

  void place_outputs(const PortItems& in, PortItems& out) const {
    out.resize(layout.outputs.size());
    for (std::size_t o = 0; o < out.size(); ++o) {
      out[o].resize(layout.outputs[o].size());
      for (std::size_t i = 0; i < out[o].size(); ++i)
        out[o][i] = place_item(layout.outputs[o][i], item_in_place_of(in, layout.in_place_of[o], i), pool);
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
