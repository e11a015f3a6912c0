// The subcommands. Each adds itself to the program's options and returns what runs it.
#pragma once

#include <functional>

#include "console.h"
#include "exit_code.h"

namespace CLI {
class App;
}

namespace quell::app {

struct Command {
  CLI::App* options = nullptr;
  std::function<ExitCode(Console&)> run;  ///< after the command line was parsed; throws Error
};

Command add_run(CLI::App& program);
Command add_batch(CLI::App& program);
Command add_check(CLI::App& program);
Command add_compare(CLI::App& program);
Command add_graph(CLI::App& program);
Command add_inspect(CLI::App& program);
Command add_passes(CLI::App& program);
Command add_plan(CLI::App& program);
Command add_report(CLI::App& program);
Command add_schema(CLI::App& program);
Command add_tune(CLI::App& program);
Command add_new(CLI::App& program);

}  // namespace quell::app
