// quell check: is this graph right, and does it fit this sequence?
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "arguments.h"
#include "commands.h"
#include "job.h"
#include "progress.h"

namespace quell::app {
namespace {

struct Arguments {
  GraphArguments graph;
  SequenceArguments sequence;
  VerbosityArguments verbosity;
};

std::string count(std::size_t n, const std::string& noun) { return std::to_string(n) + " " + noun + (n == 1 ? "" : "s"); }

void tell_graph(const Graph& graph) {
  std::cout << graph.file.string() << ": ok: " << count(graph.nodes.size(), "node") << ", " << count(graph.inputs.size(), "input")
            << ", " << count(graph.outputs.size(), "output") << "\n";
}

void tell_fit(const Job& job, const std::string& place) {
  std::cout << place << ": ok: " << count(job.frames.size(), "frame") << " (" << FrameRange(job.frames).text() << ")";
  for (const Shape& shape : job.plan.inputs) {
    if (!shape.present || !is_image(shape.type)) continue;
    std::cout << ", " << shape.size.width << " x " << shape.size.height;
    break;
  }
  std::cout << ", " << format_bytes(job.plan.frame_bytes + job.plan.history_bytes) << " of images\n";
}

ExitCode run(const Arguments& arguments) {
  set_verbosity(arguments.verbosity.verbosity());
  const std::shared_ptr<const Graph> graph = load(arguments.graph);
  if (!arguments.sequence.given()) {
    tell_graph(*graph);
    return kOk;
  }
  const Job job = prepare_job(graph, arguments.sequence);
  tell_graph(*graph);
  tell_fit(job, arguments.sequence.sequence.empty() ? "--in" : arguments.sequence.sequence.string());
  return kOk;
}

}  // namespace

Command add_check(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("check", "Check a graph, and that a sequence fits it, without computing anything.");
  app.footer(
      "Example:\n"
      "  quell check my_graph.json shot/\n"
      "finds every mistake in the graph at once, with its line and column, then whether shot/ has the inputs that the graph "
      "needs, in sizes that go together.");
  auto arguments = std::make_shared<Arguments>();
  add_options(app, arguments->graph);
  add_options(app, arguments->sequence);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console&) { return run(*arguments); }};
}

}  // namespace quell::app
