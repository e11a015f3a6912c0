#include "quell/graph/absent.h"

#include <algorithm>
#include <bit>

namespace quell::detail {
namespace {

class Pruner {
 public:
  explicit Pruner(Unfolded& graph) : graph_(graph), absent_(graph.leaves.size(), false) {}

  std::vector<bool> run(const Connections& connections, Diagnostics& errors) {
    while (spread()) {}
    for (std::size_t i = 0; i < connections.outputs.size(); ++i)
      if (comes_from_nothing(connections.outputs[i])) tell(connections.outputs[i], graph_.root.document->outputs[i], errors);
    for (Leaf& leaf : graph_.leaves)
      for (std::size_t input = 0; input < leaf.inputs.size(); ++input) disconnect(leaf, input);
    for (Leaf& leaf : graph_.leaves)
      for (std::vector<Arrival>& port : leaf.inputs)
        for (Arrival& arrival : port)
          if (has_lost_initial(arrival)) arrival.edge.initial = {};
    return std::move(absent_);
  }

 private:
  bool is_absent(int leaf) const { return leaf >= 0 && absent_[static_cast<std::size_t>(leaf)]; }
  bool comes_from_nothing(const Arrival& arrival) const {
    if (arrival.state == Arrival::State::absent) return true;
    return arrival.state == Arrival::State::connected && is_absent(arrival.edge.from.node);
  }
  // An element of a list keeps its place, since elements of outputs may follow it.
  void disconnect(Leaf& leaf, std::size_t input) const {
    std::vector<Arrival>& port = leaf.inputs[input];
    const PortType any = static_cast<PortType>(std::countr_zero(leaf.input(input).types));
    for (Arrival& arrival : port)
      if (comes_from_nothing(arrival))
        arrival.state = Arrival::State::absent, arrival.edge.from = Endpoint::nothing(arrival.type.value_or(any)),
        arrival.edge.delay = 1, arrival.edge.initial = {};
    if (!(leaf.input(input).flags & QUELL_PORT_ARRAY))
      std::erase_if(port, [](const Arrival& arrival) { return arrival.state == Arrival::State::absent; });
  }
  bool has_lost_initial(const Arrival& arrival) const {
    return arrival.edge.initial.kind == Initial::Kind::endpoint && is_absent(arrival.edge.initial.endpoint.node);
  }
  // A delayed edge is worth nothing to a required port without its initial value.
  bool lacks_required(const Leaf& leaf, std::size_t input) const {
    if (leaf.input(input).flags & QUELL_PORT_OPTIONAL) return false;
    const std::vector<Arrival>& port = leaf.inputs[input];
    const auto is_lost = [&](const Arrival& arrival) { return comes_from_nothing(arrival) || has_lost_initial(arrival); };
    return std::any_of(port.begin(), port.end(), is_lost);
  }

  bool spread() {
    bool is_new = false;
    for (std::size_t i = 0; i < graph_.leaves.size(); ++i)
      for (std::size_t input = 0; input < graph_.leaves[i].inputs.size() && !absent_[i]; ++input)
        if (lacks_required(graph_.leaves[i], input)) absent_[i] = is_new = true;
    return is_new;
  }

  // Tells the error where the chain starts: at the port that the unconnected input feeds.
  void tell(const Arrival& output, const WrittenOutput& written, Diagnostics& errors) const {
    const Arrival* arrival = &output;
    std::vector<bool> was_seen(absent_.size(), false);
    while (arrival->state == Arrival::State::connected) {
      const auto index = static_cast<std::size_t>(arrival->edge.from.node);
      if (was_seen[index]) break;
      was_seen[index] = true;
      const Leaf& leaf = graph_.leaves[index];
      const Arrival* next = first_lost(leaf);
      if (!next) break;
      if (next->state == Arrival::State::absent) {
        std::vector<Note> notes = leaf.scope->included_from();
        notes.push_back({written.from.where, "the output '" + written.name.text + "' depends on it"});
        errors.error(next->edge.where,
                     "this optional input is not connected where the graph is used, but '" + leaf.name + "' needs it",
                     std::move(notes));
        return;
      }
      arrival = next;
    }
    errors.error(
        written.from.where,
        "'" + written.from.text + "' comes from an optional input of a subgraph that is not connected; expected a source for it");
  }
  const Arrival* first_lost(const Leaf& leaf) const {
    for (std::size_t i = 0; i < leaf.inputs.size(); ++i) {
      if (!lacks_required(leaf, i)) continue;
      for (const Arrival& arrival : leaf.inputs[i])
        if (comes_from_nothing(arrival)) return &arrival;
    }
    return nullptr;
  }

  Unfolded& graph_;
  std::vector<bool> absent_;
};

}  // namespace

std::vector<bool> leave_out_absent(Unfolded& graph, const Connections& connections, Diagnostics& errors) {
  return Pruner(graph).run(connections, errors);
}

}  // namespace quell::detail
