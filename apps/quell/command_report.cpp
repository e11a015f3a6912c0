// quell report: what graphs make of a sequence, as one page to look at.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "arguments.h"
#include "commands.h"
#include "graph_files.h"
#include "interrupt.h"
#include "isa_option.h"
#include "job.h"
#include "progress.h"
#include "report_data.h"
#include "report_page.h"
#include "report_run.h"
#include "report_size.h"
#include "run_options.h"
#include "run_reference.h"

namespace quell::app {
namespace {

constexpr double kLargeFile = 100e6;  // bytes; browsers are slow to open what is larger
constexpr const char* kReferenceName = "reference";

struct Arguments {
  SequenceArguments sequence;
  std::vector<std::string> graphs, set;
  std::vector<std::filesystem::path> params;
  PluginArguments plugins;
  std::optional<std::string> reference;
  MetricArguments metrics;
  std::string every = "1", inner;
  std::filesystem::path out;
  std::string threads = "0";
  IsaArguments isa;
  VerbosityArguments verbosity;
};

/// A graph's name as it was given, without folder and ending.
std::string short_name(const std::string& graph) { return std::filesystem::path(graph).stem().string(); }

std::vector<Operand> parse_graphs(const std::vector<std::string>& texts) {
  std::vector<Operand> graphs;
  for (const std::string& text : texts) {
    Operand graph = parse_operand(text);
    std::string label = graph.label.empty() ? short_name(graph.what) : graph.label;
    const auto is_taken = [&](const std::string& name) {
      return std::ranges::any_of(graphs, [&](const Operand& other) { return other.label == name; });
    };
    if (!graph.label.empty() && is_taken(label))
      throw Error(Fault::usage, text, "two graphs have the label '" + label + "'; give them labels of their own: LABEL=GRAPH");
    graph.label = label;
    for (int number = 2; is_taken(graph.label); ++number) graph.label = label + " " + std::to_string(number);
    graphs.push_back(std::move(graph));
  }
  return graphs;
}

/// Settings for every graph, and those that begin with this one's label and a colon.
std::vector<std::string> settings_for(const std::string& label, const std::vector<Operand>& graphs,
                                      const std::vector<std::string>& all) {
  std::vector<std::string> settings;
  for (const std::string& setting : all) {
    const auto owner = std::ranges::find_if(graphs, [&](const Operand& graph) { return setting.starts_with(graph.label + ":"); });
    if (owner == graphs.end())
      settings.push_back(setting);
    else if (owner->label == label)
      settings.push_back(setting.substr(label.size() + 1));
  }
  return settings;
}

bool has_input(const Sequence& sequence, const std::string& name) {
  return std::ranges::any_of(sequence.inputs(), [&](const InputFiles& input) { return input.input == name; });
}

ReportFrames choose_frames(const std::vector<ReportedGraph>& graphs, const Arguments& arguments) {
  ReportFrames frames;
  frames.all = graphs.front().job.frames;
  for (const ReportedGraph& graph : graphs)
    std::erase_if(frames.all, [&](std::int64_t frame) { return !std::ranges::binary_search(graph.job.frames, frame); });
  if (frames.all.empty()) throw Error(Fault::input, "SEQUENCE", "there is no frame that all graphs can compute");
  const auto every = static_cast<std::size_t>(parse_count(arguments.every, "--every", 1, 1000000));
  for (std::size_t i = 0; i < frames.all.size(); i += every) frames.kept.insert(frames.all[i]);
  if (arguments.inner == "all") {
    frames.inner = frames.kept;
  } else if (arguments.inner.empty()) {
    frames.inner = {*frames.kept.rbegin()};
  } else if (arguments.inner != "none") {
    const std::int64_t frame = parse_count(arguments.inner, "--inner", 0, std::numeric_limits<int>::max(), ", 'all' or 'none'");
    if (!std::ranges::binary_search(frames.all, frame))
      throw Error(Fault::usage, "--inner",
                  "frame " + arguments.inner + " is not computed; the frames are " + FrameRange(frames.all).text());
    frames.kept.insert(frame);
    frames.inner = {frame};
  }
  for (const std::int64_t frame : frames.inner)
    if (std::ranges::binary_search(frames.all, frame - 1)) frames.before.insert(frame - 1);
  return frames;
}

std::string megabytes(double bytes) { return fmt::format("{:.0f} MB", bytes / 1e6); }

void warn_of_size(double bytes, const char* verb) {
  spdlog::warn(
      "the report {} about {}, which browsers are slow to open; --every N keeps the images of fewer frames, --crop smaller ones, "
      "--inner none fewer",
      verb, megabytes(bytes));
}

/// The last part of a path, whatever way it is written: of "shot/", and of "." in a folder of that name, "shot".
std::string name_of_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::path whole = std::filesystem::absolute(path, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  return whole.filename().string();
}

Report prepare(const Arguments& arguments) {
  Report report;
  const std::vector<Operand> graphs = parse_graphs(arguments.graphs);
  const Registry passes = load_passes(arguments.plugins);
  std::string described;
  for (const Operand& graph : graphs) {
    GraphArguments one;
    one.graph = graph.what;
    one.options.set = settings_for(graph.label, graphs, arguments.set);
    one.options.params = arguments.params;
    ReportedGraph& reported = report.graphs.emplace_back();
    reported.label = graph.label;
    const std::shared_ptr<const Graph> loaded = load(one, passes);
    for (const std::filesystem::path& file : loaded->files)
      reported.files.emplace_back(file.string(), read_text(file, Fault::usage)->text);
    reported.job = prepare_job(loaded, arguments.sequence, {}, {}, described);
    described = reported.job.sequence->describe();
    reported.inner = list_inner_images(reported.job.plan);
    reported.weighed = find_weighed(reported.job.plan);
  }
  report.frames = choose_frames(report.graphs, arguments);
  report.sequence = arguments.sequence.sequence.string();
  report.threads = parse_schedule({.threads = arguments.threads}).threads;
  if (report.threads == 0) report.threads = available_threads();
  std::string labels;
  for (const Operand& graph : graphs) labels += (labels.empty() ? "" : ", ") + graph.label;
  report.title = labels + " on " + name_of_folder(report.sequence);
  return report;
}

/// What each graph is measured by; its outputs are its own.
std::vector<std::optional<MeasuringOptions>> prepare_measuring_of(Report& report, const Arguments& arguments) {
  ReferenceArguments reference{arguments.reference, arguments.metrics};
  if (!reference.reference && has_input(*report.graphs.front().job.sequence, kReferenceName))
    reference.reference = kReferenceName;
  std::vector<std::optional<MeasuringOptions>> measuring;
  for (const ReportedGraph& graph : report.graphs) {
    Job job = graph.job;
    job.frames = report.frames.all;
    measuring.push_back(prepare_measuring(reference, arguments.sequence, job, {}));
    if (!measuring.back()) continue;
    if (!arguments.metrics.metrics)
      measuring.back()->compare.metrics =
          default_metrics({Metric::psnr, Metric::ssim, Metric::relmse, Metric::smape, Metric::flip},
                          {Metric::tpsnr, Metric::warped}, report.frames.all);
    complete_measuring(*measuring.back(), report.threads);
  }
  report.measuring = measuring.front();
  return measuring;
}

ExitCode run(const Arguments& arguments, Console& console) {
  handle_interrupts();
  set_verbosity(arguments.verbosity.verbosity());
  pin_isa(arguments.isa);
  check_report_file(arguments.out);
  Report report = prepare(arguments);
  const auto measuring = prepare_measuring_of(report, arguments);
  const double estimate = estimate_bytes(report);
  spdlog::debug("the report will have about {}", megabytes(estimate));
  if (estimate > kLargeFile) warn_of_size(estimate, "will have");
  PackedImages packed;
  bool has_failed = false;
  try {
    for (std::size_t i = 0; i < report.graphs.size(); ++i) {
      ReportedGraph& graph = report.graphs[i];
      console.set_status(fmt::format("[{}/{}] {}", i + 1, report.graphs.size(), graph.label));
      SessionOptions session;
      session.threads = report.threads;
      run_for_report(graph, report.frames, measuring[i], session, packed);
      draw_for_report(graph);
      tell_new_warnings(graph.job);
      if (measuring[i]) tell_new_warnings(*measuring[i], graph.job);
      if (interrupted()) throw Interrupted{};
      has_failed |= std::ranges::any_of(graph.frames, [](const FrameReport& frame) { return !frame.ok; });
      spdlog::info("{}: {} frames in {}", graph.label, graph.frames.size(), format_duration(graph.seconds));
    }
    report.inputs = read_inputs(report.graphs, report.frames, report.measuring, packed);
    if (interrupted()) throw Interrupted{};
  } catch (const Interrupted&) {
    console.set_status("");
    spdlog::warn("interrupted; no report was written");
    return kInterrupted;
  }
  console.set_status("");
  write_report(arguments.out, report.title, report_data(report, packed), packed);
  std::error_code error;
  const auto bytes = static_cast<double>(std::filesystem::file_size(arguments.out, error));
  if (bytes > kLargeFile && estimate <= kLargeFile) warn_of_size(bytes, "has");
  spdlog::info("written {}, {:.1f} MB; open it in a browser", arguments.out.string(), bytes / 1e6);
  return has_failed ? kFramesFailed : kOk;
}

}  // namespace

Command add_report(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("report", "Look at what graphs make of a sequence, in a page for the browser.");
  app.footer(
      "Example:\n"
      "  quell report shot/ svgf best -o report.html\n"
      "runs both graphs and writes one file, which needs nothing else: results beside noise and reference, errors, figures and "
      "times of frame after frame, the graphs, and what each pass made of a pixel.\n"
      "  quell report shot/ svgf soft=svgf --set soft:alpha=0.05 -o report.html\n"
      "compares a graph with itself under another setting.\n"
      "\n"
      "Exit status: 0 all is well, 1 some frames failed, 2 usage or graph, 3 input, 4 plugin, 33 too little memory for a frame, "
      "70 internal error, 75 interrupted.");
  auto arguments = std::make_shared<Arguments>();
  add_options(app, arguments->sequence);
  app.get_option("SEQUENCE")->required();
  app.add_option("GRAPHS", arguments->graphs,
                 "Graph files, or bare names of graphs that ship with quell (games202), each with a label of its own where it "
                 "is written as LABEL=GRAPH.")
      ->required();
  add_repeatable(app, "--set", arguments->set, "[LABEL:]NODE.PARAM=VALUE",
                 "Set a parameter of every graph, or of the one with this label; repeatable.")
      ->group(kGraphGroup);
  app.add_option("--params", arguments->params,
                 "Read parameters of every graph from a JSON file: {\"node.param\": value}; repeatable, and --set wins.")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(kGraphGroup);
  add_options(app, arguments->plugins);
  app.add_option("--reference", arguments->reference,
                 "What results should look like: an input of the sequence ('reference', where there is one, by default), or "
                 "files or a folder.")
      ->type_name("NAME")
      ->group(kMeasureGroup);
  add_metric_options(app, arguments->metrics,
                     "psnr, ssim, relmse, smape, flip, and, where frames follow each other, tpsnr and warped");
  add_text(app, "--every", arguments->every, "N",
           "Keep the images of every Nth frame; 1 by default. All frames are computed, and have figures and times.")
      ->group(kOutputGroup);
  add_text(app, "--inner", arguments->inner, "FRAME|all|none",
           "The frame whose inner images are kept, by default the last one; of all frames that are kept, or of none.")
      ->group(kOutputGroup);
  app.add_option("-o,--out", arguments->out, "The file to write.")->type_name("FILE")->required()->group(kOutputGroup);
  add_text(app, "--threads", arguments->threads, "N",
           "Threads that compute; 0, the default, for as many as there are processors.")
      ->group(kScheduleGroup);
  add_options(app, arguments->isa);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console& console) { return run(*arguments, console); }};
}

}  // namespace quell::app
