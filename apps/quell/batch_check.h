// Whether `quell run` would understand the options of a shot.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "arguments.h"
#include "batch_list.h"
#include "quell/plugin/registry.h"

namespace quell::app {

/// Keeps what many shots have in common.
class BatchCheck {
 public:
  explicit BatchCheck(Diagnostics& errors) : errors_(errors) {}
  /// Parses what the options hold, and loads the graph. What is found is told at the option.
  void check(const Shot& shot);

 private:
  std::string wrong_in_graph(const GraphArguments& arguments);

  Diagnostics& errors_;
  std::map<std::vector<std::filesystem::path>, Registry> passes_;  // by --plugin-path
  std::map<std::vector<std::string>, std::string> graphs_;         // what is wrong, by all that the graph is made of
};

}  // namespace quell::app
