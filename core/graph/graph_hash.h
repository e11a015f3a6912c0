// One number for what a graph computes: to tell whether results, or a checkpoint, are those of this graph.
#pragma once

#include <map>
#include <string>

#include "quell/graph/graph.h"

namespace quell {

/// 128 bits as 32 hexadecimal digits: XXH3 of canonical_text(). The same on every machine and in every run. It says nothing of
/// the images that are read, and trusts a pass's version: a plugin that changes what it computes has to raise it.
std::string graph_hash(const Graph& graph);
/// The same of the part of the graph that these results need, under their names: it stays when something else of the graph
/// changes. Where the results are the outputs, and need every node and input, it is that of the graph.
std::string graph_hash(const Graph& graph, const std::map<std::string, Endpoint>& results);

/// What determines the results of a graph, in one form only. In it are, sorted by name: inputs with type and whether they are
/// optional; nodes, those of subgraphs by their qualified names, with pass, its version, every parameter (defaults, too) and
/// what feeds each port (delays and initial values, too); outputs. A file that a parameter names stands there by its content,
/// since its path differs between machines (by its path where it cannot be read); what else it may refer to is not looked at.
///
/// Not in it: documentation, the graph's own name, names of graph files, the order of keys, what was set where. A node's name is,
/// although it changes no pixel: dumped images and what is kept of a node go by it, and must not be taken for another's.
std::string canonical_text(const Graph& graph);
std::string canonical_text(const Graph& graph, const std::map<std::string, Endpoint>& results);

}  // namespace quell
