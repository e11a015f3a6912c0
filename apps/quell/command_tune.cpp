// quell tune: parameters of a graph that bring its output nearest to a reference.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include "arguments.h"
#include "commands.h"
#include "figure_text.h"
#include "graph_files.h"
#include "interrupt.h"
#include "isa_option.h"
#include "job.h"
#include "progress.h"
#include "quell/sequence/frame_range.h"
#include "quell/text/json_write.h"
#include "run_options.h"
#include "run_reference.h"
#include "text_layout.h"
#include "text_output.h"
#include "trial.h"
#include "tuned_params.h"
#include "tuning.h"

namespace quell::app {
namespace {

constexpr std::string_view kOutputBeginning = "{";
constexpr double kImpossible = 1e12;  // cost of values that the graph refuses

struct Arguments {
  GraphArguments graph;
  SequenceArguments sequence;
  ScheduleArguments schedule;
  IsaArguments isa;
  VerbosityArguments verbosity;
  std::string params, reference = "reference", metric = "mixed", display;
  std::vector<std::string> ranges;
  std::optional<std::string> held_out, out;
  std::string evaluations = "0";
  bool everywhere = false, dry_run = false;
};

/// Frames that are searched on, and those that tell whether what was found holds elsewhere.
struct FrameHalves {
  std::vector<std::int64_t> tuned, held_out;
};

FrameHalves split_frames(const Job& job, const MeasuringOptions& measuring, const std::optional<std::string>& held_out) {
  std::vector<std::int64_t> frames;
  std::ranges::copy_if(job.frames, std::back_inserter(frames),
                       [&](std::int64_t frame) { return measuring.has_reference(frame); });
  FrameHalves halves;
  if (held_out) {
    const std::vector<std::int64_t> asked =
        *held_out == "none" ? std::vector<std::int64_t>() : FrameRange::parse(*held_out, "--held-out").frames();
    for (const std::int64_t frame : frames)
      (std::ranges::find(asked, frame) == asked.end() ? halves.tuned : halves.held_out).push_back(frame);
    if (halves.held_out.empty() && *held_out != "none")
      throw Error(Fault::usage, "--held-out",
                  "none of these is a frame with a reference; those are " + FrameRange(frames).text());
  } else {
    const auto middle = frames.begin() + static_cast<std::ptrdiff_t>((frames.size() + 1) / 2);
    halves = {{frames.begin(), middle}, {middle, frames.end()}};
  }
  if (halves.tuned.empty())
    throw Error(Fault::usage, "--held-out", "no frame is left to search on; hold fewer back of " + FrameRange(frames).text());
  return halves;
}

class Tuning {
 public:
  Tuning(const Arguments& arguments, Console& console)
      : arguments_(arguments),
        console_(console),
        passes_(load_passes(arguments.graph.plugins)),
        goal_(parse_goal(arguments.metric)) {
    job_ = prepare_job(load(arguments.graph, passes_), arguments.sequence);
    params_ = find_tuned_params(*job_.graph, arguments.params, arguments.ranges);
    const int asked = parse_count(arguments.evaluations, "--evaluations", 0, 1000000);
    evaluations_ = asked > 0 ? asked : 20 + 20 * static_cast<int>(params_.size());
    session_ = parse_schedule(arguments.schedule);
    ReferenceArguments reference;
    reference.reference = arguments.reference;
    if (!arguments.display.empty()) reference.metrics.display = arguments.display;
    measuring_ = prepare_measuring(reference, arguments.sequence, job_, {});
    measuring_->compare.metrics = goal_.metrics;
    halves_ = split_frames(job_, *measuring_, arguments.held_out);
  }

  ExitCode run() {
    if (arguments_.out) require_writable(*arguments_.out, kOutputBeginning);
    spdlog::info(
        "searching {} on {}; {}, {} evaluations", list_params(), describe_frames(halves_.tuned, "frame"),
        halves_.held_out.empty() ? std::string("nothing is held out") : describe_frames(halves_.held_out, "frame") + " held out",
        evaluations_);
    if (arguments_.dry_run) {
      std::cout << describe_search();
      return kOk;
    }
    complete_measuring(*measuring_, session_.threads);
    trials_.emplace(job_, *measuring_, session_);
    std::vector<double> start;
    for (const TunedParam& param : params_) start.push_back(param.start);
    best_ = start_values_ = start;
    bool is_interrupted = false;
    try {
      start_ = measure(start, {halves_.tuned}).front();
      tell("start", start, start_);
      best_figures_ = start_, least_ = known_[start] = cost(goal_, start_, start_);
      std::vector<double> places;
      for (const TunedParam& param : params_) places.push_back(param.place(param.start));
      find_least(places, {evaluations_, arguments_.everywhere}, [&](const std::vector<double>& at) { return evaluate(at); });
    } catch (const Trials::Interrupted&) { is_interrupted = true; } catch (...) {  // what was found until then is kept
      if (!start_.empty()) write();
      throw;
    }
    console_.set_status("");
    if (start_.empty()) return kInterrupted;
    write();
    if (is_interrupted) spdlog::warn("interrupted after {} of {} evaluations; the best of them are kept", done_, evaluations_);
    if (!is_interrupted) is_interrupted = !measure_held_out();
    tell_table();
    return is_interrupted ? kInterrupted : kOk;
  }

 private:
  std::shared_ptr<const Graph> graph_with(const std::vector<double>& values) const {
    GraphArguments graph = arguments_.graph;
    for (std::size_t i = 0; i < params_.size(); ++i) graph.options.set.push_back(params_[i].name + "=" + number_text(values[i]));
    return load_graph(find_graph(graph.graph), passes_, graph.options);
  }
  std::vector<Figures> measure(const std::vector<double>& values, const std::vector<std::vector<std::int64_t>>& sets) {
    return trials_->run(graph_with(values), sets);
  }

  double evaluate(const std::vector<double>& places) {
    std::vector<double> values;
    for (std::size_t i = 0; i < params_.size(); ++i) values.push_back(params_[i].value(places[i]));
    if (const auto known = known_.find(values); known != known_.end()) return known->second;
    if (interrupted()) throw Trials::Interrupted{};
    ++done_;
    Figures figures;
    try {
      figures = trials_->run(graph_with(values), {halves_.tuned}).front();
    } catch (const Error& error) {
      if (error.fault() != Fault::usage) throw;
      spdlog::debug("{}: {} are impossible together: {}", done_, list_values(values), error.what());
      return known_[values] = kImpossible;
    }
    const double result = known_[values] = cost(goal_, figures, start_);
    if (result < least_) {
      least_ = result, best_ = values, best_figures_ = figures;
      tell(std::to_string(done_), values, figures);
      if (arguments_.out) write();
    } else {
      spdlog::debug("{}: {}; {}", done_, figures_text(goal_, figures, start_), list_values(values));
    }
    console_.set_status("[" + std::to_string(done_) + "/" + std::to_string(evaluations_) + "] best " +
                        figures_text(goal_, best_figures_, start_));
    return result;
  }

  void tell(const std::string& what, const std::vector<double>& values, const Figures& figures) const {
    spdlog::info("{}: {}; {}", what, figures_text(goal_, figures, start_.empty() ? figures : start_), list_values(values));
  }

  void write() const { write_output(write_json(overrides(params_, best_)), arguments_.out, kOutputBeginning); }

  // Of the frames that were held out; false when interrupted.
  bool measure_held_out() {
    if (halves_.held_out.empty()) return true;
    try {
      held_out_before_ = measure(start_values_, {halves_.held_out}).front();
      held_out_after_ = measure(best_, {halves_.held_out}).front();
      return true;
    } catch (const Trials::Interrupted&) {
      spdlog::warn("interrupted; the frames that were held out are not measured");
      return false;
    }
  }

  void tell_table() const {
    std::string table = params_table() + figures_rows(describe_frames(halves_.tuned, "frame"), start_, best_figures_);
    if (!held_out_after_.empty())
      table += figures_rows(describe_frames(halves_.held_out, "held-out frame"), held_out_before_, held_out_after_);
    (arguments_.out ? std::cout : std::cerr) << table;
    if (best_ == start_values_) spdlog::warn("nothing better than the start was found");
    if (!held_out_after_.empty() &&
        cost(goal_, held_out_after_, held_out_before_) > cost(goal_, held_out_before_, held_out_before_))
      spdlog::warn(
          "on the frames that were held out, the tuned values are worse than those of the start: they fit these frames alone; "
          "search fewer parameters, or on more frames");
    if (arguments_.out)
      spdlog::info("written {}; use it with: quell run {} ... --params {}", *arguments_.out, arguments_.graph.graph,
                   *arguments_.out);
  }

  std::string params_table() const {
    std::string table = row("", {"start", "tuned", "searched"});
    for (std::size_t i = 0; i < params_.size(); ++i)
      table += row(params_[i].name, {number_text(params_[i].start), number_text(best_[i]), range_text(params_[i])});
    return table;
  }
  std::string figures_rows(const std::string& frames, const Figures& before, const Figures& after) const {
    std::string rows;
    if (goal_.metrics.size() > 1) rows += row(goal_.name + ", " + frames, {"1", figure_text(cost(goal_, after, before), 4)});
    for (std::size_t i = 0; i < goal_.metrics.size(); ++i) {
      const int decimals = decimals_for(goal_.metrics[i], std::vector<double>{before[i], after[i]});
      rows += row(std::string(info(goal_.metrics[i]).name) + ", " + frames,
                  {figure_text(before[i], decimals), figure_text(after[i], decimals)});
    }
    return rows;
  }
  static std::string row(const std::string& label, const std::vector<std::string>& cells) {
    constexpr std::size_t kLabel = 36, kCell = 12;
    std::string line = "  " + label;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::size_t column = kLabel + i * kCell;
      line += std::string(columns_of(line) + 2 < column ? column - columns_of(line) : 2, ' ') + cells[i];
    }
    return line + "\n";
  }
  static std::string range_text(const TunedParam& param) { return number_text(param.low) + ".." + number_text(param.high); }
  static std::string describe_frames(const std::vector<std::int64_t>& frames, const std::string& what) {
    return what + (frames.size() == 1 ? " " : "s ") + FrameRange(frames).text();
  }

  std::string list_params() const {
    std::string text;
    for (const TunedParam& param : params_) text += (text.empty() ? "" : ", ") + param.name;
    return text;
  }
  std::string list_values(const std::vector<double>& values) const {
    std::string text;
    for (std::size_t i = 0; i < params_.size(); ++i)
      text += (i == 0 ? "" : "  ") + params_[i].name + " " + number_text(values[i]);
    return text;
  }
  std::string describe_search() const {
    std::string text = "would search, by " + goal_.name + ", against " + measuring_->reference.files() + ":\n";
    for (const TunedParam& param : params_)
      text += row(param.name, {number_text(param.start), range_text(param) + (param.is_geometric ? ", by factors" : "")});
    return text;
  }

  const Arguments& arguments_;
  Console& console_;
  Registry passes_;
  Goal goal_;
  Job job_;
  std::vector<TunedParam> params_;
  int evaluations_ = 0, done_ = 0;
  SessionOptions session_;
  std::optional<MeasuringOptions> measuring_;
  FrameHalves halves_;
  std::optional<Trials> trials_;
  std::map<std::vector<double>, double> known_;
  std::vector<double> start_values_, best_;
  Figures start_, best_figures_, held_out_before_, held_out_after_;
  double least_ = 0;
};

ExitCode run(const Arguments& arguments, Console& console) {
  handle_interrupts();
  set_verbosity(arguments.verbosity.verbosity());
  pin_isa(arguments.isa);
  return Tuning(arguments, console).run();
}

}  // namespace

Command add_tune(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("tune", "Search parameters of a graph that bring its output nearest to a reference.");
  app.footer(
      "Example:\n"
      "  quell tune svgf shot/ --params alpha,sigma_l -o shot.json\n"
      "searches on the first half of the frames that have a reference, and reports on the other half, whether what was found "
      "holds "
      "there, too; then\n"
      "  quell run svgf shot/ -o denoised --params shot.json\n"
      "uses it. What is found is written whenever it is better than before, so that Ctrl-C loses nothing.\n"
      "\n"
      "Exit status: 0 all is well, 1 a frame failed, 2 usage or graph, 3 input, 4 plugin, 33 too little memory for a frame, 70 "
      "internal error, 75 interrupted.");
  auto arguments = std::make_shared<Arguments>();
  add_options(app, arguments->graph);
  app.remove_option(app.get_option("--params"));
  app.add_option("--params", arguments->params, "What to search: node.param, or a parameter of the graph, separated by commas.")
      ->type_name("PARAM,...")
      ->required()
      ->group(kGraphGroup);
  app.add_option("--start", arguments->graph.options.params,
                 "Begin with the parameters of a JSON file, as run takes them; repeatable.")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(kGraphGroup);
  add_repeatable(
      app, "--range", arguments->ranges, "PARAM=LOW..HIGH",
      "Where to search a parameter; repeatable. Otherwise from 0 to 1 where it is a share, else from a sixteenth of its "
      "value to sixteen times it.")
      ->group(kGraphGroup);
  add_options(app, arguments->sequence);
  add_text(app, "--reference", arguments->reference, "NAME",
           "What the output should look like: an input of the sequence, 'reference' by default, or files or a folder.")
      ->group(kMeasureGroup);
  add_text(
      app, "--metric", arguments->metric, "NAME",
      "What is to become best: psnr, ssim, mse, relmse, smape, flip or hdrflip, or mixed, the default: the geometric mean of "
      "mse, relmse and flip.")
      ->group(kMeasureGroup);
  add_text(app, "--display", arguments->display, "NAME", "How radiance becomes what is seen; see quell compare --help.")
      ->group(kMeasureGroup);
  app.add_option(
         "--held-out", arguments->held_out,
         "Frames that are not searched on, and tell whether what is found holds there, too; 'none' for none. By default the "
         "later half. Where the parameters act over time, hold out the first frames instead, whose history is short.")
      ->type_name("FRAMES")
      ->group(kMeasureGroup);
  add_text(app, "--evaluations", arguments->evaluations, "N",
           "Runs over the frames; 0, the default: 20, and 20 for each parameter.")
      ->group(kScheduleGroup);
  app.add_flag("--everywhere", arguments->everywhere,
               "Look over the whole ranges first, with half of the runs, instead of from the start alone.")
      ->disable_flag_override()
      ->group(kScheduleGroup);
  add_options(app, arguments->schedule);
  app.remove_option(app.get_option("--on-error"));  // a frame that fails cannot be measured
  add_options(app, arguments->isa);
  app.add_option("-o,--out", arguments->out, "Write what is found to a file; it is printed otherwise.")
      ->type_name("FILE")
      ->group(kOutputGroup);
  app.add_flag("-n,--dry-run", arguments->dry_run, "Say what would be searched, and do nothing.")
      ->disable_flag_override()
      ->group(kOutputGroup);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console& console) { return run(*arguments, console); }};
}

}  // namespace quell::app
