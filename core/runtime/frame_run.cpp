#include "quell/runtime/frame_run.h"

#include <algorithm>
#include <chrono>

namespace quell {
namespace {

// Whether there is an item, of the type and size that were planned for.
bool fits(const Item& item, const Shape& planned) {
  return item && item.type() == planned.type && (!item.image() || item.image()->size() == planned.size);
}

}  // namespace

FrameRun::FrameRun(Plan plan, const HostServices& services, BufferPool& pool)
    : plan_(std::move(plan)), pool_(pool), history_(plan_) {
  for (std::size_t step = 0; step < plan_.nodes.size(); ++step) {
    const PlannedNode& planned = plan_.nodes[step];
    runners_.emplace_back(node(step).name, *node(step).instance,
                          NodeLayout{planned.outputs, planned.in_place_of, planned.scratch_bytes, planned.slot_scratch_bytes},
                          services, pool);
  }
}

Item FrameRun::Values::get(const Endpoint& endpoint) const {
  if (endpoint.node < 0) return inputs[static_cast<std::size_t>(endpoint.port)];
  const PortItems& ports = nodes[static_cast<std::size_t>(endpoint.node)];
  return ports.empty() ? Item() : ports[static_cast<std::size_t>(endpoint.port)][static_cast<std::size_t>(endpoint.item)];
}

void FrameRun::Values::drop(const Endpoint& endpoint) {
  if (endpoint.node < 0)
    inputs[static_cast<std::size_t>(endpoint.port)] = {};
  else
    nodes[static_cast<std::size_t>(endpoint.node)][static_cast<std::size_t>(endpoint.port)]
         [static_cast<std::size_t>(endpoint.item)] = {};
}

FrameResult FrameRun::compute(std::int64_t frame, std::vector<Item> inputs, const Ahead& ahead) {
  FrameResult result;
  history_.advance(frame - 1);  // what is left from an earlier time that this frame, or one after it, was computed, is void
  Values values{std::move(inputs), std::vector<PortItems>(plan_.graph->nodes.size())};
  for (std::size_t step = 0; step < plan_.nodes.size(); ++step) {
    const auto start = std::chrono::steady_clock::now();
    run_step(step, frame, values, ahead);
    result.node_seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  for (const PlannedResult& out : plan_.results()) result.outputs.emplace_back(out.name, values.get(out.from));
  keep_history(frame, values);
  return result;
}

void FrameRun::run_step(std::size_t step, std::int64_t frame, Values& values, const Ahead& ahead) {
  const Node& at = node(step);
  PortItems inputs(at.inputs.size());
  for (std::size_t port = 0; port < at.inputs.size(); ++port)
    for (const Edge& edge : at.inputs[port]) inputs[port].push_back(fetch(step, edge, frame, values, ahead));
  const PlannedNode& planned = plan_.nodes[step];
  // Whoever reads a value last holds it alone, so that it may be overwritten in place or its memory used again at once.
  for (const Endpoint& done : planned.last_uses)
    if (done.node != planned.node) values.drop(done);
  runners_[step].run(frame, inputs, values.nodes[static_cast<std::size_t>(planned.node)]);
  for (const Endpoint& unread : planned.last_uses)
    if (unread.node == planned.node) values.drop(unread);
}

Item FrameRun::fetch(std::size_t step, const Edge& edge, std::int64_t frame, const Values& values, const Ahead& ahead) {
  if (edge.delay == 0) return values.get(edge.from);
  Item item = edge.delay > 0 ? history_.find(edge.from, frame - edge.delay) : ahead(edge.from.port, -edge.delay);
  // History starts anew with another size, but what lies ahead may be of a size that the pass was not asked about.
  return fits(item, plan_.shape(edge.from)) ? item : initial(step, edge, values);
}

Item FrameRun::initial(std::size_t step, const Edge& edge, const Values& values) {
  if (edge.initial.kind == Initial::Kind::none) return {};
  if (edge.initial.kind == Initial::Kind::endpoint) return values.get(edge.initial.endpoint);
  Item& constant = constants_[&edge];
  if (!constant) {
    Shape shape = plan_.shape(edge.from);
    shape.type = plan_.graph->type(edge.from);
    // The source of a pruned edge has no size; its reader's other images tell it.
    if (!shape.present) shape.size = image_size(node(step));
    constant = make_constant(shape, edge.initial.constant);
  }
  return constant;
}

Size FrameRun::image_size(const Node& reader) const {
  for (const std::vector<Edge>& port : reader.inputs)
    for (const Edge& edge : port) {
      Shape shape = plan_.shape(edge.from);
      if (!shape.present && edge.initial.kind == Initial::Kind::endpoint) shape = plan_.shape(edge.initial.endpoint);
      if (shape.present && is_image(shape.type)) return shape.size;
    }
  return {};
}

Item FrameRun::make_constant(const Shape& shape, const std::vector<double>& values) {
  if (shape.type == QUELL_TYPE_VALUE) return quell::Values(values);
  const auto of_plane = [&](int c) { return values.size() == 1 ? values[0] : values[static_cast<std::size_t>(c)]; };
  Image image(shape.type, shape.size, pool_);
  for (int c = 0; c < image.channels(); ++c)
    for (int y = 0; y < image.height(); ++y) {
      if (info(shape.type).format == QUELL_FORMAT_U32)
        std::fill_n(image.writable_ids().row(y, c), image.width(), static_cast<std::uint32_t>(of_plane(c)));
      else
        std::fill_n(image.writable_floats().row(y, c), image.width(), static_cast<float>(of_plane(c)));
    }
  return image;
}

void FrameRun::keep_history(std::int64_t frame, const Values& values) {
  for (const PlannedHistory& kept : plan_.histories)
    if (kept.frames > 0) history_.add(kept.from, frame, values.get(kept.from));
  history_.advance(frame);
}

}  // namespace quell
