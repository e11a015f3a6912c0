#include "quell/sequence/file_sink.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <set>

#include "quell/sequence/file_pattern.h"
#include "quell/sequence/image_writer.h"
#include "quell/sequence/pending_file.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_choice(const std::string& option, std::string_view text, const std::vector<std::string>& choices) {
  throw Error(Fault::usage, option,
              "'" + std::string(text) + "' is not possible" + did_you_mean(text, choices) + "; choose " + list_names(choices));
}

void require_layers(const FileSinkOptions& options) {
  if (options.layers.front() == '.' || options.layers.find('/') != std::string::npos)
    throw Error(Fault::usage, "--layers", "'" + options.layers + "' cannot be the name of files; write one such as 'beauty'");
  if (std::find(options.formats.begin(), options.formats.end(), FileFormat::exr) == options.formats.end())
    throw Error(Fault::usage, "--layers", "only EXR files have layers; add --format exr");
}

}  // namespace

PixelType parse_pixel_type(std::string_view text) {
  if (text == "auto") return PixelType::automatic;
  if (text == "half") return PixelType::half;
  if (text == "float") return PixelType::single;
  fail_choice("--type", text, {"auto", "half", "float"});
}

FileFormat parse_file_format(std::string_view text) {
  if (text == "exr") return FileFormat::exr;
  if (text == "png") return FileFormat::png;
  fail_choice("--format", text, {"exr", "png"});
}

const std::vector<std::string>& exr_compressions() {
  static const std::vector<std::string> names = {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"};
  return names;
}

struct FileSink::State {
  FileSinkOptions options;
  mutable std::mutex mutex;  // guards what follows
  std::set<fs::path> written;
  std::uint64_t clamped = 0;
  std::map<std::int64_t, std::map<std::string, Image>> pending;  // layers of frames that are not complete, by frame and output

  fs::path path(std::string_view output, std::int64_t frame, const char* extension) const {
    return options.folder / (std::string(output) + "." + padded(frame, options.padding) + extension);
  }

  /// The chosen formats that can hold a type.
  std::vector<FileFormat> formats(PortType type) const {
    std::vector<FileFormat> formats;
    for (const FileFormat format : options.formats)
      if (format == FileFormat::exr || png_can_hold(type)) formats.push_back(format);
    return formats;
  }

  /// `color`, else the first image; "" when none is known.
  std::string main_image() const {
    const auto is_color = [](const ResultImage& image) { return image.name == "color"; };
    if (options.images.empty() || std::any_of(options.images.begin(), options.images.end(), is_color)) return "color";
    return options.images.front().name;
  }

  WrittenLayer layer(const std::string& output, const Image& image) const {
    const PortType type = image.type();
    const bool half = options.type == PixelType::half ||
                      (options.type == PixelType::automatic && (type == QUELL_TYPE_COLOR || type == QUELL_TYPE_ALBEDO));
    return {image, options.layers.empty() || output == main_image() ? "" : output, half};
  }

  void write(const std::string& output, std::int64_t frame, const Item& item, const fs::path& file) {
    if (!item.image())
      return write(file, [&](const fs::path& temporary) {
        write_text(to_json(item, frame), temporary);
        return 0;
      });
    const bool is_main = output == main_image();
    if (options.layers.empty() || file.extension() != ".exr")
      return write({layer(output, *item.image())}, frame, is_main, attributes(output), file);
    if (std::vector<WrittenLayer> layers = collect(output, frame, *item.image()); !layers.empty())
      write(std::move(layers), frame, true, options.layered_attributes, file);
  }

  std::vector<FileAttribute> attributes(const std::string& output) const {
    for (const ResultImage& image : options.images)
      if (image.name == output) return image.attributes;
    return {};
  }

  /// Every layer of the frame, in order, when this image is the last of them; nothing before.
  std::vector<WrittenLayer> collect(const std::string& output, std::int64_t frame, const Image& image) {
    if (std::none_of(options.images.begin(), options.images.end(), [&](const auto& known) { return known.name == output; }))
      throw Error(Fault::frame, output, "this image is not among the layers that the files were said to have");
    const std::lock_guard lock(mutex);
    std::map<std::string, Image>& images = pending[frame];
    images.insert_or_assign(output, image);
    std::vector<WrittenLayer> layers;
    for (const ResultImage& wanted : options.images)
      if (const auto found = images.find(wanted.name); found != images.end()) layers.push_back(layer(wanted.name, found->second));
    if (layers.size() < options.images.size()) return {};
    pending.erase(frame);
    return layers;
  }

  void forget(std::int64_t frame) {
    const std::lock_guard lock(mutex);
    pending.erase(frame);
  }

  std::optional<OriginalFile> open_original(std::int64_t frame) const {
    const std::optional<Original> original = options.original ? options.original(frame) : std::nullopt;
    return original ? std::optional<OriginalFile>(*original) : std::nullopt;
  }

  void write(std::vector<WrittenLayer> layers, std::int64_t frame, bool is_main, std::vector<FileAttribute> attributes,
             const fs::path& file) {
    std::optional<OriginalFile> original = open_original(frame);
    const FileContent content{std::move(layers), frame, original ? &*original : nullptr,
                              original && is_main && options.keep_channels, std::move(attributes)};
    write(file, [&](const fs::path& temporary) -> std::uint64_t {
      if (file.extension() == ".exr") return write_exr(content, options, temporary);
      write_png(content, options, temporary);
      return 0;
    });
  }

  /// Writes one file under its final name, or nothing. write_to(path) returns the number of clamped pixels.
  template <class Write>
  void write(const fs::path& file, const Write& write_to) {
    PendingFile unfinished(file);
    std::uint64_t changed = 0;
    try {
      changed = write_to(unfinished.path());
    } catch (const Error& error) {
      if (error.where() != unfinished.path().string()) throw;
      // Speak of the name that the user knows.
      throw Error(error.fault(), file.string(), std::string(error.what()).substr(error.where().size() + 2));
    }
    unfinished.commit();
    const std::lock_guard lock(mutex);
    written.insert(file);
    clamped += changed;
  }
};

FileSink::FileSink(FileSinkOptions options) : state_(std::make_unique<State>()) {
  const auto& known = exr_compressions();
  if (std::find(known.begin(), known.end(), options.compression) == known.end())
    fail_choice("--compression", options.compression, known);
  if (options.padding < 1 || options.padding > 20)
    throw Error(Fault::usage, "--padding", std::to_string(options.padding) + " digits are not possible; choose 1 to 20");
  if (!options.layers.empty()) require_layers(options);
  state_->options = std::move(options);
}

FileSink::~FileSink() = default;

std::vector<fs::path> FileSink::files(std::string_view output, std::int64_t frame, PortType type) const {
  if (!is_image(type)) return {state_->path(output, frame, ".json")};
  std::vector<fs::path> files;
  for (const FileFormat format : state_->formats(type))
    files.push_back(format == FileFormat::png
                        ? state_->path(output, frame, ".png")
                        : state_->path(state_->options.layers.empty() ? output : state_->options.layers, frame, ".exr"));
  if (files.empty())
    throw Error(Fault::usage, std::string(output),
                "PNG cannot hold an image of type " + std::string(name(type)) + "; choose exr");
  return files;
}

void FileSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  try {
    if (!item) throw Error(Fault::frame, std::string(output), "nothing to write in frame " + std::to_string(frame));
    const std::vector<fs::path> paths = files(output, frame, item.type());
    std::error_code error;
    fs::create_directories(state_->options.folder, error);
    if (error) throw Error(Fault::frame, state_->options.folder.string(), "the folder cannot be made: " + error.message());
    for (const fs::path& path : paths) state_->write(std::string(output), frame, item, path);
  } catch (...) {
    state_->forget(frame);
    throw;
  }
}

FileSink::KeptChannels FileSink::kept_channels(std::int64_t frame) const {
  const FileSinkOptions& options = state_->options;
  const std::optional<OriginalFile> original = options.keep_channels ? state_->open_original(frame) : std::nullopt;
  KeptChannels result;
  if (!original) return result;
  std::vector<std::string> taken;
  for (const ResultImage& image : options.images) {
    if (options.layers.empty() && image.name != state_->main_image()) continue;
    const bool plain = image.name == state_->main_image();
    for (std::string& name : channel_names(image.type, plain ? "" : image.name)) taken.push_back(std::move(name));
  }
  for (KeptChannel& channel : original->choose(taken, &result.left_out)) result.kept.push_back(std::move(channel.name));
  return result;
}

std::vector<fs::path> FileSink::written() const {
  const std::lock_guard lock(state_->mutex);
  return {state_->written.begin(), state_->written.end()};
}

std::uint64_t FileSink::clamped_pixels() const {
  const std::lock_guard lock(state_->mutex);
  return state_->clamped;
}

}  // namespace quell
