#include "command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "quell/text/diagnostic.h"

namespace quell::app {
namespace {

/// "--out" of "--out=folder".
std::string option_name(const std::string& argument) { return argument.substr(0, argument.find('=')); }

/// The dashes are left out of the comparison: they are always alike.
std::string suggest_option(const CLI::App& app, const std::string& argument) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  std::vector<std::string> close = nearest(argument.substr(std::min(argument.find_first_not_of('-'), argument.size())), names);
  for (std::string& name : close) name = "--" + name;
  return close.empty() ? "" : "; did you mean " + list_names(close) + "?";
}

std::string explain_extra(const CLI::App& app, const std::string& argument) {
  if (argument.starts_with('-')) {
    const std::string name = option_name(argument);
    return "there is no option '" + name + "'" + suggest_option(app, name);
  }
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  if (commands.empty()) return "'" + argument + "' is one argument too many";
  return "there is no command '" + argument + "'" + did_you_mean(argument, commands) + "; the commands are " +
         list_names(commands, "and");
}

/// What is wrong with an option's value. CLI11's message names the option, at its start without dashes.
std::string explain_mismatch(const CLI::App& app, const std::string& message) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name(false, false);
    const std::string bare = name.substr(std::min(name.find_first_not_of('-'), name.size()));
    if (bare.empty() || (message.find(name) == std::string::npos && !message.starts_with(bare + " "))) continue;
    if (option->count() > 1) return name + " may be given only once";
    if (option->get_expected_max() == 0 || option->get_type_size() == 0) return name + " takes no value";
    return name + " needs a value: " + name + " " + option->get_type_name();
  }
  return message;
}

std::string explain_missing(const CLI::App& app, const std::string& message) {
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_required() || option->count() > 0) continue;
    const std::string name = option->get_positional() ? option->get_name(true) : option->get_name(false, false);
    const std::string value = option->get_positional() ? "" : " " + option->get_type_name();
    return name + value + " is missing";
  }
  return message;
}

/// What is left over, options first: a misspelt option makes everything behind it look wrong.
std::string first_extra(const CLI::App& app) {
  const std::vector<std::string> rest = app.remaining();
  const auto option = std::find_if(rest.begin(), rest.end(), [](const std::string& text) { return text.starts_with('-'); });
  if (option != rest.end()) return *option;
  return rest.empty() ? "" : rest.front();
}

/// The command that was given last: `pass` of `quell new pass`.
const CLI::App& innermost(const CLI::App& app) {
  const std::vector<const CLI::App*> chosen = app.get_subcommands([](const CLI::App* command) { return command->parsed(); });
  return chosen.empty() ? app : innermost(*chosen.front());
}

}  // namespace

std::string full_name(const CLI::App& app) {
  return app.get_parent() ? full_name(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

std::string explain(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& app = innermost(program);
  const std::string extra = first_extra(app);
  const auto is = [&](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
  std::string text = error.what();
  if (extra.starts_with('-') || (is(CLI::ExitCodes::ExtrasError) && !extra.empty()))
    text = explain_extra(app, extra);
  else if (is(CLI::ExitCodes::RequiredError))
    text = explain_missing(app, text);
  else if (is(CLI::ExitCodes::ArgumentMismatch) || is(CLI::ExitCodes::ConversionError))
    text = explain_mismatch(app, text);
  return text + "\n`" + full_name(app) + " --help` tells more";
}

}  // namespace quell::app
