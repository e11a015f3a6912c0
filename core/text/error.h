// The exception for everything that a user can put right: a graph, a file, an argument, a plugin.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace quell {

/// Whose fault it is; the runner turns it into its exit code.
enum class Fault {
  usage,   ///< command line, graph or parameter
  input,   ///< a sequence, image or camera that is missing or unreadable
  plugin,  ///< a plugin that does not load, or a pass that breaks the interface
  frame,   ///< a frame that could not be computed or written
  memory,  ///< a memory limit within which not even one frame fits
};

/// `where` names the place (a file, file:line:column, a node, an option), `what` says what is wrong and what would be right.
class Error : public std::runtime_error {
 public:
  Error(Fault fault, std::string where, const std::string& what)
      : std::runtime_error(where.empty() ? what : where + ": " + what), fault_(fault), where_(std::move(where)) {}
  Fault fault() const { return fault_; }
  const std::string& where() const { return where_; }

 private:
  Fault fault_;
  std::string where_;
};

}  // namespace quell
