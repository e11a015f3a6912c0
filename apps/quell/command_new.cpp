// quell new: skeletons to begin with.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "arguments.h"
#include "commands.h"
#include "new_skeleton.h"

namespace quell::app {
namespace {

constexpr const char* kNameHelp = "Small letters, digits and '_'.";
constexpr const char* kStatus =
    "\n"
    "Exit status: 0 everything was written, 1 a file cannot be written, 2 usage: a name that is taken or not possible, or a file "
    "that exists. Nothing is ever overwritten, and after an error everything is as it was.";

ExitCode write(const Skeleton& skeleton) {
  skeleton.files.commit();
  std::cout << "written\n";
  for (const std::string& line : skeleton.written) std::cout << "  " << line << "\n";
  for (const Skeleton::Step& step : skeleton.next) {
    std::cout << "\n" << step.title << "\n";
    for (const std::string& command : step.commands) std::cout << "  " << command << "\n";
  }
  return kOk;
}

Command add_new_pass(CLI::App& parent) {
  CLI::App& app = *parent.add_subcommand("pass", "Write a pass, with its test, that builds and works as it is.");
  app.footer(
      std::string(
          "Example:\n"
          "  quell new pass soften\n"
          "writes a plugin of its own into the folder soften/: CMakeLists.txt, soften.cpp and soften_test.cpp, and says how "
          "to build and test it. The pass is a small filter guided by normals, with comments that say where everything goes.\n"
          "\n"
          "In quell's source tree the files go to passes/PLUGIN/ and tests/passes/, with a line in "
          "passes/CMakeLists.txt.\n") +
      kStatus);
  auto pass = std::make_shared<NewPass>();
  app.add_option("NAME", pass->name, std::string("The pass's id. ") + kNameHelp)->required();
  app.add_option("--folder", pass->folder,
                 "Where to write: a folder for the plugin, NAME otherwise; or the root of quell's source tree, which the current "
                 "folder may be, too.")
      ->type_name("FOLDER")
      ->group(kOutputGroup);
  add_text(app, "--plugin", pass->plugin, "PLUGIN",
           "The plugin that has the pass, NAME otherwise. In quell's source tree, one that there is, 'spatial' otherwise, or a "
           "new one.")
      ->group(kOutputGroup);
  return {&app, [pass](Console&) { return write(make_pass_skeleton(*pass)); }};
}

Command add_new_graph(CLI::App& parent) {
  CLI::App& app = *parent.add_subcommand("graph", "Write a graph, with its test, that runs as it is.");
  app.footer(
      std::string(
          "Example:\n"
          "  quell new graph soft\n"
          "writes soft.json, soft_test.cpp and the test's CMakeLists.txt into the folder soft/, and says how to try and to "
          "test it. The graph filters each frame and averages over time.\n"
          "\n"
          "The test runs the graph in memory, on made-up frames of a scene at rest: a flat picture must stay flat, and "
          "noise must become less, more so with every frame. In quell's source tree the files go to graphs/ and "
          "tests/graphs/.\n") +
      kStatus);
  auto graph = std::make_shared<NewGraph>();
  app.add_option("NAME", graph->name, std::string("The graph's name. ") + kNameHelp)->required();
  app.add_option(
         "--folder", graph->folder,
         "Where to write: any folder, NAME otherwise; or the root of quell's source tree, which the current folder may be, "
         "too.")
      ->type_name("FOLDER")
      ->group(kOutputGroup);
  return {&app, [graph](Console&) { return write(make_graph_skeleton(*graph)); }};
}

}  // namespace

Command add_new(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("new", "Write a pass or a graph to begin with, and its test.");
  app.footer(
      "Example:\n"
      "  quell new pass soften\n"
      "  quell new graph soft\n"
      "\n"
      "`quell new pass --help` and `quell new graph --help` tell more.");
  app.require_subcommand(0, 1);
  const std::vector<Command> kinds = {add_new_pass(app), add_new_graph(app)};
  for (const Command& kind : kinds) kind.options->get_option("--help")->group(kOtherGroup);
  return {&app, [&app, kinds](Console& console) {
            for (const Command& kind : kinds)
              if (kind.options->parsed()) return kind.run(console);
            std::cout << app.help();
            return kOk;
          }};
}

}  // namespace quell::app
