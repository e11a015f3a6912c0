// How a run goes through nodes and frames, as the command line says it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "quell/runtime/session.h"

namespace CLI {
class App;
}

namespace quell::app {

struct ScheduleArguments {
  std::string threads = "0";
  std::string frames_in_flight = "auto";
  std::string memory = "auto";
  std::string executor = "tbb";
  std::string on_error = "continue";
  std::string cut = "";
};

void add_options(CLI::App& app, ScheduleArguments& arguments);

/// The session's options that these arguments state. Throws Error(usage) naming the option.
SessionOptions parse_schedule(const ScheduleArguments& arguments);

/// As --on-error has it.
std::string_view name_of(OnError on_error);

/// Bytes: "1000000", "512M", "1.5G" (powers of 1024); 0 for "auto". Throws Error(usage) naming --memory.
std::size_t parse_memory(const std::string& text);

/// Tells of cuts that separate nothing: none of the frames lies before it, or none from it on, or the plan keeps no frames.
void warn_of_idle_cuts(const std::vector<std::int64_t>& cuts, const std::vector<std::int64_t>& frames, const Plan& plan);

}  // namespace quell::app
