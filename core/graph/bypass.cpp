// --bypass: a node's inputs in the place of its outputs.
#include <algorithm>
#include <cstdlib>
#include <map>

#include "quell/graph/connect.h"
#include "quell/graph/edits.h"
#include "quell/graph/resolve.h"
#include "quell/graph/types.h"

namespace quell::detail {
namespace {

/// A source of the node that might stand for one of its outputs.
struct Candidate {
  std::string input;
  std::size_t item = 0;
  const WrittenEdge* edge = nullptr;
  std::optional<PortType> type;
};

class Bypass {
 public:
  Bypass(Unfolded& graph, const EditedNode& edited, const Position& option, Diagnostics& errors)
      : graph_(graph), scope_(*edited.scope), child_(*edited.child), node_(*edited.node), option_(option), errors_(errors) {}

  std::vector<std::string> run() {
    Diagnostics ignored;  // what is wrong with the graph is told when it is connected for good
    connect(graph_, ignored);
    if (child_.leaf < 0 && !child_.scope) return {};
    const std::size_t before = errors_.size();
    find_candidates(ignored);
    Document& document = own_document(graph_, scope_);
    for_each_reader(document, node_.name.text, [&](const Reader& reader) {
      if (!reads_itself(reader)) choose(reader, ignored);
    });
    if (errors_.size() > before) return {};
    Document changed = document;  // so that an error leaves everything as it is
    for (WrittenNode& reader : changed.nodes)
      if (reader.name.text != node_.name.text)
        for (WrittenPort& port : reader.in)
          for (WrittenEdge& edge : port.edges) replace(edge, "the input '" + port.name.text + "' of '" + reader.name.text + "'");
    for (WrittenOutput& output : changed.outputs) replace(output.from, "the output '" + output.name.text + "' of the graph");
    if (changed.reset) replace(*changed.reset, "the reset of the graph");
    if (errors_.size() > before) return {};
    for (std::size_t i = 0; i < changed.nodes.size(); ++i) document.nodes[i].in = std::move(changed.nodes[i].in);
    document.outputs = std::move(changed.outputs);
    document.reset = std::move(changed.reset);
    return describe();
  }

 private:
  const std::string& name() const { return node_.name.text; }
  const Leaf* leaf() const { return child_.leaf < 0 ? nullptr : &graph_.leaves[static_cast<std::size_t>(child_.leaf)]; }
  bool reads_itself(const Reader& reader) const { return reader.node && reader.node->name.text == name(); }
  void tell(const std::string& message) { errors_.error(option_, message); }

  void find_candidates(Diagnostics& ignored) {
    Resolver resolver(graph_, ignored);
    for (const WrittenPort& port : node_.in)
      for (std::size_t item = 0; item < port.edges.size(); ++item) {
        const Arrival arrival = resolver.resolve(scope_, port.edges[item]);
        if (arrival.state == Arrival::State::connected)
          candidates_.push_back({port.name.text, item, &port.edges[item], type_of(graph_, arrival)});
      }
  }

  bool is_fed_by_itself(const Candidate& candidate) const {
    const auto is_own = [&](const Text& from) {
      const std::optional<OutputName> source = split_source(from.text);
      return source && source->node == name();
    };
    return is_own(candidate.edge->from) || (candidate.edge->initial && is_own(candidate.edge->initial->from));
  }

  // The source that stands for what a reader names.
  void choose(const Reader& reader, Diagnostics& ignored) {
    const OutputName output = *split_source(reader.from.text);
    const std::string key = std::string(output.port) + std::string(output.item);
    if (chosen_.contains(key)) return;
    const Arrival arrival = Resolver(graph_, ignored).resolve(scope_, reader.from);
    const std::optional<PortType> type = type_of(graph_, arrival);
    if (arrival.state != Arrival::State::connected || !type) return;  // broken, which is told later
    if (const Candidate* same = follow_descriptor(arrival.edge.from)) {
      if (is_fed_by_itself(*same))
        return tell("'" + name() + "." + key + "' cannot be bypassed: it is the same as the input '" + same->input +
                    "', which comes from '" + name() + "' itself");
      chosen_[key] = same;
      return;
    }
    choose_by_type(key, output.port, *type, reader.label);
  }

  // The source that an output is the same as, by what its pass says.
  const Candidate* follow_descriptor(const Endpoint& from) const {
    if (!leaf() || from.node != child_.leaf) return nullptr;
    const quell_port_desc& output = leaf()->output(static_cast<std::size_t>(from.port));
    if (output.same_as < 0) return nullptr;
    const std::string_view input = leaf()->input(static_cast<std::size_t>(output.same_as)).name;
    const auto found = std::ranges::find_if(candidates_, [&](const Candidate& candidate) {
      return candidate.input == input && candidate.item == static_cast<std::size_t>(from.item);
    });
    return found == candidates_.end() ? nullptr : &*found;
  }

  void choose_by_type(const std::string& key, std::string_view port, PortType type, const std::string& reader) {
    std::vector<const Candidate*> fitting, of_name;
    std::string have, equal;
    for (const Candidate& candidate : candidates_) {
      const std::string type_name = candidate.type ? std::string(quell::name(*candidate.type)) : "?";
      have += (have.empty() ? "'" : ", '") + candidate.input + "' (" + type_name + ")";
      if (candidate.type != type || is_fed_by_itself(candidate)) continue;
      fitting.push_back(&candidate);
      if (candidate.input == port) of_name.push_back(&candidate);
      equal += (equal.empty() ? "'" : ", '") + candidate.input + "'";
    }
    if (of_name.size() == 1) fitting = of_name;
    if (fitting.size() == 1) {
      chosen_[key] = fitting[0];
      return;
    }
    tell("'" + name() + "." + key + "' cannot be bypassed: " + reader + " reads it, and " +
         (fitting.empty()
              ? "no input of '" + name() + "' is of its type, " + std::string(quell::name(type)) + "; there are " +
                    (have.empty() ? "none" : have)
              : "several inputs of '" + name() + "' are of its type, " + std::string(quell::name(type)) + ": " + equal));
  }

  const Candidate* find(const Text& from) const {
    const std::optional<OutputName> source = split_source(from.text);
    if (!source || source->node != name()) return nullptr;
    const auto found = chosen_.find(std::string(source->port) + std::string(source->item));
    return found == chosen_.end() ? nullptr : found->second;
  }

  // A source that can have no delay.
  void replace(Text& from, const std::string& reader) {
    const Candidate* candidate = find(from);
    if (!candidate) return;
    if (candidate->edge->delay != 0)
      return tell("'" + from.text + "' cannot be bypassed: its input '" + candidate->input + "' has a delay, and " + reader +
                  " needs a value of the same frame");
    from = {candidate->edge->from.text, option_};
  }

  void replace(WrittenEdge& edge, const std::string& reader) {
    if (edge.initial && edge.initial->kind == Initial::Kind::endpoint)
      replace(edge.initial->from, "an initial value of " + reader);
    const Candidate* candidate = find(edge.from);
    if (!candidate) return;
    const WrittenEdge& source = *candidate->edge;
    if (edge.delay == 0 && source.delay != 0) {
      const Position where = option_;
      edge = source;
      edge.where = edge.delay_where = edge.from.where = edge.initial->where = where;
      return;
    }
    if (edge.delay != 0 && source.delay != 0 && !add_delay(edge, source, *candidate, reader)) return;
    edge.from = {source.from.text, option_};
  }

  // A value of an earlier frame's earlier frame, as through a subgraph; both ways of there being none have to come to the same.
  bool add_delay(WrittenEdge& edge, const WrittenEdge& source, const Candidate& candidate, const std::string& reader) {
    const WrittenInitial &a = *edge.initial, &b = *source.initial;
    const bool is_same = a.kind == b.kind && a.kind != Initial::Kind::endpoint && a.constant == b.constant;
    const int sum = edge.delay + source.delay;
    if (is_same && (edge.delay > 0) == (source.delay > 0) && std::abs(sum) <= kLongestDelay) {
      edge.delay = sum;
      return true;
    }
    tell(
        "'" + edge.from.text + "' cannot be bypassed: its input '" + candidate.input + "' has a delay, and so has " + reader +
        "; delays add up where both have the same sign and the same initial value, \"none\" or a constant, and come to at most " +
        std::to_string(kLongestDelay) + " frames");
    return false;
  }

  std::vector<std::string> describe() const {
    std::vector<std::string> lines;
    for (const auto& [port, candidate] : chosen_)
      lines.push_back("'" + candidate->edge->from.text + "'" +
                      (candidate->edge->delay != 0 ? " (with its delay of " + std::to_string(candidate->edge->delay) + ")" : "") +
                      " is read instead of '" + name() + "." + port + "'");
    if (lines.empty()) lines.emplace_back("nobody reads it");
    return lines;
  }

  Unfolded& graph_;
  Scope& scope_;
  const Child& child_;
  const WrittenNode node_;  // as it is before
  const Position option_;
  Diagnostics& errors_;
  std::vector<Candidate> candidates_;
  std::map<std::string, const Candidate*> chosen_;  // by output, with its item
};

}  // namespace

std::vector<std::string> bypass_node(Unfolded& graph, const EditedNode& edited, const Position& option, Diagnostics& errors) {
  return Bypass(graph, edited, option, errors).run();
}

}  // namespace quell::detail
