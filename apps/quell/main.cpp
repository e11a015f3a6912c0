// quell, the runner: reads the command line, runs one subcommand, and turns whatever goes wrong into a message and an exit code.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <new>
#include <vector>

#include "arguments.h"
#include "command_line.h"
#include "commands.h"
#include "machine.h"
#include "memory_promise.h"

namespace quell::app {
namespace {

void describe_program(CLI::App& program) {
  program.description("quell denoises path-traced image sequences: a graph of passes, written in JSON, runs over the frames.");
  program.footer(
      "Example:\n"
      "  quell run games202 shot/ -o denoised\n"
      "\n"
      "`quell COMMAND --help` tells all about a command.");
  program.formatter(make_help_formatter());
  program.require_subcommand(0, 1);
  program.set_version_flag("--version", version_text(), "Print the version.");
  program.set_help_flag("-h,--help", "Print this help.");
  for (const char* flag : {"--version", "--help"}) program.get_option(flag)->group(kOtherGroup);
}

ExitCode run_program(int argc, char** argv, Console& console) {
  CLI::App program("", "quell");
  describe_program(program);
  const std::vector<Command> commands = {add_run(program),     add_batch(program), add_check(program),  add_inspect(program),
                                         add_compare(program), add_graph(program), add_passes(program), add_plan(program),
                                         add_schema(program),  add_tune(program),  add_report(program), add_new(program)};
  for (const Command& command : commands) command.options->get_option("--help")->group(kOtherGroup);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    program.exit(help);
    return kOk;
  } catch (const CLI::ParseError& error) {
    spdlog::error(explain(program, error));
    return kUsage;
  }
  for (const Command& command : commands)
    if (command.options->parsed()) return command.run(console);
  std::cout << program.help();
  return kOk;
}

/// A full disk must not look like success.
ExitCode finish_output(ExitCode code) {
  std::cout.flush();
  if (std::cout) return code;
  spdlog::error("the output cannot be written: {}", std::strerror(errno));
  return code == kOk ? kInternal : code;
}

ExitCode guarded_main(int argc, char** argv) {
  const std::shared_ptr<Console> console = open_console();
  try {
    return finish_output(run_program(argc, argv, *console));
  } catch (const Error& error) {
    spdlog::error(error.what());
    return exit_code(error.fault());
  } catch (const std::bad_alloc&) {
    spdlog::error("memory ran out");
    return kInternal;
  } catch (const std::exception& error) {
    spdlog::error("internal error: {}", error.what());
    return kInternal;
  }
}

}  // namespace
}  // namespace quell::app

int main(int argc, char** argv) {
  quell::app::steady_allocation();
  try {
    return quell::app::guarded_main(argc, argv);
  } catch (...) { return quell::app::kInternal; }
}
