// The machine and the program, as a report tells them.
#pragma once

#include <string>
#include <vector>

namespace quell::app {

struct Machine {
  std::string processor;  ///< "" when unknown
  std::string system;     ///< "Linux 6.1.0 x86_64"
  std::string isa;        ///< the vector unit that kernels run on
  int processors = 0;     ///< that this process may use
};
Machine describe_machine();

/// The words that this program was started with, the program's own name first.
std::vector<std::string> command_words();

/// "quell 0.1.0 (plugin interface 1.0)"
std::string version_text();

}  // namespace quell::app
