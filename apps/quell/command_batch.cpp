// quell batch: many shots, side by side.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <sstream>

#include "arguments.h"
#include "batch_run.h"
#include "commands.h"
#include "quell/runtime/executor.h"
#include "quell/runtime/window.h"
#include "quell/text/shell_word.h"
#include "results.h"
#include "run_options.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

struct Arguments {
  fs::path list;
  std::optional<fs::path> logs;
  std::string threads = "0", memory = "auto";
  std::optional<std::string> jobs;
  bool quiet = false, keep_going = false, stop_on_error = false, resume = false, dry_run = false;
};

constexpr int kMostThreads = 1024;  // as for quell run

/// Runs begin in the list's folder, where the plugins are still to be found.
void enter_folder_of(const fs::path& list) {
  if (const char* variable = std::getenv("QUELL_PLUGIN_PATH")) {
    std::istringstream paths(variable);
    std::string absolute;
    for (std::string path; std::getline(paths, path, ':');)
      absolute += (absolute.empty() ? "" : ":") + (path.empty() ? path : fs::absolute(path).string());
    setenv("QUELL_PLUGIN_PATH", absolute.c_str(), 1);
  }
  if (list.has_parent_path()) fs::current_path(list.parent_path());
}

/// "shots.logs" beside "shots.json", unless stated.
fs::path logs_folder(const Arguments& arguments) {
  if (arguments.logs && arguments.logs->empty()) throw Error(Fault::usage, "--logs", "the name is empty; name a folder");
  fs::path folder = arguments.list;
  return fs::absolute(arguments.logs ? *arguments.logs : folder.replace_extension(".logs")).lexically_normal();
}

BatchBudget choose_budget(const Arguments& arguments, std::size_t shots) {
  BatchBudget budget;
  budget.threads = parse_count(arguments.threads, "--threads", 0, kMostThreads);
  if (budget.threads == 0) budget.threads = available_threads();
  budget.memory = parse_memory(arguments.memory);
  if (budget.memory == 0) budget.memory = available_memory() / 2;
  const int jobs = arguments.jobs ? parse_count(*arguments.jobs, "--jobs", 1, kMostThreads) : 0;
  budget.jobs = choose_jobs(jobs, shots, budget.threads, budget.memory);
  return budget;
}

/// With the shares that shots have while as many run as may.
void print_commands(const std::vector<Shot>& shots, const BatchOptions& options) {
  std::cout << "cd " << shell_word(fs::current_path().string()) << "\n";
  const BatchBudget& budget = options.budget;
  for (const Shot& shot : shots) {
    const ShotFiles files(options.logs, shot.name);
    std::cout << (options.resume && done_before(shot, files) ? "# done before: quell" : "quell");
    for (const std::string& word :
         run_words(shot, files, budget.threads / budget.jobs, budget.memory / static_cast<std::size_t>(budget.jobs)))
      std::cout << ' ' << shell_word(word);
    std::cout << " > " << shell_word(files.log.string()) << " 2>&1\n";
  }
}

ExitCode sum_up(const std::vector<ShotResult>& results) {
  const auto any = [&](ExitCode code) { return std::ranges::find(results, code, &ShotResult::code) != results.end(); };
  if (any(kInterrupted)) return kInterrupted;
  return any(kFramesFailed) ? kFramesFailed : kOk;
}

ExitCode run(const Arguments& arguments, Console& console) {
  set_verbosity(arguments.quiet ? Verbosity::quiet : Verbosity::normal);
  if (arguments.keep_going && arguments.stop_on_error)
    throw Error(Fault::usage, "--keep-going", "it does not go with --stop-on-error; leave one of them out");
  BatchOptions options{.logs = logs_folder(arguments), .stop_on_error = arguments.stop_on_error, .resume = arguments.resume};
  const SourceTextPtr list = read_text(arguments.list, Fault::usage);
  enter_folder_of(arguments.list);
  const std::vector<Shot> shots = read_batch(list);
  options.budget = choose_budget(arguments, shots.size());
  for (const Shot& shot : shots) ShotFiles(options.logs, shot.name).refuse_to_replace_others();
  if (arguments.dry_run) {
    print_commands(shots, options);
    return kOk;
  }
  prepare_folder(options.logs, "--logs");
  const std::vector<ShotResult> results = run_batch(shots, options, console);
  std::cout << describe(shots, results);
  return sum_up(results);
}

void add_flag(CLI::App& app, const char* name, bool& value, const char* group, const char* help) {
  app.add_flag(name, value, help)->disable_flag_override()->group(group);
}

}  // namespace

Command add_batch(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("batch", "Run many shots, side by side, within one budget.");
  app.footer(
      "Example:\n"
      "  quell batch shots.json\n"
      "where shots.json holds what quell run takes, for each shot, and relative names are taken from its folder:\n"
      "  { \"quell_batch\": 1,\n"
      "    \"defaults\": { \"graph\": \"svgf\", \"sequence\": \"{shot}\", \"out\": \"denoised/{shot}\" },\n"
      "    \"shots\": { \"sh010\": {}, \"sh020\": { \"frames\": \"1-100\", \"set\": [\"alpha=0.1\"] } } }\n"
      "\n"
      "Exit status: 0 all shots are done, 1 some failed, 2 usage: all that is wrong with the list is told, 75 interrupted.");
  auto arguments = std::make_shared<Arguments>();
  app.add_option("LIST", arguments->list, "The list of shots, a JSON file.")->required();
  app.add_option(
         "--logs", arguments->logs,
         "Where to keep what each shot says (NAME.log, NAME.jsonl) and its report (NAME.json); beside the list otherwise.")
      ->type_name("FOLDER")
      ->group(kOutputGroup);
  add_text(app, "--threads", arguments->threads, "N",
           "Threads of all shots together; 0, the default, for as many as there are processors.")
      ->group(kScheduleGroup);
  add_text(app, "--memory", arguments->memory, "SIZE",
           "Memory for images of all shots together: bytes, or with K, M, G or T; auto, the default, for half of what there is.")
      ->group(kScheduleGroup);
  app.add_option("--jobs", arguments->jobs,
                 "Most shots at a time; by default as many as have four threads and 2 GiB each, and at least one.")
      ->type_name("N")
      ->group(kScheduleGroup);
  add_flag(app, "--resume", arguments->resume, kScheduleGroup,
           "Leave out shots that the same command has done, by their reports, and whose files are there.");
  add_flag(app, "--keep-going", arguments->keep_going, kScheduleGroup, "When a shot fails, go on with the others: the default.");
  add_flag(app, "--stop-on-error", arguments->stop_on_error, kScheduleGroup,
           "When a shot fails, begin no other; those that run are finished.");
  add_flag(app, "-n,--dry-run", arguments->dry_run, kOtherGroup, "Check the list, print the commands, and stop there.");
  add_flag(app, "-q,--quiet", arguments->quiet, kOtherGroup, "Say nothing but warnings, errors and the table.");
  return {&app, [arguments](Console& console) { return run(*arguments, console); }};
}

}  // namespace quell::app
