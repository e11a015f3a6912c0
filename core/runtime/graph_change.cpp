#include "quell/runtime/graph_change.h"

#include <algorithm>
#include <bit>
#include <map>
#include <string>

namespace quell {
namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

bool same_values(const ParamValue& a, const ParamValue& b) {
  const auto* doubles = std::get_if<std::vector<double>>(&a.elements);
  if (!doubles || a.elements.index() != b.elements.index()) return a.elements == b.elements;
  return std::ranges::equal(*doubles, std::get<std::vector<double>>(b.elements), same_bits);
}

class Comparison {
 public:
  Comparison(const Graph& before, const Graph& now) : before_(before), now_(now) {
    for (const Node& node : before.nodes) by_name_[node.name] = &node;
  }

  bool is_same(const Node& node) const {
    const auto found = by_name_.find(node.name);
    if (found == by_name_.end() || !same_work(*found->second, node)) return false;
    const auto same_port = [&](const std::vector<Edge>& a, const std::vector<Edge>& b) {
      return std::ranges::equal(a, b, [&](const Edge& x, const Edge& y) { return same_edge(x, y); });
    };
    const auto same_reset = [&](const Endpoint& a, const Endpoint& b) { return same_endpoint(a, b); };
    return std::ranges::equal(found->second->inputs, node.inputs, same_port) &&
           std::ranges::equal(found->second->resets, node.resets, same_reset);
  }

 private:
  bool same_edge(const Edge& a, const Edge& b) const {
    return same_endpoint(a.from, b.from) && a.delay == b.delay && a.initial.kind == b.initial.kind &&
           std::ranges::equal(a.initial.constant, b.initial.constant, same_bits) &&
           (a.initial.kind != Initial::Kind::endpoint || same_endpoint(a.initial.endpoint, b.initial.endpoint));
  }
  bool same_endpoint(const Endpoint& a, const Endpoint& b) const {
    if (a.is_nothing() || b.is_nothing()) return a == b;
    return (a.node < 0) == (b.node < 0) && before_.describe(a) == now_.describe(b) && before_.type(a) == now_.type(b);
  }

  const Graph& before_;
  const Graph& now_;
  std::map<std::string_view, const Node*> by_name_;
};

}  // namespace

bool same_work(const Node& a, const Node& b) {
  return a.pass == b.pass && std::ranges::equal(a.instance->values(), b.instance->values(), same_values);
}

std::vector<bool> find_unchanged(const Graph& before, const Graph& now, const std::vector<bool>& touched) {
  const Comparison comparison(before, now);
  std::vector<bool> unchanged;
  for (std::size_t i = 0; i < now.nodes.size(); ++i) unchanged.push_back(!touched[i] && comparison.is_same(now.nodes[i]));
  const auto is_changed = [&](const Endpoint& endpoint) {
    return endpoint.node >= 0 && !unchanged[static_cast<std::size_t>(endpoint.node)];
  };
  const auto reads_changed = [&](const Node& node) {
    for (const std::vector<Edge>& port : node.inputs)
      for (const Edge& edge : port)
        if (is_changed(edge.from) || (edge.initial.kind == Initial::Kind::endpoint && is_changed(edge.initial.endpoint)))
          return true;
    return std::ranges::any_of(node.resets, is_changed);
  };
  for (bool spreads = true; spreads;) {
    spreads = false;
    for (std::size_t i = 0; i < now.nodes.size(); ++i)
      if (unchanged[i] && reads_changed(now.nodes[i])) unchanged[i] = false, spreads = true;
  }
  return unchanged;
}

}  // namespace quell
