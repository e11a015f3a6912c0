#include "quell/graph/plan_shapes.h"

#include <algorithm>
#include <cassert>

#include "quell/graph/plan_ports.h"
#include "quell/graph/plan_question.h"

namespace quell::planning {
namespace {

std::string describe(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

// What is known of an edge so far.
struct Expected {
  Shape shape;
  bool sized = true;  // the size is known, or needs none
  bool final = true;  // not a guess that a later round replaces
  Size hint;          // of one that is not sized: better than nothing
};

struct Finding {
  Position where;
  std::string message;
  Fault fault = Fault::usage;
};

[[noreturn]] void fail(const std::vector<Finding>& findings) {
  Diagnostics errors;
  Fault fault = Fault::usage;
  for (const Finding& finding : findings) {
    errors.error(finding.where, finding.message);
    if (finding.fault == Fault::plugin) fault = Fault::plugin;
  }
  throw Error(fault, "", errors.render());
}

class ShapeSolver {
 public:
  ShapeSolver(Plan& plan, const Presence& presence)
      : plan_(plan), graph_(*plan.graph), presence_(presence), positions_(graph_.nodes.size(), -1) {
    for (std::size_t i = 0; i < plan.nodes.size(); ++i)
      positions_[static_cast<std::size_t>(plan.nodes[i].node)] = static_cast<int>(i);
  }

  void solve() {
    // Each round settles at least one node more, unless sizes chase each other around a loop.
    const std::size_t most_rounds = plan_.nodes.size() + 2;
    for (std::size_t round = 0; round < most_rounds; ++round) {
      certain_.clear(), suspected_.clear(), changed_.clear();
      for (PlannedNode& planned : plan_.nodes) infer(planned);
      if (changed_.empty()) break;
    }
    if (!certain_.empty()) fail(certain_);
    if (!changed_.empty()) fail(changed_);
    if (!suspected_.empty()) fail(suspected_);
    require_known();
  }

 private:
  const Node& node_of(int node) const { return graph_.nodes[static_cast<std::size_t>(node)]; }
  const std::string& name(int node) const { return node_of(node).name; }

  // Nothing when the node was not asked with success yet.
  const Shape* known(const Endpoint& endpoint) const {
    if (endpoint.node < 0) return &plan_.inputs[static_cast<std::size_t>(endpoint.port)];
    const PlannedNode& planned = plan_.nodes[static_cast<std::size_t>(positions_[static_cast<std::size_t>(endpoint.node)])];
    if (planned.outputs.empty()) return nullptr;
    return &planned.outputs[static_cast<std::size_t>(endpoint.port)][static_cast<std::size_t>(endpoint.item)];
  }

  Expected expect(const Endpoint& endpoint) const {
    if (const Shape* shape = known(endpoint)) return {*shape};
    const PortType type = graph_.type(endpoint);
    return {{type, {}, type == QUELL_TYPE_VALUE ? 1u : 0u}, !is_image(type), false};
  }

  Expected expect(const Edge& edge) const {
    if (!presence_.has(edge)) return {{graph_.type(edge.from), {}, 0, false}};
    if (edge.delay == 0) return expect(edge.from);
    if (!presence_.has(edge.from)) return expect_initial(edge);  // in every frame, for lack of anything else
    Expected source = expect(edge.from);
    if (has_initial_endpoint(edge)) source.hint = expect(edge.initial.endpoint).shape.size;
    return source;
  }

  bool has_initial_endpoint(const Edge& edge) const {
    return edge.initial.kind == Initial::Kind::endpoint && presence_.has(edge.initial.endpoint);
  }

  Expected expect_initial(const Edge& edge) const {
    if (has_initial_endpoint(edge)) return expect(edge.initial.endpoint);
    const PortType type = graph_.type(edge.from);
    const auto values = static_cast<std::uint32_t>(edge.initial.constant.size());
    return {{type, {}, type == QUELL_TYPE_VALUE ? values : 0}, !is_image(type)};
  }

  std::vector<std::vector<Expected>> expect(const Node& node) const {
    std::vector<std::vector<Expected>> inputs;
    for (const std::vector<Edge>& port : node.inputs) {
      std::vector<Expected>& items = inputs.emplace_back();
      for (const Edge& edge : port) items.push_back(expect(edge));
    }
    return inputs;
  }

  void infer(PlannedNode& planned) {
    const Node& node = node_of(planned.node);
    std::vector<std::vector<Expected>> expected = expect(node);
    bool any_open = false, all_final = true;
    Size size, hint;
    for (std::size_t port = 0; port < expected.size(); ++port)
      for (const Expected& item : expected[port]) {
        const bool tells = is_image(item.shape.type) && item.shape.present && !is_any_size(input_port(node, port));
        if (tells && item.sized && size == Size{}) size = item.shape.size;
        if (!item.sized && hint == Size{}) hint = item.hint;
        any_open |= !item.sized;
        all_final &= item.final;
      }
    if (size == Size{}) size = hint;
    if (any_open && size == Size{}) return;  // perhaps in the next round
    PortShapes inputs;
    for (auto& port : expected) {
      std::vector<Shape>& items = inputs.emplace_back();
      for (Expected& item : port) {
        if (!item.sized) item.shape.size = size;
        items.push_back(item.shape);
      }
    }
    // What a guess leads to is not an error yet.
    std::vector<Finding>& findings = all_final ? certain_ : suspected_;
    if (check_sizes(node, inputs, findings)) ask(planned, inputs, outputs_like(planned.node, inputs, size), findings);
  }

  // The one place that decides which sizes may meet. A node's images have one size, but for those of ports of any size (what
  // guides an upsampling). A value and its initial value have one size, too.
  bool check_sizes(const Node& node, const PortShapes& inputs, std::vector<Finding>& findings) const {
    const std::size_t before = findings.size();
    const Edge* first = nullptr;
    std::string first_name;
    Size size;
    for (std::size_t port = 0; port < inputs.size(); ++port)
      for (std::size_t i = 0; i < inputs[port].size(); ++i) {
        const Shape& shape = inputs[port][i];
        const Edge& edge = node.inputs[port][i];
        if (!is_image(shape.type) || !shape.present) continue;
        const std::string name = item_name(input_port(node, port), i);
        if (is_any_size(input_port(node, port))) {
          // What fits is the pass's to say.
        } else if (!first) {
          first = &edge, first_name = name, size = shape.size;
        } else if (shape.size != size) {
          findings.push_back({edge.where, "'" + name + "' of '" + node.name + "' is " + sized(edge.from, shape.size) + ", but '" +
                                              first_name + "' is " + sized(first->from, size) +
                                              "; a node's images have one size"});
        }
        check_initial(edge, shape, findings);
      }
    return findings.size() == before;
  }

  void check_initial(const Edge& edge, const Shape& shape, std::vector<Finding>& findings) const {
    if (edge.delay == 0 || !has_initial_endpoint(edge)) return;
    const Shape* initial = known(edge.initial.endpoint);
    if (!initial || initial->size == shape.size) return;
    findings.push_back({edge.where, "the initial value is " + sized(edge.initial.endpoint, initial->size) +
                                        ", but what it stands for is " + sized(edge.from, shape.size) + "; they have one size"});
  }

  // "640 x 360 (from 'half.color')"
  std::string sized(const Endpoint& endpoint, Size size) const {
    return describe(size) + " (from '" + graph_.describe(endpoint) + "')";
  }

  // What the outputs are unless the pass says otherwise.
  PortShapes outputs_like(int index, const PortShapes& inputs, Size size) const {
    const Node& node = node_of(index);
    PortShapes outputs(node.pass->output_count);
    for (std::size_t port = 0; port < outputs.size(); ++port) {
      const quell_port_desc& desc = output_port(node, port);
      for (std::size_t i = 0; i < item_count(node, port); ++i) {
        const Endpoint endpoint{index, static_cast<int>(port), static_cast<int>(i)};
        const auto followed = static_cast<std::size_t>(desc.same_as);
        const bool follows = desc.same_as >= 0 && i < inputs[followed].size();
        const PortType type = follows ? inputs[followed][i].type : graph_.type(endpoint);
        outputs[port].push_back(
            {type, is_image(type) ? size : Size{}, type == QUELL_TYPE_VALUE ? 1u : 0u, presence_.has(endpoint)});
      }
    }
    return outputs;
  }

  // A node that fails keeps what it answered before, so that the others still settle.
  void ask(PlannedNode& planned, const PortShapes& inputs, const PortShapes& outputs, std::vector<Finding>& findings) {
    try {
      PlannedNode answer = ask_pass(graph_, planned.node, inputs, outputs);
      if (!same(planned.outputs, answer.outputs))
        changed_.push_back(
            {node_of(planned.node).where,
             "what '" + name(planned.node) + "' yields never settles: its shape changes with every turn of the loop"});
      planned = std::move(answer);
    } catch (const Error& error) {
      findings.push_back({node_of(planned.node).where, "'" + name(planned.node) + "': " + error.what(), error.fault()});
    }
  }

  static bool same(const PortShapes& a, const PortShapes& b) {
    const auto same_item = [](const Shape& x, const Shape& y) {
      return x.type == y.type && x.size == y.size && x.value_count == y.value_count && x.present == y.present;
    };
    const auto same_port = [&](const auto& x, const auto& y) {
      return std::equal(x.begin(), x.end(), y.begin(), y.end(), same_item);
    };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_port);
  }

  void require_known() const {
    for (const PlannedNode& planned : plan_.nodes)
      if (planned.outputs.empty())  // those behind it follow from the first one
        fail({{node_of(planned.node).where, "nothing tells the size of the images of '" + name(planned.node) +
                                                "': it has no image input but its own history"}});
  }

  Plan& plan_;
  const Graph& graph_;
  const Presence& presence_;
  std::vector<int> positions_;  // in the plan, of each node of the graph
  // Of one round; what earlier rounds found may have come from guesses.
  std::vector<Finding> certain_;    // from inputs whose shapes are known
  std::vector<Finding> suspected_;  // from guesses
  std::vector<Finding> changed_;    // nodes whose answer is another than in the round before
};

}  // namespace

void infer_shapes(Plan& plan, const Presence& presence) { ShapeSolver(plan, presence).solve(); }

}  // namespace quell::planning
