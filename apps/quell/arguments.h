// Options that several subcommands share, and what is made of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "gaps.h"
#include "quell/graph/graph.h"
#include "quell/sequence/sequence.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace quell::app {

struct VerbosityArguments {
  bool quiet = false;
  bool verbose = false;
  Verbosity verbosity() const { return quiet ? Verbosity::quiet : verbose ? Verbosity::verbose : Verbosity::normal; }
};

struct PluginArguments {
  std::vector<std::filesystem::path> plugin_path;
};

struct GraphArguments {
  std::string graph;  ///< a path, or the bare name of a graph that ships
  GraphOptions options;
  PluginArguments plugins;
};

struct SequenceArguments {
  std::filesystem::path sequence;  ///< empty when not given
  std::vector<std::string> in;
  std::optional<std::string> frames, window, crop;
  OnMissing on_missing = OnMissing::usual;

  bool given() const { return !sequence.empty() || !in.empty(); }
};

/// The headings of help texts, in this order.
inline constexpr const char* kInputGroup = "What to read";
inline constexpr const char* kOutputGroup = "What to write";
inline constexpr const char* kGraphGroup = "The graph";
inline constexpr const char* kMeasureGroup = "What to measure";
inline constexpr const char* kScheduleGroup = "How to run";
inline constexpr const char* kOtherGroup = "Other options";

void add_options(CLI::App& app, VerbosityArguments& arguments);
void add_options(CLI::App& app, PluginArguments& arguments);
void add_options(CLI::App& app, GraphArguments& arguments);
void add_options(CLI::App& app, SequenceArguments& arguments);
/// An option that may be given several times, each time with one value.
CLI::Option* add_repeatable(CLI::App& app, const char* name, std::vector<std::string>& values, const char* value_name,
                            const char* help);
/// An option with one value.
CLI::Option* add_text(CLI::App& app, const char* name, std::string& value, const char* value_name, const char* help);

/// What the options say to Sequence::open() (the inputs that are wanted excepted). Throws Error(usage) naming the option.
SequenceOptions sequence_options(const SequenceArguments& arguments);

/// A whole number of at least `smallest`. Throws Error(usage) naming the option; `or_else` ends the message.
int parse_count(const std::string& text, const char* option, int smallest, int largest, const char* or_else = "");
/// A number from `smallest` to `largest`. Throws Error(usage) naming the option.
double parse_number(const std::string& text, const char* option, double smallest, double largest);
/// The place of `text` among the choices. Throws Error(usage) naming the option.
std::size_t parse_choice(const std::string& text, const char* option, const std::vector<std::string>& choices);

}  // namespace quell::app
