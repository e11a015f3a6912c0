#include "quell/runtime/wiring.h"

#include <algorithm>
#include <map>

namespace quell {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

class Builder {
 public:
  Builder(const Plan& plan, Wiring& wiring) : plan_(plan), wiring_(wiring) {}

  void build() {
    number_values();
    for (const PlannedResult& result : plan_.results()) {
      const int value = value_of(result.from);
      wiring_.results.emplace_back(result.name, value);
      ++wiring_.readers[at(value)];
    }
    for (std::size_t line = 0; line < plan_.histories.size(); ++line) {
      if (plan_.histories[line].frames == 0) continue;
      lines_[plan_.histories[line].from] = static_cast<int>(line);
      wiring_.lines[at(value_of(plan_.histories[line].from))].push_back(static_cast<int>(line));
    }
    wiring_.steps.resize(plan_.turns.size());
    for (std::size_t step = 0; step < plan_.turns.size(); ++step)
      for (const int position : plan_.turns[step].nodes) wire(static_cast<int>(step), position);
  }

 private:
  const Node& node(int position) const { return plan_.graph->nodes[at(plan_.nodes[at(position)].node)]; }

  void number_values() {
    for (std::size_t input = 0; input < plan_.inputs.size(); ++input) add_value({-1, static_cast<int>(input), 0}, -1);
    std::vector<int> steps(plan_.nodes.size());
    for (std::size_t step = 0; step < plan_.turns.size(); ++step)
      for (const int position : plan_.turns[step].nodes) steps[at(position)] = static_cast<int>(step);
    for (std::size_t position = 0; position < plan_.nodes.size(); ++position) {
      const PlannedNode& planned = plan_.nodes[position];
      wiring_.nodes.emplace_back().first_output = static_cast<int>(producers_.size());
      for (std::size_t port = 0; port < planned.outputs.size(); ++port)
        for (std::size_t item = 0; item < planned.outputs[port].size(); ++item)
          add_value({planned.node, static_cast<int>(port), static_cast<int>(item)}, steps[position]);
    }
    wiring_.readers.resize(producers_.size());
    wiring_.lines.resize(producers_.size());
  }

  void add_value(const Endpoint& endpoint, int producer) {
    values_[endpoint] = static_cast<int>(producers_.size());
    producers_.push_back(producer);
  }

  // -1 for what no node of the plan yields.
  int value_of(const Endpoint& endpoint) const {
    const auto found = values_.find(endpoint);
    return found == values_.end() ? -1 : found->second;
  }

  void wire(int step, int position) {
    for (const std::vector<Edge>& port : node(position).inputs) {
      std::vector<Fetch>& fetches = wiring_.nodes[at(position)].fetches.emplace_back();
      for (const Edge& edge : port) fetches.push_back(fetch(step, position, edge));
    }
    wire_resets(step, position);
  }

  void wire_resets(int step, int position) {
    WiredNode& wired = wiring_.nodes[at(position)];
    int longest = 0;
    for (const std::vector<Fetch>& port : wired.fetches)
      for (const Fetch& fetch : port) longest = std::max(longest, fetch.line >= 0 ? fetch.delay : 0);
    if (longest == 0) return;
    for (const Endpoint& endpoint : node(position).resets) {
      const int value = plan_.shape(endpoint).present ? value_of(endpoint) : -1;
      if (value < 0) continue;
      wired.resets.push_back(reset(value));
      const int producer = producers_[at(value)];
      if (producer < 0) continue;  // inputs are there when a frame begins
      need(step, producer);
      wiring_.steps[at(step)].reset_waits.push_back({producer, longest});
      wiring_.steps[at(producer)].resets_for.push_back({step, longest});
    }
  }

  int reset(int value) {
    const auto found = std::ranges::find(wiring_.resets, value, &WiredReset::value);
    const auto index = static_cast<int>(found - wiring_.resets.begin());
    if (found == wiring_.resets.end()) wiring_.resets.push_back({value, producers_[at(value)]});
    return index;
  }

  Fetch fetch(int step, int position, const Edge& edge) {
    Fetch fetch;
    fetch.planned.present = false;
    if (!edge.from.is_nothing()) fetch.planned = plan_.shape(edge.from);
    if (edge.delay == 0) {
      const int value = value_of(edge.from);
      if (value >= 0 && producers_[at(value)] == step) return fetch;  // whoever runs fused nodes knows where it is
      fetch.value = value;
      read(step, value);
      return fetch;
    }
    if (const auto line = lines_.find(edge.from); edge.delay > 0 && line != lines_.end()) {
      fetch.line = line->second;
      fetch.delay = edge.delay;
      wait(step, producers_[at(value_of(edge.from))], edge.delay);
    }
    if (edge.delay < 0 && fetch.planned.present) fetch.ahead = ahead(edge.from.port, -edge.delay);
    if (edge.initial.kind == Initial::Kind::endpoint) {
      fetch.initial = value_of(edge.initial.endpoint);
      read(step, fetch.initial);
    }
    if (edge.initial.kind == Initial::Kind::constant) fetch.constant = constant(position, edge);
    return fetch;
  }

  void read(int step, int value) {
    if (value < 0) return;
    ++wiring_.readers[at(value)];
    if (producers_[at(value)] >= 0) need(step, producers_[at(value)]);
  }

  void need(int step, int producer) {
    std::vector<int>& needs = wiring_.steps[at(step)].needs;
    if (std::ranges::find(needs, producer) != needs.end()) return;
    needs.push_back(producer);
    wiring_.steps[at(producer)].feeds.push_back(step);
  }

  void wait(int step, int producer, int delay) {
    std::vector<DelayedWait>& waits = wiring_.steps[at(step)].waits;
    const auto same = [&](const DelayedWait& known) { return known.step == producer && known.delay == delay; };
    if (producer < 0 || std::ranges::find_if(waits, same) != waits.end()) return;  // inputs are there when a frame begins
    waits.push_back({producer, delay});
    wiring_.steps[at(producer)].awaited_by.push_back({step, delay});
  }

  int ahead(int input, int frames) {
    const auto same = [&](const AheadRead& known) { return known.input == input && known.frames == frames; };
    const auto found = std::ranges::find_if(wiring_.ahead, same);
    const auto index = static_cast<int>(found - wiring_.ahead.begin());
    if (found == wiring_.ahead.end()) wiring_.ahead.push_back({input, frames});
    return index;
  }

  int constant(int position, const Edge& edge) {
    Shape shape = edge.from.is_nothing() ? Shape{} : plan_.shape(edge.from);
    shape.type = plan_.graph->type(edge.from);
    // The source of a pruned edge has no size; its reader's other images tell it.
    if (!shape.present) shape.size = image_size(node(position));
    wiring_.constants.push_back({shape, edge.initial.constant});
    return static_cast<int>(wiring_.constants.size()) - 1;
  }

  // The one size of the images that a node reads.
  Size image_size(const Node& reader) const {
    for (std::size_t port = 0; port < reader.inputs.size(); ++port)
      for (const Edge& edge : reader.inputs[port]) {
        if (QUELL_AT(quell_port_desc, reader.pass->inputs, port)->flags & QUELL_PORT_ANY_SIZE) continue;
        Shape shape{.present = false};
        if (!edge.from.is_nothing()) shape = plan_.shape(edge.from);
        if (!shape.present && edge.initial.kind == Initial::Kind::endpoint) shape = plan_.shape(edge.initial.endpoint);
        if (shape.present && is_image(shape.type)) return shape.size;
      }
    return {};
  }

  const Plan& plan_;
  Wiring& wiring_;
  std::map<Endpoint, int> values_, lines_;
  std::vector<int> producers_;  // step of each value; -1 for graph inputs
};

}  // namespace

Wiring::Wiring(const Plan& plan) { Builder(plan, *this).build(); }

}  // namespace quell
