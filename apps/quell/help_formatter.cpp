#include <CLI/CLI.hpp>

#include "arguments.h"
#include "command_line.h"
#include "text_layout.h"

namespace quell::app {
namespace {

constexpr std::size_t kColumn = 28;

class HelpFormatter final : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
    std::string text = wrap(app->get_description());
    text += "\nUsage: " + usage(*app, name) + "\n";
    text += positionals(*app) + commands(*app);
    for (const char* group : {kInputGroup, kMeasureGroup, kOutputGroup, kGraphGroup, kScheduleGroup, kOtherGroup})
      text += options(*app, group);
    if (!app->get_footer().empty()) text += "\n" + wrap_footer(app->get_footer());
    return text;
  }

 private:
  static std::vector<const CLI::Option*> positional_options(const CLI::App& app) {
    return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
  }

  static std::string usage(const CLI::App& app, const std::string& name) {
    std::string text = app.get_parent() || name.empty() ? full_name(app) : name;
    for (const CLI::Option* option : positional_options(app))
      text += option->get_required() ? " " + option->get_name(true) : " [" + option->get_name(true) + "]";
    for (const CLI::Option* option : app.get_options())
      if (option->nonpositional() && option->get_required()) text += " " + short_label(*option);
    if (!app.get_subcommands({}).empty()) return text + " COMMAND ...";
    return text + " [OPTIONS]";
  }

  /// "-o FOLDER"
  static std::string short_label(const CLI::Option& option) {
    const auto& names = option.get_snames();
    return (names.empty() ? option.get_name() : "-" + names.front()) + " " + option.get_type_name();
  }

  /// "-o,--out FOLDER"
  static std::string label(const CLI::Option& option) {
    const bool takes_value = option.get_type_size() != 0;
    return option.get_name(false, true) + (takes_value ? " " + option.get_type_name() : "");
  }

  static std::string positionals(const CLI::App& app) {
    std::string text;
    for (const CLI::Option* option : positional_options(app))
      text += entry(option->get_name(true), option->get_description(), 2, kColumn);
    return text.empty() ? text : "\n" + text;
  }

  static std::string commands(const CLI::App& app) {
    std::string text;
    for (const CLI::App* command : app.get_subcommands({})) text += entry(command->get_name(), command->get_description(), 2, 12);
    return text.empty() ? text : "\nCommands:\n" + text;
  }

  static std::string options(const CLI::App& app, const std::string& group) {
    std::string text;
    for (const CLI::Option* option : app.get_options())
      if (option->nonpositional() && option->get_group() == group)
        text += entry(label(*option), option->get_description(), 2, kColumn);
    return text.empty() ? text : "\n" + group + ":\n" + text;
  }

  /// Lines that start with spaces, such as example commands, stay as they are.
  static std::string wrap_footer(const std::string& footer) {
    std::string text;
    std::istringstream lines(footer);
    for (std::string line; std::getline(lines, line);) text += line.starts_with(' ') || line.empty() ? line + "\n" : wrap(line);
    return text;
  }
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> make_help_formatter() { return std::make_shared<HelpFormatter>(); }

}  // namespace quell::app
