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
    for (const PlannedTurn& turn : plan_.turns)
      for (const int position : turn.nodes) wire(position);
    find_feeds();
  }

 private:
  const Node& node(int position) const { return plan_.graph->nodes[at(plan_.nodes[at(position)].node)]; }

  void number_values() {
    for (std::size_t input = 0; input < plan_.inputs.size(); ++input) add_value({-1, static_cast<int>(input), 0}, -1);
    steps_.resize(plan_.nodes.size());
    for (std::size_t step = 0; step < plan_.turns.size(); ++step)
      for (const int position : plan_.turns[step].nodes) steps_[at(position)] = static_cast<int>(step);
    for (std::size_t position = 0; position < plan_.nodes.size(); ++position) {
      const PlannedNode& planned = plan_.nodes[position];
      wiring_.nodes.emplace_back().first_output = static_cast<int>(producers_.size());
      for (std::size_t port = 0; port < planned.outputs.size(); ++port)
        for (std::size_t item = 0; item < planned.outputs[port].size(); ++item)
          add_value({planned.node, static_cast<int>(port), static_cast<int>(item)}, static_cast<int>(position));
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

  void wire(int position) {
    for (const std::vector<Edge>& port : node(position).inputs) {
      std::vector<Fetch>& fetches = wiring_.nodes[at(position)].fetches.emplace_back();
      for (const Edge& edge : port) fetches.push_back(fetch(position, edge));
    }
    wire_resets(position);
  }

  void wire_resets(int position) {
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
      need(position, producer);
      const int step = steps_[at(position)], yields = steps_[at(producer)];
      wiring_.steps[at(step)].reset_waits.push_back({yields, longest});
      wiring_.steps[at(yields)].resets_for.push_back({step, longest});
    }
  }

  int reset(int value) {
    const auto found = std::ranges::find(wiring_.resets, value, &WiredReset::value);
    const auto index = static_cast<int>(found - wiring_.resets.begin());
    if (found == wiring_.resets.end()) wiring_.resets.push_back({value, step_of(value)});
    return index;
  }

  // -1 for graph inputs.
  int step_of(int value) const { return producers_[at(value)] < 0 ? -1 : steps_[at(producers_[at(value)])]; }

  Fetch fetch(int position, const Edge& edge) {
    Fetch fetch;
    fetch.planned.present = false;
    if (!edge.from.is_nothing()) fetch.planned = plan_.shape(edge.from);
    if (edge.delay == 0) {
      fetch.value = read(position, value_of(edge.from));
      return fetch;
    }
    if (const auto line = lines_.find(edge.from); edge.delay > 0 && line != lines_.end()) {
      fetch.line = line->second;
      fetch.delay = edge.delay;
      wait(steps_[at(position)], step_of(value_of(edge.from)), edge.delay);
    }
    if (edge.delay < 0 && fetch.planned.present) fetch.ahead = ahead(edge.from.port, -edge.delay);
    if (edge.initial.kind == Initial::Kind::endpoint) fetch.initial = read(position, value_of(edge.initial.endpoint));
    if (edge.initial.kind == Initial::Kind::constant) fetch.constant = constant(position, edge);
    return fetch;
  }

  // The value that is to be fetched; none of what a fused node yields, since whoever runs these knows where it is.
  int read(int position, int value) {
    if (value < 0) return -1;
    const int producer = producers_[at(value)];
    if (producer >= 0) need(position, producer);
    if (producer >= 0 && steps_[at(producer)] == steps_[at(position)]) return -1;
    ++wiring_.readers[at(value)];
    return value;
  }

  void need(int position, int producer) {
    const auto add = [](std::vector<int>& list, int index) {
      if (std::ranges::find(list, index) == list.end()) list.push_back(index);
    };
    add(wiring_.nodes[at(position)].needs, producer);
    const int step = steps_[at(position)], yields = steps_[at(producer)];
    if (step == yields) return;
    add(wiring_.steps[at(step)].needs, yields);
    add(wiring_.steps[at(yields)].feeds, step);
  }

  void wait(int step, int producer, int delay) {
    std::vector<DelayedWait>& waits = wiring_.steps[at(step)].waits;
    const auto same = [&](const DelayedWait& known) { return known.step == producer && known.delay == delay; };
    if (producer < 0 || std::ranges::find_if(waits, same) != waits.end()) return;  // inputs are there when a frame begins
    waits.push_back({producer, delay});
    wiring_.steps[at(producer)].awaited_by.push_back({step, delay});
  }

  // Steps that yield what is kept, or ends it, and those that these need.
  void find_feeds() {
    std::vector<bool>& feeds = wiring_.feeds_history;
    feeds.assign(wiring_.steps.size(), false);
    std::vector<int> open;
    for (std::size_t value = 0; value < producers_.size(); ++value)
      if (!wiring_.lines[value].empty()) open.push_back(step_of(static_cast<int>(value)));
    for (const WiredReset& reset : wiring_.resets) open.push_back(reset.step);
    while (!open.empty()) {
      const int step = open.back();
      open.pop_back();
      if (step < 0 || feeds[at(step)]) continue;
      feeds[at(step)] = true;
      open.insert(open.end(), wiring_.steps[at(step)].needs.begin(), wiring_.steps[at(step)].needs.end());
    }
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
  std::vector<int> producers_;  // node of each value; -1 for graph inputs
  std::vector<int> steps_;      // of each node
};

}  // namespace

Wiring::Wiring(const Plan& plan) { Builder(plan, *this).build(); }

}  // namespace quell
