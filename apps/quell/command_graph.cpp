// quell graph: how a graph would run, in words or as a drawing.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "analyze.h"
#include "arguments.h"
#include "commands.h"
#include "graphviz.h"
#include "isa_option.h"
#include "job.h"
#include "quell/graph/graph_hash.h"
#include "quell/graph/plan_dot.h"
#include "quell/text/diagnostic.h"
#include "run_options.h"
#include "text_output.h"

namespace quell::app {
namespace {

constexpr std::size_t kMeasuredFrames = 6;

struct Arguments {
  GraphArguments graph;
  SequenceArguments sequence;
  VerbosityArguments verbosity;
  std::string size = "1920x1080";
  std::vector<std::string> without;
  bool analyze = false;
  bool dot = false, svg = false;
  std::optional<std::string> out;
  std::string threads = "0";
  IsaArguments isa;
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

/// Of the graph, and where it has several outputs, of each: their files tell it.
std::string describe_hashes(const Graph& graph) {
  std::string text = "\nhash\n  " + graph_hash(graph) + "\n";
  for (const GraphOutput& output : graph.outputs)
    if (graph.outputs.size() > 1) text += "  " + graph_hash(graph, {{output.name, output.from}}) + "  " + output.name + "\n";
  return text;
}

void print(const Plan& plan) { std::cout << describe(plan) << describe_hashes(*plan.graph) << std::flush; }

ExitCode describe_and_analyze(const std::shared_ptr<const Graph>& graph, const Arguments& arguments, Console& console) {
  pin_isa(arguments.isa);
  const int threads = parse_schedule({.threads = arguments.threads}).threads;
  Job job = prepare_job(graph, arguments.sequence);
  if (!arguments.sequence.frames && job.frames.size() > kMeasuredFrames) job.frames.resize(kMeasuredFrames);
  print(job.plan);
  return analyze_job(job, threads, console);
}

void check_drawing(const Arguments& arguments) {
  if (arguments.dot && arguments.svg) throw Error(Fault::usage, "--svg", "it cannot stand beside --dot; choose one of them");
  const bool draws = arguments.dot || arguments.svg;
  if (draws && arguments.analyze)
    throw Error(Fault::usage, "--analyze", "it cannot stand beside --dot and --svg; measure and draw one after the other");
  if (arguments.out && !draws) throw Error(Fault::usage, "--out", "it is for drawings; add --dot or --svg");
}

void draw(const Plan& plan, const Arguments& arguments) {
  const std::string dot = to_dot(plan);
  if (arguments.svg)
    write_output(draw_svg(dot), arguments.out, "<?xml ");
  else
    write_output(dot, arguments.out, "digraph ");
}

ExitCode run(const Arguments& arguments, Console& console) {
  set_verbosity(arguments.verbosity.verbosity());
  check_drawing(arguments);
  const std::shared_ptr<const Graph> graph = load(arguments.graph);
  if (arguments.analyze) return describe_and_analyze(graph, arguments, console);
  const Plan plan = arguments.sequence.given()
                        ? prepare_job(graph, arguments.sequence).plan
                        : make_plan(graph, imagine_inputs(*graph, parse_size(arguments.size), arguments.without));
  if (arguments.dot || arguments.svg)
    draw(plan, arguments);
  else
    print(plan);
  return kOk;
}

void add_drawing_options(CLI::App& app, Arguments& arguments) {
  app.add_flag("--dot", arguments.dot, "Print a drawing of the graph instead, in the language of Graphviz' dot.")
      ->disable_flag_override()
      ->group(kOutputGroup);
  app.add_flag("--svg", arguments.svg, "Print a drawing of the graph instead, as SVG. Needs Graphviz' program dot.")
      ->disable_flag_override()
      ->group(kOutputGroup);
  app.add_option("-o,--out", arguments.out, "Write the drawing to a file instead of printing it.")
      ->type_name("FILE")
      ->group(kOutputGroup);
}

}  // namespace

Command add_graph(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("graph", "Show how a graph would run: order, images, memory, loops. Or draw it.");
  app.footer(
      "Example:\n"
      "  quell graph games202 --size 3840x2160\n"
      "lists the nodes in the order in which they run, what each reads and writes, and how much memory a run takes at that "
      "size; the hash at the end tells graphs with other results apart.\n"
      "  quell graph games202 shot/ --analyze\n"
      "measures, too, how long each node takes on the first 6 frames, and tells what bounds the frames per second.\n"
      "  quell graph games202 --svg -o games202.svg\n"
      "draws the graph: edges in the color of their type, those of another frame dashed, optional inputs hollow.\n"
      "\n"
      "Exit status: 0 all is well, 1 a frame failed while measuring, 2 usage or graph, 3 input, 4 plugin, 33 too little "
      "memory for a frame, 70 internal error, 75 interrupted.");
  auto arguments = std::make_shared<Arguments>();
  add_options(app, arguments->graph);
  add_options(app, arguments->sequence);
  add_text(app, "--size", arguments->size, "WIDTHxHEIGHT", "Size of the images when no sequence is given; 1920x1080 otherwise.")
      ->group(kInputGroup);
  add_repeatable(app, "--without", arguments->without, "INPUT",
                 "Leave an optional input of the graph out when no sequence is given; repeatable.")
      ->group(kInputGroup);
  CLI::Option* analyze =
      app.add_flag(
             "--analyze", arguments->analyze,
             "Run the first 6 frames of the sequence, or those of --frames, on one thread and on all; print the time of each "
             "node and of the loops, and what bounds the frames per second. Results are written to a folder below TMPDIR, "
             "or /tmp, that is removed afterwards.")
          ->disable_flag_override()
          ->group(kScheduleGroup);
  add_text(app, "--threads", arguments->threads, "N",
           "Threads for --analyze; 0, the default, for as many as there are processors.")
      ->needs(analyze)
      ->group(kScheduleGroup);
  add_options(app, arguments->isa);
  app.get_option("--isa")->needs(analyze);
  add_drawing_options(app, *arguments);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console& console) { return run(*arguments, console); }};
}

}  // namespace quell::app
