// quell graph: how a graph would run.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "arguments.h"
#include "commands.h"
#include "job.h"
#include "quell/text/diagnostic.h"

namespace quell::app {
namespace {

struct Arguments {
  GraphArguments graph;
  SequenceArguments sequence;
  VerbosityArguments verbosity;
  std::string size = "1920x1080";
  std::vector<std::string> without;
};

Size parse_size(const std::string& text) {
  const std::size_t x = text.find('x');
  if (x == std::string::npos)
    throw Error(Fault::usage, "--size", "'" + text + "' is not a size; write width and height in pixels, such as 1920x1080");
  return {parse_count(text.substr(0, x), "--size", 1, Image::kMaxSize),
          parse_count(text.substr(x + 1), "--size", 1, Image::kMaxSize)};
}

/// What a sequence with every input, but those of `without`, would offer.
InputShapes imagine_inputs(const Graph& graph, Size size, const std::vector<std::string>& without) {
  InputShapes shapes;
  std::vector<std::string> optional;
  for (const GraphInput& input : graph.inputs) {
    const bool image = is_image(input.type);
    shapes[input.name] = Shape{input.type, image ? size : Size{}, input.type == QUELL_TYPE_VALUE ? 1u : 0u};
    if (input.optional) optional.push_back(input.name);
  }
  for (const std::string& name : without) {
    if (std::find(optional.begin(), optional.end(), name) == optional.end())
      throw Error(Fault::usage, "--without",
                  "the graph has no optional input '" + name + "'" + did_you_mean(name, optional) +
                      (optional.empty() ? "; all its inputs are required" : "; it has " + list_names(optional, "and")));
    shapes[name] = std::nullopt;
  }
  return shapes;
}

ExitCode run(const Arguments& arguments) {
  set_verbosity(arguments.verbosity.verbosity());
  const std::shared_ptr<const Graph> graph = load(arguments.graph);
  const Plan plan = arguments.sequence.given()
                        ? prepare_job(graph, arguments.sequence).plan
                        : make_plan(graph, imagine_inputs(*graph, parse_size(arguments.size), arguments.without));
  std::cout << describe(plan);
  return kOk;
}

}  // namespace

Command add_graph(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("graph", "Show how a graph would run: order, images, memory, loops.");
  app.footer(
      "Example:\n"
      "  quell graph games202 --size 3840x2160\n"
      "lists the nodes in the order in which they run, what each reads and writes, and how much memory a run takes at that "
      "size.");
  auto arguments = std::make_shared<Arguments>();
  add_options(app, arguments->graph);
  add_options(app, arguments->sequence);
  add_text(app, "--size", arguments->size, "WIDTHxHEIGHT", "Size of the images when no sequence is given; 1920x1080 otherwise.")
      ->group(kInputGroup);
  add_repeatable(app, "--without", arguments->without, "INPUT",
                 "Leave an optional input of the graph out when no sequence is given; repeatable.")
      ->group(kInputGroup);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console&) { return run(*arguments); }};
}

}  // namespace quell::app
