// The part of `quell inspect` that tells what is in one image file.
#include <algorithm>
#include <cstdio>

#include "inspect_text.h"
#include "quell/sequence/checks/channel_statistics.h"
#include "quell/sequence/renderer_names.h"
#include "text_layout.h"

namespace quell::app {
namespace {

constexpr std::size_t kLongestAttribute = 160;

std::string text_of(Numbers numbers) {
  switch (numbers) {
    case Numbers::half:
      return "half";
    case Numbers::single:
      return "float";
    case Numbers::uint32:
      return "uint";
    case Numbers::uint16:
      return "16 bit";
    case Numbers::uint8:
      return "8 bit";
  }
  return "";
}

std::string text_of(const Rectangle& r) {
  const std::string size = std::to_string(r.width) + " x " + std::to_string(r.height);
  return r.x == 0 && r.y == 0 ? size : size + " at (" + std::to_string(r.x) + ", " + std::to_string(r.y) + ")";
}

std::string text_of(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", number);
  return text;
}

std::string count_text(std::size_t n, const std::string& noun) { return std::to_string(n) + " " + noun + (n == 1 ? "" : "s"); }

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string describe_head(const ImageFile& file) {
  int parts = 0;
  for (const FileChannel& channel : file.channels()) parts = std::max(parts, channel.part + 1);
  std::string text = file.path().string() + ": " + std::string(file.format()) + ", " + text_of(file.display_window()) + ", " +
                     count_text(file.channels().size(), "channel") +
                     (parts > 1 ? " in " + count_text(static_cast<std::size_t>(parts), "part") : "");
  if (file.pixel_aspect() != 1) text += ", pixels " + text_of(file.pixel_aspect()) + " times as wide as high";
  return text + "\n";
}

std::string describe_channel(const FileChannel& channel, const ChannelStatistics& statistics, std::size_t width) {
  std::string text =
      "    " + padded(std::string(channel_suffix(channel.name)), width) + "  " + padded(text_of(channel.numbers), 6) + "  ";
  if (statistics.finite > 0)
    text += text_of(statistics.min) + " to " + text_of(statistics.max) + ", mean " + text_of(statistics.mean);
  else
    text += "nothing finite";
  if (statistics.nan > 0) text += ", " + std::to_string(statistics.nan) + " NaN";
  if (statistics.infinite > 0) text += ", " + std::to_string(statistics.infinite) + " infinite";
  return text + "\n";
}

std::string describe_layers(const ImageFile& file, const std::vector<ChannelStatistics>& statistics) {
  std::string text;
  for (const Layer& layer : group_layers(file.channels())) {
    const auto channel_of = [&](int index) { return file.channels()[static_cast<std::size_t>(index)]; };
    std::size_t width = 1;
    for (const int index : layer.channels) width = std::max(width, channel_suffix(channel_of(index).name).size());
    text += "  " + (layer.name.empty() ? std::string("channels") : layer.name);
    const Rectangle& data = file.data_window(layer.channels.front());
    if (data != file.display_window()) text += ": pixels only in " + text_of(data);
    text += "\n";
    for (const int index : layer.channels)
      text += describe_channel(channel_of(index), statistics[static_cast<std::size_t>(index)], width);
  }
  return text;
}

std::string describe_attributes(const ImageFile& file) {
  std::string text;
  for (const ImageFile::Attribute& attribute : file.attributes()) {
    std::string value = attribute.text;
    std::replace(value.begin(), value.end(), '\n', ' ');
    if (value.size() > kLongestAttribute) value = value.substr(0, kLongestAttribute) + "...";
    text += entry(attribute.name, value, 2, 28);
  }
  for (const char* name : {"worldToCamera", "worldToNDC"})
    if (file.matrix(name)) text += entry(name, "a matrix: a camera, --in camera=PATTERN:format=header", 2, 28);
  return text.empty() ? "" : "header\n" + text;
}

std::string describe_selection(const ImageFile& file, const Selection& selection) {
  std::string text;
  for (const int index : selection.channels)
    text += (text.empty() ? "" : ",") + file.channels()[static_cast<std::size_t>(index)].name;
  if (!selection.renderer.empty()) text += " (" + selection.renderer + ")";
  const std::string conventions = quell::describe(selection.conventions);
  return text + (conventions.empty() ? "" : "; " + conventions);
}

/// Which layer would be read as which input.
std::string describe_inputs(const ImageFile& file) {
  std::string text;
  for (const std::string& input : usual_inputs()) {
    const auto found = recognize(file.channels(), input, port_type(input).value_or(QUELL_TYPE_COLOR));
    if (found.empty()) continue;
    if (found.size() == 1) {
      text += entry(input, describe_selection(file, found.front()), 2, 14);
      continue;
    }
    text += entry(input, "doubtful, has to be chosen with --in " + input + "=PATTERN:LAYER; one of", 2, 14);
    for (const Selection& selection : found) text += entry("", describe_selection(file, selection), 2, 16);
  }
  return text.empty() ? "recognized as: no input by the names of its layers\n" : "recognized as\n" + text;
}

}  // namespace

std::string describe_file(ImageFile& file, const std::function<void(double)>& progress) {
  const std::vector<ChannelStatistics> statistics = measure_channels(file, progress);
  return describe_head(file) + describe_layers(file, statistics) + describe_attributes(file) + describe_inputs(file);
}

}  // namespace quell::app
