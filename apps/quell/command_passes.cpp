// quell passes: what passes there are, and what each says of itself.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "arguments.h"
#include "commands.h"
#include "describe_pass.h"
#include "graph_files.h"
#include "quell/text/diagnostic.h"
#include "text_layout.h"

namespace quell::app {
namespace {

struct Arguments {
  std::string id;
  PluginArguments plugins;
  VerbosityArguments verbosity;
};

void list_passes(const Registry& registry) {
  std::size_t width = 0;
  for (const auto& [id, pass] : registry.passes()) width = std::max(width, id.size());
  for (const auto& [id, pass] : registry.passes())
    std::cout << entry(id + std::string(width - id.size(), ' ') + "  " + std::to_string(pass.desc->version), pass.desc->summary,
                       0, width + 6);
  if (registry.passes().empty()) std::cout << "no passes were found\n";
}

void list_plugins(const Registry& registry) {
  std::cout << "\nplugins\n";
  for (const PluginReport& report : registry.reports()) {
    std::string passes;
    for (const std::string& id : report.passes) passes += (passes.empty() ? "" : ", ") + id;
    std::cout << "  " << report.file.string() << "\n" << wrap(passes.empty() ? "no passes" : passes, 4);
    if (!report.error.empty()) std::cout << wrap("not loaded: " + report.error, 4);
  }
}

const RegisteredPass& find(const Registry& registry, const std::string& id) {
  if (const RegisteredPass* pass = registry.find(id)) return *pass;
  std::vector<std::string> ids;
  for (const auto& [known, pass] : registry.passes()) ids.push_back(known);
  throw Error(Fault::usage, "",
              "there is no pass '" + id + "'" + did_you_mean(id, ids) + "; `quell passes` lists those that were found");
}

ExitCode run(const Arguments& arguments) {
  set_verbosity(arguments.verbosity.verbosity());
  const Registry registry = load_plugins(arguments.plugins.plugin_path);
  const PluginTroubles troubles = find_troubles(registry, arguments.plugins);
  for (const std::string& trouble : troubles.asked_for) spdlog::error("plugin {}", trouble);
  for (const std::string& trouble : troubles.others) spdlog::warn("plugin {}", trouble);
  if (!arguments.id.empty())
    std::cout << describe(find(registry, arguments.id));
  else
    list_passes(registry);
  if (arguments.id.empty() && arguments.verbosity.verbose) list_plugins(registry);
  return troubles.asked_for.empty() ? kOk : kPlugin;
}

}  // namespace

Command add_passes(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("passes", "List the passes, or describe one in full.");
  app.footer(
      "Example:\n"
      "  quell passes joint_bilateral\n"
      "tells what the pass does and after which paper, its inputs and outputs, and each parameter with default and range.");
  auto arguments = std::make_shared<Arguments>();
  app.add_option("ID", arguments->id, "The pass to describe; without it, all are listed.");
  add_options(app, arguments->plugins);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console&) { return run(*arguments); }};
}

}  // namespace quell::app
