// Which parameters of a graph `quell tune` searches, and where.
#pragma once

#include <string>
#include <vector>

#include "quell/graph/graph.h"
#include "quell/text/json.h"

namespace quell::app {

/// A number that is searched within [low, high].
struct TunedParam {
  std::string name;  ///< as --set has it: "node.param", or "param" of the graph
  double start = 0;  ///< what the graph says
  double low = 0, high = 1;
  bool is_whole = false;
  bool is_geometric = false;  ///< equal steps of the search are equal factors

  /// Of a place from 0 to 1: a whole number, or one of six digits, so that what is written gives what was measured.
  double value(double place) const;
  /// The place of a value; 0 or 1 where it lies outside.
  double place(double value) const;
};

/// `names` as --params has them; `ranges` as --range has them: "name=low..high". Without one, a parameter that goes from 0 to 1,
/// or a whole number of few values, is searched as far as it may go, any other one above 0 from a sixteenth of its value to
/// sixteen times it. Throws Error(usage) naming the option: no such parameter, none that is a number, two that set the same, no
/// range to be had, or an impossible one.
std::vector<TunedParam> find_tuned_params(const Graph& graph, const std::string& names, const std::vector<std::string>& ranges);

/// "0.153"; six digits that matter.
std::string number_text(double value);
/// {"node.param": value}, as `quell run --params` takes it.
Json overrides(const std::vector<TunedParam>& params, const std::vector<double>& values);

}  // namespace quell::app
