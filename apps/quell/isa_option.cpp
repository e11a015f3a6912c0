#include "isa_option.h"

#include <CLI/CLI.hpp>

#include "arguments.h"
#include "quell/simd/isa.h"
#include "quell/text/diagnostic.h"

namespace quell::app {

void add_options(CLI::App& app, IsaArguments& arguments) {
  app.add_option("--isa", arguments.isa,
                 "Vector unit that computes: best, the default, or one that this machine has: " + list_names(isas()) +
                     ". Results on one are the same, bit for bit, on different ones they differ in the last bits. Without it, "
                     "the environment variable QUELL_ISA counts.")
      ->type_name("NAME")
      ->group(kScheduleGroup);
}

void pin_isa(const IsaArguments& arguments) {
  if (arguments.isa)
    quell::pin_isa(*arguments.isa, "--isa");
  else
    pin_isa_from_environment();
}

}  // namespace quell::app
