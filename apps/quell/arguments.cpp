#include "arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <limits>
#include <sstream>

#include "quell/text/diagnostic.h"

namespace quell::app {

CLI::Option* add_repeatable(CLI::App& app, const char* name, std::vector<std::string>& values, const char* value_name,
                            const char* help) {
  return app.add_option(name, values, help)->type_name(value_name)->allow_extra_args(false);
}

CLI::Option* add_text(CLI::App& app, const char* name, std::string& value, const char* value_name, const char* help) {
  return app.add_option(name, value, help)->type_name(value_name);
}

void add_options(CLI::App& app, VerbosityArguments& arguments) {
  app.add_flag("-q,--quiet", arguments.quiet, "Say nothing but warnings and errors.")
      ->disable_flag_override()
      ->group(kOtherGroup);
  app.add_flag("-v,--verbose", arguments.verbose, "Say more: what passes tell for debugging, and how frames overlap.")
      ->disable_flag_override()
      ->group(kOtherGroup);
}

void add_options(CLI::App& app, PluginArguments& arguments) {
  app.add_option("--plugin-path", arguments.plugin_path,
                 "A folder of plugins, or one plugin; repeatable. Looked at before QUELL_PLUGIN_PATH and the built-in passes.")
      ->type_name("PATH")
      ->allow_extra_args(false)
      ->group(kGraphGroup);
}

void add_options(CLI::App& app, GraphArguments& arguments) {
  app.add_option("GRAPH", arguments.graph, "A graph file, or the bare name of a graph that ships with quell (games202).")
      ->required();
  add_repeatable(app, "--set", arguments.options.set, "NODE.PARAM=VALUE",
                 "Set a parameter of a node, or of the graph (PARAM=VALUE); repeatable.")
      ->group(kGraphGroup);
  app.add_option("--params", arguments.options.params,
                 "Read parameters from a JSON file: {\"node.param\": value}; repeatable, and --set wins.")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(kGraphGroup);
  add_repeatable(app, "--swap", arguments.options.swap, "NODE=PASS",
                 "Let a node run another pass, with the sources and parameters that it has, too; repeatable.")
      ->group(kGraphGroup);
  add_repeatable(app, "--bypass", arguments.options.bypass, "NODE",
                 "Let whoever reads a node read what it reads, of the same type, instead; repeatable.")
      ->group(kGraphGroup);
  add_options(app, arguments.plugins);
}

void add_options(CLI::App& app, SequenceArguments& arguments) {
  app.add_option("SEQUENCE", arguments.sequence,
                 "A folder of images, which is recognized by its file names, a sequence.json, or files that hold every input in "
                 "layers (multi.####.exr; one file is one frame). May be left out when --in names every input.");
  add_repeatable(
      app, "--in", arguments.in, "INPUT=PATTERN",
      "The files of one input, such as color=shot/beauty_%d.exr or depth=z.####.exr; repeatable. After colons a layer or "
      "settings may follow: normal=multi.####.exr:ViewLayer.Normal, id=ID_%d.exr:background=-1. Settings are the conventions "
      "sign, unit, y, jitter, depth, space, encoding, background, alpha and transfer; vectors, ndc, y and w of a camera in a "
      "header; and type, channels and format. The message about a wrong value tells the right ones.")
      ->group(kInputGroup);
  app.add_option("--frames", arguments.frames,
                 "Frames to compute: 1-100, 1-100x2 (every second), 1,5,9-12. Without it, those of the sequence.json, or all for "
                 "which every input exists.")
      ->type_name("RANGE")
      ->group(kInputGroup);
  app.add_option("--crop", arguments.crop,
                 "For trials: read only this part of the images, in pixels from their upper left corner. Cameras are fitted.")
      ->type_name("X,Y,WIDTH,HEIGHT")
      ->group(kInputGroup);
  app.add_option("--window", arguments.window,
                 "Read the 'display' window (the default), or the 'data' window of color in the first frame, which may reach "
                 "beyond it (overscan).")
      ->type_name("display|data")
      ->group(kInputGroup);
}

namespace {

Rectangle parse_crop(const std::string& text) {
  int numbers[4];
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < 4; ++i) {
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    const bool ends_well = i == 3 ? next == end : next != end && *next == ',';
    if (error != std::errc() || !ends_well || numbers[i] < (i < 2 ? 0 : 1))
      throw Error(Fault::usage, "--crop",
                  "'" + text + "' is not X,Y,WIDTH,HEIGHT in pixels from the upper left corner, such as 100,50,320,180");
    at = next + 1;
  }
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

}  // namespace

SequenceOptions sequence_options(const SequenceArguments& arguments) {
  SequenceOptions options;
  options.in = arguments.in;
  if (arguments.frames) options.frames = FrameRange::parse(*arguments.frames);
  if (arguments.window && parse_choice(*arguments.window, "--window", {"display", "data"}) == 1)
    options.window = WindowChoice::data;
  if (arguments.crop) options.crop = parse_crop(*arguments.crop);
  return options;
}

int parse_count(const std::string& text, const char* option, int smallest, int largest, const char* or_else) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < smallest || value > largest)
    throw Error(
        Fault::usage, option,
        "'" + text + "' is not a whole number from " + std::to_string(smallest) + " to " + std::to_string(largest) + or_else);
  return value;
}

double parse_number(const std::string& text, const char* option, double smallest, double largest) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= smallest && value <= largest) return value;
  if (largest == std::numeric_limits<double>::max()) throw Error(Fault::usage, option, "'" + text + "' is not a number");
  std::ostringstream range;
  range << smallest << " to " << largest;
  throw Error(Fault::usage, option, "'" + text + "' is not a number from " + range.str());
}

std::size_t parse_choice(const std::string& text, const char* option, const std::vector<std::string>& choices) {
  const auto choice = std::find(choices.begin(), choices.end(), text);
  if (choice == choices.end())
    throw Error(Fault::usage, option,
                "'" + text + "' is not possible" + did_you_mean(text, choices) + "; choose " + list_names(choices));
  return static_cast<std::size_t>(choice - choices.begin());
}

}  // namespace quell::app
