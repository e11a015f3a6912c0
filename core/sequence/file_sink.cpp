#include "quell/sequence/file_sink.h"

#include <algorithm>
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
  mutable std::mutex mutex;
  std::set<fs::path> written;
  std::uint64_t clamped = 0;

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

  /// Writes one file under its final name, or nothing. write_to(path) returns the number of clamped pixels.
  template <class Write>
  void write(const fs::path& file, const Write& write_to) {
    PendingFile pending(file);
    std::uint64_t changed = 0;
    try {
      changed = write_to(pending.path());
    } catch (const Error& error) {  // speak of the name that the user knows
      throw Error(error.fault(), file.string(), std::string(error.what()).substr(error.where().size() + 2));
    }
    pending.commit();
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
  state_->options = std::move(options);
}

FileSink::~FileSink() = default;

std::vector<fs::path> FileSink::files(std::string_view output, std::int64_t frame, PortType type) const {
  if (!is_image(type)) return {state_->path(output, frame, ".json")};
  std::vector<fs::path> files;
  for (const FileFormat format : state_->formats(type))
    files.push_back(state_->path(output, frame, format == FileFormat::exr ? ".exr" : ".png"));
  if (files.empty())
    throw Error(Fault::usage, std::string(output),
                "PNG cannot hold an image of type " + std::string(name(type)) + "; choose exr");
  return files;
}

void FileSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  if (!item) throw Error(Fault::frame, std::string(output), "nothing to write in frame " + std::to_string(frame));
  const PortType type = item.type();
  const std::vector<fs::path> paths = files(output, frame, type);
  std::error_code error;
  fs::create_directories(state_->options.folder, error);
  if (error) throw Error(Fault::frame, state_->options.folder.string(), "the folder cannot be made: " + error.message());
  const bool half = state_->options.type == PixelType::half ||
                    (state_->options.type == PixelType::automatic && (type == QUELL_TYPE_COLOR || type == QUELL_TYPE_ALBEDO));
  for (const fs::path& path : paths) {
    state_->write(path, [&](const fs::path& temporary) -> std::uint64_t {
      if (path.extension() == ".exr") return write_exr(*item.image(), temporary, half, state_->options.compression);
      if (path.extension() == ".png")
        write_png(*item.image(), temporary);
      else
        write_text(to_json(item, frame), temporary);
      return 0;
    });
  }
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
