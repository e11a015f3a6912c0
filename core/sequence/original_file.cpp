#include "quell/sequence/original_file.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "quell/sequence/image_file_state.h"
#include "quell/text/error.h"

namespace quell {
namespace {

/// What an attribute says that the results have otherwise, or that is about the file instead of the picture.
bool is_about_the_file(std::string_view name) {
  static const std::set<std::string_view> kNames = {
      "compression",    "planarconfig",     "name",          "type",      "version",    "chunkCount",          "multiView",
      "Orientation",    "PixelAspectRatio", "textureformat", "wrapmodes", "ICCProfile", "BlenderMultiChannel", "Software",
      "Exif:ColorSpace"};
  static constexpr std::array<std::string_view, 8> kPrefixes = {
      "oiio:", "openexr:", "png:", "tiff:", "pnm:", "hdr:", "ICCProfile:", "quell:"};
  return kNames.contains(name) ||
         std::any_of(kPrefixes.begin(), kPrefixes.end(), [&](std::string_view prefix) { return name.starts_with(prefix); });
}

/// Cryptomatte's tables tell which ids certain channels hold.
bool is_about_channels(std::string_view name) { return name.starts_with("cryptomatte/"); }

}  // namespace

Placement place_alone(Size size) {
  const Rectangle whole{0, 0, size.width, size.height};
  return {whole, whole, whole, 1};
}

OriginalFile::OriginalFile(const Original& original) : original_(original), file_(original.file) {
  const auto& channels = file_.channels();
  const auto is_color = [&](const FileChannel& channel) {
    return !original.color.empty() && channel.name == original.color.front();
  };
  const auto found = std::find_if(channels.begin(), channels.end(), is_color);
  if (found != channels.end()) color_ = static_cast<int>(found - channels.begin());
}

/// What the images show, in the file's coordinates.
Rectangle OriginalFile::window() const {
  const Rectangle& display = file_.display_window();
  if (!original_.window) return display;
  return {display.x + original_.window->x, display.y + original_.window->y, original_.window->width, original_.window->height};
}

Size OriginalFile::picture_size() const { return {window().width, window().height}; }

Placement OriginalFile::place(Size size) const {
  Placement placement = place_alone(size);
  placement.pixel_aspect = file_.pixel_aspect();
  if (window().width != size.width || window().height != size.height) return placement;
  const Rectangle covered = intersection(window(), file_.data_window(color_));
  placement.display = file_.display_window();
  placement.image = window();
  placement.data = covered.empty() ? window() : covered;
  return placement;
}

void OriginalFile::add_attributes(OIIO::ImageSpec& spec, bool channels) const {
  const ImageFile::State& state = file_.state();
  for (const OIIO::ParamValue& value : state.part_of(color_).spec.extra_attribs) {
    const std::string name = value.name().string();
    if (is_about_the_file(name) || (!channels && is_about_channels(name))) continue;
    spec.extra_attribs.add_or_replace(value);
  }
}

bool OriginalFile::is_read(const std::string& channel) const {
  return std::find(original_.read.begin(), original_.read.end(), channel) != original_.read.end();
}

/// "ViewLayer.Combined." of "ViewLayer.Combined.R"; "" of "R".
std::string OriginalFile::layer() const {
  const std::string& name = file_.channels()[static_cast<std::size_t>(color_)].name;
  return name.substr(0, name.rfind('.') + 1);
}

std::vector<KeptChannel> OriginalFile::choose(const std::vector<std::string>& taken, std::vector<std::string>* left_out) const {
  std::set<std::string> names(taken.begin(), taken.end());
  std::vector<KeptChannel> kept;
  const std::string own = layer();
  const auto add = [&](std::size_t i, const std::string& name) {
    const FileChannel& channel = file_.channels()[i];
    if (is_read(channel.name)) return;
    if (names.insert(name).second)
      kept.push_back({name, static_cast<int>(i), channel.numbers == Numbers::half, channel.numbers == Numbers::uint32});
    else if (left_out)
      left_out->push_back(channel.name);
  };
  // The picture's own layer first: its "A" is the picture's alpha, not one that stands beside the layers.
  for (const bool of_own : {true, false})
    for (std::size_t i = 0; i < file_.channels().size(); ++i) {
      const std::string& name = file_.channels()[i].name;
      if (name.starts_with(own) == of_own) add(i, of_own ? name.substr(own.size()) : name);
    }
  return kept;
}

std::optional<int> OriginalFile::alpha() const {
  for (const KeptChannel& channel : choose({}))
    if (channel.name == "A" && !channel.uint) return channel.channel;
  return std::nullopt;
}

}  // namespace quell
