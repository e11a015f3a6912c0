// How the program's command line is explained: help texts, and what is wrong with a command line.
#pragma once

#include <memory>
#include <string>

namespace CLI {
class App;
class FormatterBase;
class ParseError;
}  // namespace CLI

namespace quell::app {

/// Help texts for a terminal of 100 columns.
std::shared_ptr<CLI::FormatterBase> make_help_formatter();

/// "quell new pass"
std::string full_name(const CLI::App& app);

/// What is wrong, with a suggestion for a misspelt option or command, and where help is found.
std::string explain(const CLI::App& program, const CLI::ParseError& error);

}  // namespace quell::app
