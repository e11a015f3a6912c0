#include "quell/graph/plan_fusion.h"

#include <algorithm>
#include <optional>
#include <set>

#include "quell/graph/order.h"

namespace quell::planning {
namespace {

// Of the rows that pass between nodes; about half of what today's processors have as second-level cache for each thread.
constexpr std::size_t kCachedBytes = std::size_t{768} << 10;
constexpr int kMostRows = 8;
constexpr int kMostRadius = 2;  // of a reader: what lies around a band is computed twice
constexpr int kBandRows = 32;   // for each row by which a node is ahead: so little of what it does is done twice
// Farther ahead, bands are so high that few threads have one, and windows so high that they leave the cache: at 1920x1080, 20
// nodes of radius 2, all fused, took 2.4 times as long on 2 threads as one by one; in fours they are faster.
constexpr int kMostAhead = 6;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

struct Group {
  std::vector<int> nodes;  // positions in Plan::nodes, ascending
};

class Fuser {
 public:
  Fuser(Plan& plan, const Presence& presence) : plan_(plan), presence_(presence), positions_(plan.graph->nodes.size(), -1) {
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      positions_[at(plan.nodes[i].node)] = static_cast<int>(i);
      group_of_.push_back(static_cast<int>(i));
      groups_.push_back({{static_cast<int>(i)}});
      reads_.push_back(reads(node(static_cast<int>(i)), presence));
    }
    for (const PlannedResult& result : plan.results()) kept_.insert(result.from);
    for (const PlannedHistory& history : plan.histories) kept_.insert(history.from);
  }

  void run(bool fuse) {
    for (int reader = 0; fuse && reader < static_cast<int>(plan_.nodes.size()); ++reader)
      for (const Read& read : reads_[at(reader)])
        if (const int producer = producer_of(read); producer >= 0 && may_fuse(group_of_[at(producer)], group_of_[at(reader)]))
          merge(group_of_[at(producer)], group_of_[at(reader)]);
    for (const int group : order()) plan_.turns.push_back(make_turn(groups_[at(group)]));
    std::ranges::sort(plan_.inner);
  }

 private:
  const PlannedNode& planned(int position) const { return plan_.nodes[at(position)]; }
  const Node& node(int position) const { return plan_.graph->nodes[at(planned(position).node)]; }
  // -1 for graph inputs and other frames.
  int producer_of(const Read& read) const { return read.delay != 0 || read.from.node < 0 ? -1 : positions_[at(read.from.node)]; }

  // The height of a node's results, where it may run on some of their rows.
  std::optional<int> height_by_rows(int position) const {
    if (!planned(position).by_rows) return std::nullopt;
    std::optional<int> height;
    for (const std::vector<Shape>& port : planned(position).outputs)
      for (const Shape& shape : port) {
        if (!shape.present) continue;
        if (height && *height != shape.size.height) return std::nullopt;
        height = shape.size.height;
      }
    return height;
  }

  // Whether `reader` can do with rows of what `producer` yields.
  bool reads_rows(int reader, int producer) const {
    std::size_t by_edges = 0;
    for (std::size_t port = 0; port < node(reader).inputs.size(); ++port)
      for (const Edge& edge : node(reader).inputs[port]) {
        if (edge.delay != 0 || !presence_.has(edge) || edge.from.node != planned(producer).node) continue;
        ++by_edges;
        const int radius = planned(reader).radius[port];
        if (radius == QUELL_RADIUS_UNBOUNDED || radius > kMostRadius) return false;
      }
    const auto all = std::ranges::count_if(reads_[at(reader)], [&](const Read& read) { return producer_of(read) == producer; });
    return by_edges == static_cast<std::size_t>(all);  // the others are initial values and resets, which are needed whole
  }

  bool may_fuse(int first, int second) const {
    if (first == second) return false;
    std::vector<int> all = groups_[at(first)].nodes;
    all.insert(all.end(), groups_[at(second)].nodes.begin(), groups_[at(second)].nodes.end());
    const std::optional<int> height = height_by_rows(all.front());
    if (!height) return false;
    for (const int position : all) {
      if (height_by_rows(position) != height) return false;
      for (const Read& read : reads_[at(position)])
        if (const int producer = producer_of(read); producer >= 0 && std::ranges::find(all, producer) != all.end())
          if (!reads_rows(position, producer)) return false;
    }
    if (is_needed_between(first, second)) return false;
    std::ranges::sort(all);
    return std::ranges::max(rows_ahead(all)) <= kMostAhead;
  }

  // Of each of these nodes, which ascend and would be fused: rows that it has to be ahead of those that read it.
  std::vector<int> rows_ahead(const std::vector<int>& nodes) const {
    std::vector<int> ahead(nodes.size(), 0);
    for (std::size_t member = nodes.size(); member-- > 0;)
      for (std::size_t port = 0; port < node(nodes[member]).inputs.size(); ++port)
        for (const Edge& edge : node(nodes[member]).inputs[port]) {
          if (edge.delay != 0 || edge.from.node < 0 || !presence_.has(edge)) continue;
          const auto producer = std::ranges::lower_bound(nodes, positions_[at(edge.from.node)]);
          if (producer == nodes.end() || *producer != positions_[at(edge.from.node)]) continue;
          int& rows = ahead[static_cast<std::size_t>(producer - nodes.begin())];
          rows = std::max(rows, ahead[member] + planned(nodes[member]).radius[port]);
        }
    return ahead;
  }

  // Whether another group reads one of the two and is read by one of them, on whatever way.
  bool is_needed_between(int first, int second) const {
    const auto is_one = [&](int group) { return group == first || group == second; };
    std::vector<bool> seen(groups_.size(), false);
    std::vector<int> to_visit{first, second};
    while (!to_visit.empty()) {
      const int group = to_visit.back();
      to_visit.pop_back();
      for (const int position : groups_[at(group)].nodes)
        for (const Read& read : reads_[at(position)]) {
          const int producer = producer_of(read);
          if (producer < 0) continue;
          const int from = group_of_[at(producer)];
          if (is_one(from) && !is_one(group)) return true;
          if (is_one(from) || seen[at(from)]) continue;
          seen[at(from)] = true;
          to_visit.push_back(from);
        }
    }
    return false;
  }

  void merge(int from, int into) {
    std::vector<int>& nodes = groups_[at(into)].nodes;
    for (const int position : groups_[at(from)].nodes) group_of_[at(position)] = into;
    nodes.insert(nodes.end(), groups_[at(from)].nodes.begin(), groups_[at(from)].nodes.end());
    std::ranges::sort(nodes);
    groups_[at(from)].nodes.clear();
  }

  // Of the groups that are left, each after those that it reads.
  std::vector<int> order() const {
    std::vector<int> by_first_node;
    std::vector<int> place(groups_.size(), -1);
    for (int position = 0; position < static_cast<int>(plan_.nodes.size()); ++position)
      if (const int group = group_of_[at(position)]; place[at(group)] < 0) {
        place[at(group)] = static_cast<int>(by_first_node.size());
        by_first_node.push_back(group);
      }
    detail::Dependencies needs(by_first_node.size());
    for (int position = 0; position < static_cast<int>(plan_.nodes.size()); ++position)
      for (const Read& read : reads_[at(position)])
        if (const int producer = producer_of(read); producer >= 0 && group_of_[at(producer)] != group_of_[at(position)])
          needs[at(place[at(group_of_[at(position)])])].push_back(place[at(group_of_[at(producer)])]);
    std::vector<int> ordered;
    for (const int index : detail::sort_topologically(needs)) ordered.push_back(by_first_node[at(index)]);
    return ordered;
  }

  // Who of the turn reads an endpoint, and how far around a pixel.
  struct Reader {
    std::size_t member;
    int radius;
  };
  std::vector<Reader> readers_within(const PlannedTurn& turn, const Endpoint& endpoint) const {
    std::vector<Reader> readers;
    for (std::size_t member = 0; member < turn.nodes.size(); ++member) {
      const Node& reader = node(turn.nodes[member]);
      for (std::size_t port = 0; port < reader.inputs.size(); ++port)
        for (const Edge& edge : reader.inputs[port])
          if (edge.delay == 0 && edge.from == endpoint && presence_.has(edge))
            readers.push_back({member, planned(turn.nodes[member]).radius[port]});
    }
    return readers;
  }

  bool is_read_outside(const PlannedTurn& turn, const Endpoint& endpoint) const {
    for (int position = 0; position < static_cast<int>(plan_.nodes.size()); ++position) {
      if (std::ranges::find(turn.nodes, position) != turn.nodes.end()) continue;
      for (const Read& read : reads_[at(position)])
        if (read.delay == 0 && read.from == endpoint) return true;
    }
    return false;
  }

  template <class Visit>
  void for_each_value(int position, const Visit& visit) const {
    const std::vector<std::vector<Shape>>& outputs = planned(position).outputs;
    for (std::size_t port = 0; port < outputs.size(); ++port)
      for (std::size_t item = 0; item < outputs[port].size(); ++item)
        if (outputs[port][item].present)
          visit(Endpoint{planned(position).node, static_cast<int>(port), static_cast<int>(item)}, outputs[port][item]);
  }

  PlannedTurn make_turn(const Group& group) {
    PlannedTurn turn;
    turn.nodes = group.nodes;
    if (turn.nodes.size() == 1) return turn;
    turn.ahead = rows_ahead(turn.nodes);
    choose_rows(turn);
    for (std::size_t member = 0; member < turn.nodes.size(); ++member) add_windows(turn, member);
    std::ranges::sort(turn.windows, {}, &PlannedWindow::of);
    return turn;
  }

  void choose_rows(PlannedTurn& turn) const {
    std::size_t row_bytes = 1;
    int height = 0;
    for (const int position : turn.nodes)
      for_each_value(position, [&](const Endpoint&, const Shape& shape) {
        height = shape.size.height;
        row_bytes += window_bytes(shape, 1);
      });
    turn.rows = static_cast<int>(std::clamp<std::size_t>(kCachedBytes / row_bytes, 1, kMostRows));
    turn.rows = std::min(turn.rows, height);
    const int band = std::max(turn.rows, std::min(kBandRows * std::ranges::max(turn.ahead), height));
    turn.band = (band + turn.rows - 1) / turn.rows * turn.rows;
  }

  void add_windows(PlannedTurn& turn, std::size_t member) {
    for_each_value(turn.nodes[member], [&](const Endpoint& endpoint, const Shape& shape) {
      const std::vector<Reader> readers = readers_within(turn, endpoint);
      const bool whole = kept_.contains(endpoint) || is_read_outside(turn, endpoint);
      if (!whole) plan_.inner.push_back(endpoint);
      if (whole && turn.ahead[member] == 0) return;
      // When a thread begins, it computes the rows that the readers need before theirs; later, what they still need stays.
      const int ahead = turn.ahead[member];
      int rows = 2 * ahead;
      for (const Reader& reader : readers) rows = std::max(rows, ahead - turn.ahead[reader.member] + reader.radius);
      rows = std::min(rows + turn.rows, shape.size.height);
      turn.windows.push_back({endpoint, rows, whole});
      turn.window_bytes += window_bytes(shape, rows);
    });
  }

  static std::size_t window_bytes(const Shape& shape, int rows) {
    return Image::bytes_needed(shape.type, {shape.size.width, rows});
  }

  Plan& plan_;
  const Presence& presence_;
  std::vector<int> positions_;  // in the plan, of each node of the graph
  std::vector<int> group_of_;   // of each node of the plan
  std::vector<Group> groups_;
  std::vector<std::vector<Read>> reads_;  // of each node of the plan
  std::set<Endpoint> kept_;               // handed out, or part of a history
};

}  // namespace

void plan_turns(Plan& plan, const Presence& presence, bool fuse) { Fuser(plan, presence).run(fuse); }

}  // namespace quell::planning
