#include "output_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "arguments.h"
#include "quell/graph/graph_hash.h"
#include "quell/text/diagnostic.h"

namespace quell::app {
namespace {

std::string size_text(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels"; }

/// The image that the results show: `color`, else the first color, else the first image, among the inputs that are read; -1 when
/// none is.
int find_picture(const Plan& plan) {
  const auto find = [&](const auto& is_it) {
    for (std::size_t i = 0; i < plan.graph->inputs.size(); ++i)
      if (plan.input_used[i] && plan.inputs[i].present && is_image(plan.inputs[i].type) && is_it(plan.graph->inputs[i]))
        return static_cast<int>(i);
    return -1;
  };
  int found = find([](const GraphInput& input) { return input.name == "color"; });
  if (found < 0) found = find([](const GraphInput& input) { return input.type == QUELL_TYPE_COLOR; });
  return found >= 0 ? found : find([](const GraphInput&) { return true; });
}

/// `window` is what is read of the picture.
Original find_original(const Sequence& sequence, const std::string& picture, const std::vector<std::string>& images,
                       const std::optional<Rectangle>& window, std::int64_t frame) {
  Original original{sequence.file(picture, frame), sequence.channels_read(picture, frame), {}, window};
  for (const std::string& image : images) {
    if (sequence.file(image, frame) != original.file) continue;
    const std::vector<std::string> read = sequence.channels_read(image, frame);
    original.read.insert(original.read.end(), read.begin(), read.end());
  }
  return original;
}

std::optional<Rectangle> find_window(Sequence& sequence) {
  const std::optional<PictureWindow> picture = sequence.picture_window();
  if (!picture || picture->data == picture->display) return std::nullopt;
  const auto& [display, data, aspect] = *picture;
  return Rectangle{data.x - display.x, data.y - display.y, data.width, data.height};
}

void require_one_size(const Plan& plan) {
  const PlannedResult* first = nullptr;
  const std::vector<PlannedResult> results = plan.results();
  for (const PlannedResult& result : results) {
    const Shape shape = plan.shape(result.from);
    if (!is_image(shape.type)) continue;
    if (!first) first = &result;
    const Size size = plan.shape(first->from).size;
    if (shape.size.width != size.width || shape.size.height != size.height)
      throw Error(Fault::usage, "--layers",
                  "the layers of a file have one size, but '" + first->name + "' has " + size_text(size) + " and '" +
                      result.name + "' " + size_text(shape.size) + "; leave --layers out");
  }
}

void require_room_for_channels(const Plan& plan, int picture, const std::vector<ResultImage>& images) {
  if (picture < 0)
    throw Error(Fault::usage, "--keep-channels", "the graph reads no image, so that there are no channels to keep");
  if (images.empty()) throw Error(Fault::usage, "--keep-channels", "the run writes no image that channels could be kept with");
  const Size size = plan.inputs[static_cast<std::size_t>(picture)].size;
  const auto is_color = [](const ResultImage& image) { return image.name == "color"; };
  const auto color = std::find_if(images.begin(), images.end(), is_color);
  const std::string main = color == images.end() ? images.front().name : color->name;
  for (const PlannedResult& result : plan.results()) {
    const Size other = plan.shape(result.from).size;
    if (result.name != main || (other.width == size.width && other.height == size.height)) continue;
    throw Error(Fault::usage, "--keep-channels",
                "the output '" + main + "' has " + size_text(other) + ", but the channels of the input '" +
                    plan.graph->inputs[static_cast<std::size_t>(picture)].name + "' have " + size_text(size) +
                    "; leave --keep-channels out");
  }
}

std::vector<std::string> image_inputs(const Plan& plan) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < plan.graph->inputs.size(); ++i)
    if (plan.input_used[i] && plan.inputs[i].present && is_image(plan.inputs[i].type))
      names.push_back(plan.graph->inputs[i].name);
  return names;
}

std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > kShown ? text + " and " + std::to_string(names.size() - kShown) + " more" : text;
}

}  // namespace

FileSinkOptions parse_output(const OutputArguments& arguments) {
  FileSinkOptions options;
  if (arguments.folder.empty()) throw Error(Fault::usage, "--out", "the name is empty; name a folder for the results");
  options.folder = arguments.folder;
  options.type = parse_pixel_type(arguments.type);
  options.compression = arguments.compression;
  if (!arguments.padding.empty()) options.padding = parse_count(arguments.padding, "--padding", 1, 20);
  if (!arguments.formats.empty()) options.formats.clear();
  for (const std::string& format : arguments.formats) {
    const FileFormat parsed = parse_file_format(format);
    if (std::find(options.formats.begin(), options.formats.end(), parsed) == options.formats.end())
      options.formats.push_back(parsed);
  }
  if (arguments.is_layered && arguments.layers.empty())
    throw Error(Fault::usage, "--layers", "the name is empty; write one such as 'beauty'");
  options.layers = arguments.layers;
  options.keep_channels = arguments.keep_channels;
  const FileSink checked(options);  // it knows the compressions, and which names can be
  return options;
}

void complete_output(FileSinkOptions& options, const OutputArguments& arguments, const Job& job, const std::string& inputs) {
  if (arguments.padding.empty()) options.padding = job.sequence->padding();
  options.attributes = {{"Software", std::string("quell ") + QUELL_VERSION},
                        {"quell:version", QUELL_VERSION},
                        {"quell:graph", job.graph->name},
                        {"quell:inputs", inputs}};
  const auto hash_of = [&](const std::map<std::string, Endpoint>& results) {
    return FileAttribute{"quell:graph_hash", graph_hash(*job.graph, results)};
  };
  std::map<std::string, Endpoint> all;
  for (const PlannedResult& result : job.plan.results()) {
    const PortType type = job.graph->type(result.from);
    if (!is_image(type)) continue;
    all[result.name] = result.from;
    options.images.push_back({result.name, type, {hash_of({{result.name, result.from}})}});
  }
  if (!options.layers.empty()) options.layered_attributes = {hash_of(all)};
  if (!options.layers.empty()) require_one_size(job.plan);
  const int picture = find_picture(job.plan);
  if (options.keep_channels) require_room_for_channels(job.plan, picture, options.images);
  if (picture < 0) return;
  options.original = [sequence = job.sequence.get(), window = find_window(*job.sequence),
                      name = job.graph->inputs[static_cast<std::size_t>(picture)].name,
                      images = options.keep_channels ? image_inputs(job.plan) : std::vector<std::string>(),
                      holds = job.holds](std::int64_t frame) {
    if (const auto held = holds.find({name, frame}); held != holds.end()) frame = held->second;
    return std::optional(find_original(*sequence, name, images, window, frame));
  };
}

std::map<std::string, std::string> label_results(const FileSinkOptions& options, const Job& job) {
  const auto list = [](const std::vector<FileAttribute>& attributes) {
    std::string text;
    for (const FileAttribute& attribute : attributes) text += attribute.name + " = " + attribute.text + "\n";
    return text;
  };
  std::string common = list(options.attributes) + list(options.layered_attributes) + std::to_string(options.padding) + "\n";
  const int picture = find_picture(job.plan);
  if (picture >= 0) common += "of " + job.graph->inputs[static_cast<std::size_t>(picture)].name + "\n";
  if (options.keep_channels)  // what is read is not kept, and one of the images is the main one
    for (const std::string& input : image_inputs(job.plan)) common += "but " + input + "\n";
  if (options.keep_channels || !options.layers.empty())
    for (const ResultImage& image : options.images) common += "with " + image.name + "\n";
  std::map<std::string, std::string> labels;
  for (const ResultImage& image : options.images) labels[image.name] = common + list(image.attributes);
  return labels;
}

void tell_kept_channels(const FileSink& sink, const Job& job) {
  const FileSink::KeptChannels channels = sink.kept_channels(job.frames.front());
  if (channels.kept.empty())
    spdlog::warn("--keep-channels: there is no channel that the graph does not read");
  else
    spdlog::info("kept as they are: {}", joined(channels.kept));
  if (!channels.left_out.empty())
    spdlog::warn("--keep-channels: not kept, because a result has the name: {}", joined(channels.left_out));
}

void add_options(CLI::App& app, OutputArguments& arguments) {
  app.add_option("-o,--out", arguments.folder, "The folder for the results; made when needed.")
      ->type_name("FOLDER")
      ->required()
      ->group(kOutputGroup);
  add_text(app, "--type", arguments.type, "TYPE",
           "Numbers in EXR files: half, float, or auto: half for color and albedo, float for all else.")
      ->group(kOutputGroup);
  add_text(app, "--compression", arguments.compression, "METHOD",
           "Of EXR files: none, rle, zips, zip (the default), piz, pxr24, b44, b44a, dwaa or dwab.")
      ->group(kOutputGroup);
  add_repeatable(app, "--format", arguments.formats, "FORMAT",
                 "exr (the default) or png (8 bit, sRGB, clamped); repeat it to write both.")
      ->group(kOutputGroup);
  add_text(app, "--padding", arguments.padding, "DIGITS",
           "Digits of the frame numbers in file names; as in the input, or 4 where that is not padded.")
      ->group(kOutputGroup);
  add_text(app, "--layers", arguments.layers, "NAME",
           "Write all images of a frame as layers of one EXR file, NAME.####.exr, instead of a file each.")
      ->each([&arguments](const std::string&) { arguments.is_layered = true; })
      ->group(kOutputGroup);
  app.add_flag("--keep-channels", arguments.keep_channels,
               "Carry alpha, and whatever other channels of the color's file the graph does not read, over to the file of the "
               "output color (else of the first output). They stay as they are: alpha is not filtered as color is, so that edges "
               "against an empty background may keep a seam. A PNG keeps alpha alone.")
      ->disable_flag_override()
      ->group(kOutputGroup);
}

}  // namespace quell::app
