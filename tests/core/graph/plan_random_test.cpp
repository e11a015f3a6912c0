// Many small random graphs, run step by step in the simplest way, against what their plans say.
#include <random>
#include <set>

#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

// Draws below a bound. Not std::uniform_int_distribution, whose numbers differ between libraries.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  int below(int bound) { return static_cast<int>(engine_() % static_cast<unsigned>(bound)); }
  bool chance(int percent) { return below(100) < percent; }

 private:
  std::mt19937 engine_;
};

// All images have one size, so that any can be joined with any; 'weight' has fewer planes, depth too. Nodes of 'rows' have none.
std::string pick(Dice& dice, int nodes, const std::vector<bool>& is_rows) {
  if (nodes == 0 || dice.chance(20)) return dice.chance(50) ? "color" : "depth";
  const int node = dice.below(nodes);
  return "n" + std::to_string(node) + (dice.chance(70) || is_rows[static_cast<std::size_t>(node)] ? ".color" : ".weight");
}

// `by_rows`: in percent, the nodes that may be fused.
std::shared_ptr<const Graph> random_graph(unsigned seed, int by_rows = 0) {
  Dice dice(seed);
  Builder builder;
  builder.input("color").input("depth", QUELL_TYPE_DEPTH, true);
  const int nodes = 1 + dice.below(9);
  std::vector<bool> is_rows(static_cast<std::size_t>(nodes));
  for (int n = 0; by_rows > 0 && n < nodes; ++n) is_rows[static_cast<std::size_t>(n)] = dice.chance(by_rows);
  for (int n = 0; n < nodes; ++n) {
    Wires wires{{"color", {pick(dice, n, is_rows)}}};
    for (int more = dice.below(4); more > 0; --more) {
      Wire wire = pick(dice, n, is_rows);
      if (dice.chance(30))
        wire = Wire(pick(dice, nodes, is_rows), 1 + dice.below(3), dice.chance(30) ? pick(dice, n, is_rows) : "");
      wires["more"].push_back(wire);
    }
    const bool in_place = dice.chance(70);
    const int scratch = dice.below(3) * 50000;
    if (is_rows[static_cast<std::size_t>(n)])
      builder.node("n" + std::to_string(n), rows(), wires, {{"in_place", in_place}, {"radius", in_place ? 0 : dice.below(4)}});
    else
      builder.node("n" + std::to_string(n), mix(), wires, {{"in_place", in_place}, {"scratch", scratch}});
  }
  for (int outputs = 1 + dice.below(3); outputs > 0; --outputs)
    builder.output("n" + std::to_string(dice.below(nodes)) + ".color");
  return builder.build();
}

// What happens to buffers in one frame, with nothing taken from the plan but what it orders.
class Simulation {
 public:
  explicit Simulation(const Plan& plan) : plan_(plan), graph_(*plan.graph) {}

  void run() {
    for (std::size_t i = 0; i < graph_.inputs.size(); ++i)
      if (plan_.input_used[i]) write({-1, static_cast<int>(i), 0}, next_buffer_++);
    most_bytes_ = alive_bytes();
    for (const PlannedTurn& turn : plan_.turns) step(turn);
    for (const int output : plan_.outputs) expect_intact(graph_.outputs[static_cast<std::size_t>(output)].from, "an output");
    for (const PlannedHistory& history : plan_.histories) expect_intact(history.from, "history");
  }
  std::size_t most_bytes() const { return most_bytes_; }
  std::size_t left_bytes() const { return alive_bytes(); }

 private:
  // Fused nodes read and write in turns: what one writes over, no other may read.
  void step(const PlannedTurn& turn) {
    for (const int position : turn.nodes)
      for (const Endpoint& endpoint : reads(position)) expect_intact(endpoint, name(position));
    std::size_t scratch = 0;
    for (const int position : turn.nodes) {
      write_outputs(turn, position);
      scratch += plan_.nodes[static_cast<std::size_t>(position)].scratch_bytes;
    }
    most_bytes_ = std::max(most_bytes_, alive_bytes() + scratch);
    for (const Endpoint& endpoint : plan_.nodes[static_cast<std::size_t>(turn.nodes.back())].last_uses) {
      EXPECT_TRUE(buffers_.contains(endpoint)) << graph_.describe(endpoint) << " is released twice";
      buffers_.erase(endpoint);
    }
  }

  const std::string& name(int position) const { return node(position).name; }
  const Node& node(int position) const {
    return graph_.nodes[static_cast<std::size_t>(plan_.nodes[static_cast<std::size_t>(position)].node)];
  }

  // What a node reads in the same frame of what has a buffer.
  std::vector<Endpoint> reads(int position) const {
    std::vector<Endpoint> all;
    const auto add = [&](const Endpoint& endpoint) {
      if (plan_.shape(endpoint).present && !is_of_turn(position, endpoint)) all.push_back(endpoint);
    };
    for (const auto& port : node(position).inputs)
      for (const Edge& edge : port) {
        if (edge.delay == 0) add(edge.from);
        if (edge.initial.kind == Initial::Kind::endpoint) add(edge.initial.endpoint);
      }
    return all;
  }

  // Whether a node that runs together with this one yields it.
  bool is_of_turn(int position, const Endpoint& endpoint) const {
    for (const PlannedTurn& turn : plan_.turns)
      if (std::ranges::find(turn.nodes, position) != turn.nodes.end())
        return std::ranges::any_of(turn.nodes,
                                   [&](int other) { return plan_.nodes[static_cast<std::size_t>(other)].node == endpoint.node; });
    return false;
  }

  void write_outputs(const PlannedTurn& turn, int position) {
    const PlannedNode& planned = plan_.nodes[static_cast<std::size_t>(position)];
    for (std::size_t port = 0; port < planned.outputs.size(); ++port) {
      const Endpoint endpoint{planned.node, static_cast<int>(port), 0};
      if (plan_.is_inner(endpoint)) continue;
      if (planned.in_place_of[port] < 0) {
        write(endpoint, next_buffer_++);
        continue;
      }
      const Endpoint& place = node(position).inputs[static_cast<std::size_t>(planned.in_place_of[port])][0].from;
      for (const int other : turn.nodes)
        EXPECT_TRUE(other == position || std::ranges::count(reads(other), place) == 0)
            << name(other) << " reads " << graph_.describe(place) << " while " << name(position) << " writes over it";
      write(endpoint, buffers_.at(place));
    }
  }

  void write(const Endpoint& endpoint, int buffer) {
    buffers_[endpoint] = buffer;
    contents_[buffer] = endpoint;
    sizes_[buffer] = bytes(64, 32, info(plan_.shape(endpoint).type).channels);
  }

  void expect_intact(const Endpoint& endpoint, const std::string& reader) {
    const auto found = buffers_.find(endpoint);
    ASSERT_NE(found, buffers_.end()) << reader << " reads " << graph_.describe(endpoint) << " after its release";
    EXPECT_EQ(contents_[found->second], endpoint)
        << reader << " reads " << graph_.describe(endpoint) << " after it was overwritten";
  }

  std::size_t alive_bytes() const {
    std::set<int> alive;
    for (const auto& [endpoint, buffer] : buffers_) alive.insert(buffer);
    std::size_t sum = 0;
    for (const int buffer : alive) sum += sizes_.at(buffer);
    return sum;
  }

  const Plan& plan_;
  const Graph& graph_;
  int next_buffer_ = 0;
  std::map<Endpoint, int> buffers_;   // of the values that are alive
  std::map<int, Endpoint> contents_;  // what was written to a buffer last
  std::map<int, std::size_t> sizes_;
  std::size_t most_bytes_ = 0;
};

// Whether anybody needs the value after the frame, or a node that runs after position `after` in this frame.
bool is_needed(const Plan& plan, const Endpoint& endpoint, std::size_t after) {
  for (const GraphOutput& output : plan.graph->outputs)
    if (output.from == endpoint) return true;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i)
    for (const auto& port : plan.graph->nodes[static_cast<std::size_t>(plan.nodes[i].node)].inputs)
      for (const Edge& edge : port) {
        if (edge.from == endpoint && (edge.delay != 0 || i > after)) return true;
        if (edge.initial.kind == Initial::Kind::endpoint && edge.initial.endpoint == endpoint && i > after) return true;
      }
  return false;
}

// The least memory that the plan's order can do with, found by trying for every node that may write over its input both ways.
class LeastMemory {
 public:
  explicit LeastMemory(const Plan& plan) : plan_(plan) {
    for (std::size_t i = 0; i < plan.inputs.size(); ++i)
      if (plan.input_used[i]) hold({-1, static_cast<int>(i), 0});
  }
  std::size_t find() {
    least_ = SIZE_MAX;
    walk(0, sum());
    return least_;
  }

 private:
  void walk(std::size_t position, std::size_t most) {
    if (most >= least_) return;
    if (position == plan_.nodes.size()) {
      least_ = most;
      return;
    }
    const PlannedNode& planned = plan_.nodes[position];
    const std::map<Endpoint, std::size_t> before = alive_;
    for (const bool in_place : {false, true}) {
      const Edge& color = plan_.graph->nodes[static_cast<std::size_t>(planned.node)].inputs[0][0];
      if (in_place && !may_overwrite(position, color)) continue;
      if (in_place) alive_.erase(color.from);
      for (int port = 0; port < 2; ++port) hold({planned.node, port, 0});
      const std::size_t now = sum() + planned.scratch_bytes;
      std::erase_if(alive_, [&](const auto& value) { return !is_needed(plan_, value.first, position); });
      walk(position + 1, std::max(most, now));
      alive_ = before;
    }
  }

  bool may_overwrite(std::size_t position, const Edge& color) const {
    const Node& node = plan_.graph->nodes[static_cast<std::size_t>(plan_.nodes[position].node)];
    if (std::get<std::vector<std::uint8_t>>(node.instance->values()[0].elements)[0] == 0 || color.delay != 0) return false;
    int reads = 0;
    for (const auto& port : node.inputs)
      for (const Edge& edge : port) {
        reads += edge.delay == 0 && edge.from == color.from;
        reads += edge.initial.kind == Initial::Kind::endpoint && edge.initial.endpoint == color.from;
      }
    return reads == 1 && !is_needed(plan_, color.from, position);
  }

  void hold(const Endpoint& endpoint) { alive_[endpoint] = bytes(64, 32, info(plan_.shape(endpoint).type).channels); }
  std::size_t sum() const {
    std::size_t all = 0;
    for (const auto& [endpoint, size] : alive_) all += size;
    return all;
  }

  const Plan& plan_;
  std::map<Endpoint, std::size_t> alive_;
  std::size_t least_ = SIZE_MAX;
};

class RandomPlan : public testing::TestWithParam<bool> {};

TEST_P(RandomPlan, NeverReadsWhatIsGoneAndCountsWhatIsThere) {
  InputShapes inputs{{"color", image(64, 32)}};
  if (GetParam()) inputs["depth"] = image(64, 32, QUELL_TYPE_DEPTH);
  int planned_graphs = 0, in_place = 0, refused = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto graph = random_graph(seed);
    Plan plan;
    try {
      plan = make_plan(graph, inputs);
    } catch (const Error&) {
      ++refused;
      continue;
    }
    ++planned_graphs;
    for (const PlannedNode& node : plan.nodes) in_place += node.in_place_of[0] >= 0;
    Simulation simulation(plan);
    simulation.run();
    EXPECT_EQ(simulation.most_bytes(), plan.frame_bytes);
    EXPECT_LE(static_cast<double>(plan.frame_bytes), 1.1 * static_cast<double>(LeastMemory(plan).find()));

    // Each value that is alive after a node is needed by somebody: released as early as can be.
    for (std::size_t i = 0; i < plan.nodes.size(); ++i)
      for (const Endpoint& endpoint : plan.nodes[i].last_uses) EXPECT_FALSE(is_needed(plan, endpoint, i));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < plan.inputs.size(); ++i)
      if (plan.input_used[i] && is_needed(plan, {-1, static_cast<int>(i), 0}, plan.nodes.size()))
        kept += bytes(64, 32, info(plan.inputs[i].type).channels);
    for (const PlannedNode& node : plan.nodes)
      for (int port = 0; port < 2; ++port)
        if (is_needed(plan, {node.node, port, 0}, plan.nodes.size()))
          kept += bytes(64, 32, info(plan.shape({node.node, port, 0}).type).channels);
    EXPECT_EQ(simulation.left_bytes(), kept);
    if (testing::Test::HasFailure()) return;
  }
  // The graphs must be of a kind that tries what is tested.
  EXPECT_GT(planned_graphs, 200);
  EXPECT_GT(in_place, 100);
  EXPECT_EQ(refused > 0, !GetParam()) << "only an absent input makes a graph impossible";
}

TEST(RandomFusedPlan, NeverReadsWhatIsGoneAndCountsWhatIsThere) {
  int fused = 0, fused_in_place = 0, inner = 0;
  for (unsigned seed = 0; seed < 3000 && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::shared_ptr<const Graph> graph = random_graph(seed, 60);
    const Plan plan = make_plan(graph, {{"color", image(64, 32)}, {"depth", image(64, 32, QUELL_TYPE_DEPTH)}});
    Simulation simulation(plan);
    simulation.run();
    EXPECT_EQ(simulation.most_bytes(), plan.frame_bytes);
    inner += static_cast<int>(plan.inner.size());
    for (const PlannedTurn& turn : plan.turns) {
      fused += turn.is_fused();
      for (const int position : turn.nodes)
        fused_in_place += turn.is_fused() && plan.nodes[static_cast<std::size_t>(position)].in_place_of[0] >= 0;
    }
  }
  EXPECT_GT(fused, 100);
  EXPECT_GT(fused_in_place, 100);
  EXPECT_GT(inner, 100);
}

INSTANTIATE_TEST_SUITE_P(WithDepth, RandomPlan, testing::Bool(), [](const auto& depth) { return depth.param ? "Yes" : "No"; });

}  // namespace
}  // namespace quell::test
