// --isa: which of the machine's vector units computes.
#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace quell::app {

struct IsaArguments {
  std::optional<std::string> isa;
};

void add_options(CLI::App& app, IsaArguments& arguments);

/// Pins what --isa names, or else QUELL_ISA, for the rest of the process; before anything is computed. Throws Error(usage) naming
/// the one or the other.
void pin_isa(const IsaArguments& arguments);

}  // namespace quell::app
