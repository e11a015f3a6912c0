#include "batch_check.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>

#include "checkpointed_run.h"
#include "graph_files.h"
#include "output_options.h"
#include "run_options.h"
#include "video_sink.h"

namespace quell::app {
namespace {

struct Parsed {
  GraphArguments graph;
  SequenceArguments sequence;
  OutputArguments output;
  ScheduleArguments schedule;
};

/// Of those options that a run shares with other commands, or that have parsers of their own.
Parsed parse(const Shot& shot) {
  Parsed parsed;
  CLI::App app;
  add_options(app, parsed.graph);
  add_options(app, parsed.sequence);
  add_options(app, parsed.output);
  add_options(app, parsed.schedule);
  std::vector<ShotOption> known = shot.options;
  std::erase_if(known, [&](const ShotOption& option) {
    return option.name != "graph" && option.name != "sequence" && !app.get_option_no_throw("--" + option.name);
  });
  std::vector<std::string> words = command_of(known);
  std::reverse(words.begin() + 1, words.end());  // as CLI11 takes them; the first is "run"
  words.erase(words.begin());
  app.parse(words);
  return parsed;
}

/// "frames" of what begins with "--frames: " or "--frames:1:3: "; "" for what is not about one option.
std::string option_of(const std::string& message) {
  return message.starts_with("--") ? message.substr(2, message.find_first_of(" :=", 2) - 2) : "";
}

}  // namespace

void BatchCheck::check(const Shot& shot) {
  const auto tell = [&](const std::string& option, const std::string& what) {
    const ShotOption* found = shot.find(option);
    errors_.error(found ? found->where : shot.where, what);
  };
  const auto attempt = [&](const std::function<void()>& parse_some) {
    try {
      parse_some();
    } catch (const Error& error) { tell(option_of(error.what()), error.what()); }
  };
  Parsed parsed;
  try {
    parsed = parse(shot);
  } catch (const CLI::ParseError& error) { return tell("", error.what()); }
  attempt([&] { parse_schedule(parsed.schedule); });
  attempt([&] { sequence_options(parsed.sequence); });
  attempt([&] {
    if (!is_video(parsed.output.folder)) parse_output(parsed.output);
  });
  if (const std::string wrong = wrong_in_graph(parsed.graph); !wrong.empty())
    tell(shot.find(option_of(wrong)) ? option_of(wrong) : "graph", wrong);
}

std::string BatchCheck::wrong_in_graph(const GraphArguments& arguments) {
  std::vector<std::string> key = {arguments.graph};
  for (const std::vector<std::string>& edits : {arguments.options.set, arguments.options.swap, arguments.options.bypass}) {
    key.insert(key.end(), edits.begin(), edits.end());
    key.emplace_back();  // ends the list
  }
  for (const auto& files : {arguments.options.params, arguments.plugins.plugin_path}) {
    key.insert(key.end(), files.begin(), files.end());
    key.emplace_back();
  }
  const auto [found, is_new] = graphs_.try_emplace(key);
  if (!is_new) return found->second;
  try {
    auto passes = passes_.find(arguments.plugins.plugin_path);
    if (passes == passes_.end()) passes = passes_.emplace(arguments.plugins.plugin_path, load_passes(arguments.plugins)).first;
    load_graph(find_graph(arguments.graph), passes->second, arguments.options);
  } catch (const Error& error) { found->second = error.what(); }
  return found->second;
}

}  // namespace quell::app
