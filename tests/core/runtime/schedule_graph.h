// Random graphs of the passes in passes/ (those with ring.h), as data that a test can follow without any of quell's own code.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "quell/graph/graph.h"

namespace quell::test {

/// Draws below a bound. Not std::uniform_int_distribution, whose numbers differ between libraries.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  int below(int bound) { return static_cast<int>(engine_() % static_cast<unsigned>(bound)); }
  int from(int least, int most) { return least + below(most - least + 1); }
  bool chance(int percent) { return below(100) < percent; }
  template <class T>
  const T& pick(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(below(static_cast<int>(list.size())))];
  }

 private:
  std::mt19937 engine_;
};

enum class Kind { stir, soften, reduce, shelter, parts, tally, apply, falter, shrink, pulse };

/// Where a value comes from: an output of a node, or a graph input.
struct Place {
  int node = -1;  ///< -1: a graph input
  int port = 0;   ///< of a graph input: its index; else 0, as each pass has one output
  int item = 0;   ///< of the output of `parts`
  bool operator==(const Place&) const = default;
  auto operator<=>(const Place&) const = default;
};

struct Wire {
  enum class Start { none, constant, place };
  Place from;
  int delay = 0;
  Start start = Start::none;  ///< what stands there when there is no such frame
  int constant = 0;
  Place place = {};
};

struct TestNode {
  Kind kind = Kind::stir;
  int salt = 0;
  int radius = 0;                ///< of soften
  bool in_place = false;         ///< of stir, parts and falter
  std::vector<int> fails = {};   ///< frames, of falter; of pulse those with a 1
  std::string how = "chunk";     ///< of falter
  std::vector<Wire> main = {};   ///< one, required
  std::vector<Wire> other = {};  ///< at most one, optional: `other`, `previous` or `by`
  std::vector<Wire> list = {};   ///< `more` or `items`
  int group = -1;                ///< the subgraph that it is part of
};

struct TestInput {
  std::string name;
  PortType type = QUELL_TYPE_COLOR;
  bool optional = false;
  bool absent = false;  ///< an optional one that the source does not have
};

struct TestGraph {
  std::vector<TestInput> inputs;
  std::vector<TestNode> nodes;  ///< undelayed wires lead from earlier to later ones
  std::vector<Place> outputs;   ///< called out0, out1, ...
  std::vector<Place> dumps;
  std::vector<int> file_order;  ///< in which nodes are written down
  int groups = 0;
  std::map<int, Place> resets;  ///< of subgraphs, and of the whole graph at -1

  const TestNode& node(const Place& place) const { return nodes[static_cast<std::size_t>(place.node)]; }
  PortType type(const Place& place) const;
  /// How often the size was halved on the way.
  int level(const Place& place) const;
  /// Whether there is such a value in any frame. What lacks an input that the source does not have is left out.
  bool present(const Place& place) const;
  /// What resets the history of a node, which may read none.
  std::vector<Place> resets_of(int node) const;
  /// Whether the wire carries something in every frame.
  bool always(const Wire& wire) const;
  std::string name(int node) const;            ///< "n3", or "g0.n3" in a subgraph
  std::string name(const Place& place) const;  ///< "g0.n3.color", as Graph::find and reports have it
};

/// All wires of a node.
std::vector<Wire> wires(const TestNode& node);

/// A graph that can be planned; `frames` are those on which a pass may be told to fail.
TestGraph random_graph(unsigned seed, const std::vector<std::int64_t>& frames);

/// As a graph file; subgraphs are written into `folder`.
std::string to_json(const TestGraph& graph, const std::string& folder);
/// The same, read and checked. Subgraphs go to a folder of this process that is removed again.
std::shared_ptr<const Graph> load(const TestGraph& graph);

}  // namespace quell::test
