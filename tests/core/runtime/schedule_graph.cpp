#include "tests/core/runtime/schedule_graph.h"

#include <algorithm>
#include <numeric>

namespace quell::test {

std::vector<Wire> wires(const TestNode& node) {
  std::vector<Wire> all = node.main;
  all.insert(all.end(), node.other.begin(), node.other.end());
  all.insert(all.end(), node.list.begin(), node.list.end());
  return all;
}

PortType TestGraph::type(const Place& place) const {
  if (place.node < 0) return inputs[static_cast<std::size_t>(place.port)].type;
  const TestNode& at = node(place);
  if (at.kind == Kind::reduce) return QUELL_TYPE_SCALAR;
  if (at.kind == Kind::tally || at.kind == Kind::pulse) return QUELL_TYPE_VALUE;
  return type(at.kind == Kind::parts ? at.list[static_cast<std::size_t>(place.item)].from : at.main[0].from);
}

int TestGraph::level(const Place& place) const {
  if (place.node < 0) return 0;
  return level(node(place).main[0].from) + (node(place).kind == Kind::shrink ? 1 : 0);
}

bool TestGraph::always(const Wire& wire) const {
  if (wire.delay == 0) return present(wire.from);
  return wire.start == Wire::Start::constant || (wire.start == Wire::Start::place && present(wire.place));
}

// Ends, because the main wire and the items of `parts` come from earlier nodes.
bool TestGraph::present(const Place& place) const {
  if (place.node < 0) return !inputs[static_cast<std::size_t>(place.port)].absent;
  const TestNode& at = node(place);
  if (!always(at.main[0])) return false;
  if (at.kind != Kind::parts) return true;
  const Wire& mirrored = at.list[static_cast<std::size_t>(place.item)];
  return present(mirrored.from) || always(mirrored);
}

std::vector<Place> TestGraph::resets_of(int node) const {
  std::vector<Place> places;
  for (const auto& [group, place] : resets)
    if (group == -1 || group == nodes[static_cast<std::size_t>(node)].group) places.push_back(place);
  return places;
}

std::string TestGraph::name(int node) const {
  const int group = nodes[static_cast<std::size_t>(node)].group;
  return (group < 0 ? "" : "g" + std::to_string(group) + ".") + "n" + std::to_string(node);
}

std::string TestGraph::name(const Place& place) const {
  if (place.node < 0) return inputs[static_cast<std::size_t>(place.port)].name;
  switch (node(place).kind) {
    case Kind::reduce:
      return name(place.node) + ".weight";
    case Kind::tally:
    case Kind::pulse:
      return name(place.node) + ".count";
    case Kind::parts:
      return name(place.node) + ".items[" + std::to_string(place.item) + "]";
    default:
      return name(place.node) + ".color";
  }
}

namespace {

class Generator {
 public:
  Generator(unsigned seed, const std::vector<std::int64_t>& frames) : dice_(seed), reset_dice_(seed + 9000), frames_(frames) {}

  TestGraph run() {
    graph_.inputs = {{"extra", QUELL_TYPE_COLOR, true, dice_.chance(60)}, {"a"}, {"b"}, {"s", QUELL_TYPE_SCALAR}};
    const int nodes = dice_.from(3, 15);
    while (static_cast<int>(graph_.nodes.size()) < nodes) add_node();
    for (int node = 0; node < nodes; ++node) add_history(node);
    add_groups();
    add_resets();
    graph_.file_order.resize(graph_.nodes.size());
    std::iota(graph_.file_order.begin(), graph_.file_order.end(), 0);
    for (int i = static_cast<int>(graph_.nodes.size()) - 1; i > 0; --i)
      std::swap(graph_.file_order[static_cast<std::size_t>(i)], graph_.file_order[static_cast<std::size_t>(dice_.below(i + 1))]);
    graph_.outputs = choose_present(dice_.from(1, 4));
    graph_.dumps = choose_present(dice_.chance(40) ? 2 : 0);
    return std::move(graph_);
  }

 private:
  static Kind draw_kind(Dice& dice) {
    static const std::vector<Kind> kinds = {Kind::stir,   Kind::stir,  Kind::stir,   Kind::stir,    Kind::soften,
                                            Kind::soften, Kind::parts, Kind::parts,  Kind::shelter, Kind::tally,
                                            Kind::apply,  Kind::apply, Kind::reduce, Kind::falter,  Kind::shrink};
    return dice.pick(kinds);
  }

  // Everything that the nodes so far yield, and the graph inputs.
  std::vector<Place> places() const {
    std::vector<Place> all;
    for (int i = 0; i < static_cast<int>(graph_.inputs.size()); ++i) all.push_back({-1, i});
    for (int i = 0; i < static_cast<int>(graph_.nodes.size()); ++i) {
      const TestNode& node = graph_.nodes[static_cast<std::size_t>(i)];
      const int items = node.kind == Kind::parts ? static_cast<int>(node.list.size()) : 1;
      for (int item = 0; item < items; ++item) all.push_back({i, 0, item});
    }
    return all;
  }
  template <class Condition>
  std::vector<Place> places(const Condition& condition) const {
    std::vector<Place> all = places();
    std::erase_if(all, [&](const Place& place) { return !condition(place); });
    return all;
  }
  bool is_image(const Place& place) const { return quell::is_image(graph_.type(place)); }

  // Recent places more often, so that graphs grow deep.
  Place draw(const std::vector<Place>& from) {
    const int count = static_cast<int>(from.size());
    return from[static_cast<std::size_t>(std::max({dice_.below(count), dice_.below(count), dice_.below(count)}))];
  }

  // A delay and what stands in; `earlier` are what an initial value may come from.
  void delay(Wire& wire, bool required, const std::vector<Place>& earlier) {
    wire.delay = dice_.from(1, 3);
    if (wire.from.node < 0 && dice_.chance(40)) wire.delay = -dice_.from(1, 2);
    std::vector<Place> alike = earlier;
    std::erase_if(alike, [&](const Place& place) {
      return graph_.type(place) != graph_.type(wire.from) || graph_.level(place) != graph_.level(wire.from);
    });
    const int draw = dice_.below(3);
    wire.start = draw == 0 && !required ? Wire::Start::none : Wire::Start::constant;
    wire.constant = dice_.below(4000);
    if (draw == 1 && !alike.empty()) wire.start = Wire::Start::place, wire.place = dice_.pick(alike);
  }

  void add_node() {
    TestNode node;
    node.kind = draw_kind(dice_);
    node.salt = dice_.below(1000);
    node.radius = dice_.below(3);
    node.in_place = dice_.chance(60);
    const std::vector<Place> images = places([&](const Place& place) { return is_image(place); });
    Wire main{draw(images)};
    if (graph_.level(main.from) == 2 && node.kind == Kind::shrink) node.kind = Kind::stir;
    // Without its source a delayed wire has a value, but no size.
    if (dice_.chance(12) && graph_.present(main.from)) delay(main, true, images);
    node.main = {main};
    if (node.kind == Kind::falter) add_failures(node);
    const int level = graph_.level(main.from);
    const std::vector<Place> of_size =
        places([&](const Place& place) { return is_image(place) && graph_.level(place) == level; });
    if (node.kind == Kind::stir && dice_.chance(40)) node.other = {side_wire(of_size)};
    if (node.kind == Kind::stir && dice_.chance(30)) add_list(node, of_size);
    if (node.kind == Kind::parts) add_list(node, of_size);
    const std::vector<Place> values = places([&](const Place& place) { return graph_.type(place) == QUELL_TYPE_VALUE; });
    if ((node.kind == Kind::apply || node.kind == Kind::tally) && !values.empty()) node.other = {side_wire(values)};
    graph_.nodes.push_back(std::move(node));
  }

  Wire side_wire(const std::vector<Place>& from) {
    Wire wire{draw(from)};
    if (dice_.chance(35)) delay(wire, false, from);
    return wire;
  }

  void add_list(TestNode& node, const std::vector<Place>& from) {
    for (int count = dice_.from(1, 3); count > 0; --count) node.list.push_back(side_wire(from));
  }

  void add_failures(TestNode& node) {
    static const std::vector<std::string> ways = {"start", "chunk", "chunk", "memory", "foreign"};
    for (const std::int64_t frame : frames_)
      if (dice_.chance(12)) node.fails.push_back(static_cast<int>(frame));
    node.how = dice_.pick(ways);
  }

  // Edges back from any node, its own outputs and later ones included.
  void add_history(int index) {
    TestNode& node = graph_.nodes[static_cast<std::size_t>(index)];
    const bool is_stir = node.kind == Kind::stir;
    if (!node.other.empty() || (!is_stir && node.kind != Kind::tally && node.kind != Kind::apply) || dice_.chance(10)) return;
    const int level = graph_.level(node.main[0].from);
    const std::vector<Place> from = places([&](const Place& place) {
      return is_stir ? is_image(place) && graph_.level(place) == level : graph_.type(place) == QUELL_TYPE_VALUE;
    });
    if (from.empty()) return;
    std::vector<Place> earlier = from;
    std::erase_if(earlier, [&](const Place& place) { return place.node >= index; });
    Wire wire{draw(from)};
    delay(wire, false, earlier);
    node.other = {wire};
    if (!is_stir || !dice_.chance(30)) return;
    wire = {draw(from)};
    delay(wire, false, earlier);
    node.list.push_back(wire);
  }

  // Neighbors become a subgraph.
  void add_groups() {
    const int nodes = static_cast<int>(graph_.nodes.size());
    for (int begin = 0; begin < nodes && dice_.chance(50);) {
      begin += dice_.below(4);
      const int end = std::min(nodes, begin + dice_.from(1, 5));
      if (begin >= end) return;
      for (int i = begin; i < end; ++i) graph_.nodes[static_cast<std::size_t>(i)].group = graph_.groups;
      ++graph_.groups;
      begin = end;
    }
  }

  // Whether a value depends, in its own frame, on a node that reads history: any, or one of a subgraph.
  bool depends_on_history(const Place& place, bool of_groups_alone) const {
    if (place.node < 0) return false;
    const TestNode& node = graph_.node(place);
    for (const Wire& wire : wires(node)) {
      if (wire.delay > 0 && (!of_groups_alone || node.group >= 0)) return true;
      if (wire.delay == 0 && depends_on_history(wire.from, of_groups_alone)) return true;
      if (wire.delay != 0 && wire.start == Wire::Start::place && depends_on_history(wire.place, of_groups_alone)) return true;
    }
    return false;
  }

  // Of the whole graph, and of subgraphs.
  void add_resets() {
    for (int group = -1; group < graph_.groups; ++group) {
      if (!reset_dice_.chance(50)) continue;
      const std::vector<Place> images =
          places([&](const Place& place) { return is_image(place) && !depends_on_history(place, group >= 0); });
      TestNode pulse{.kind = Kind::pulse};
      pulse.main = {Wire{reset_dice_.pick(images)}};
      for (const std::int64_t frame : frames_)
        if (reset_dice_.chance(25)) pulse.fails.push_back(static_cast<int>(frame));
      graph_.resets[group] = {static_cast<int>(graph_.nodes.size())};
      graph_.nodes.push_back(std::move(pulse));
    }
  }

  std::vector<Place> choose_present(int count) {
    const std::vector<Place> all = places([&](const Place& place) { return graph_.present(place); });
    std::vector<Place> chosen;
    for (; count > 0; --count) {
      const Place place = draw(all);
      if (std::ranges::find(chosen, place) == chosen.end()) chosen.push_back(place);
    }
    return chosen;
  }

  Dice dice_, reset_dice_;  // resets do not change what else is drawn
  const std::vector<std::int64_t>& frames_;
  TestGraph graph_;
};

}  // namespace

TestGraph random_graph(unsigned seed, const std::vector<std::int64_t>& frames) { return Generator(seed, frames).run(); }

}  // namespace quell::test
