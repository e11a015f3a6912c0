// quell schema: what a graph file may hold, for editors.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "arguments.h"
#include "commands.h"
#include "graph_files.h"
#include "quell/graph/schema.h"
#include "text_output.h"

namespace quell::app {
namespace {

struct Arguments {
  std::optional<std::string> out;
  PluginArguments plugins;
  VerbosityArguments verbosity;
};

ExitCode run(const Arguments& arguments) {
  set_verbosity(arguments.verbosity.verbosity());
  write_output(graph_schema(load_passes(arguments.plugins)), arguments.out, kSchemaBeginning);
  return kOk;
}

}  // namespace

Command add_schema(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("schema", "Write a JSON Schema of graph files, for editors that complete and check.");
  app.footer(
      "Example:\n"
      "  quell schema --plugin-path my_passes/ -o quell-graph.schema.json\n"
      "writes it beside your graphs. A graph that says \"$schema\": \"quell-graph.schema.json\" is completed, checked and "
      "explained in VS Code and other editors: passes with their inputs and parameters, ranges, defaults and documentation, as "
      "the passes that were found have them. `quell check` finds more, since it knows what the whole graph is.\n"
      "\n"
      "Exit status: 0 all is well, 2 usage, 4 plugin, 70 internal error.");
  auto arguments = std::make_shared<Arguments>();
  app.add_option("-o,--out", arguments->out, "Write to a file; without it, the schema is printed.")
      ->type_name("FILE")
      ->group(kOutputGroup);
  add_options(app, arguments->plugins);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console&) { return run(*arguments); }};
}

}  // namespace quell::app
