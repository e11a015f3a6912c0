// A sequence of image files and cameras as the source of a graph's inputs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/stream.h"
#include "quell/sequence/frame_range.h"
#include "quell/sequence/image_file.h"
#include "quell/sequence/image_input.h"

namespace quell {

/// Which part of the images is read.
enum class WindowChoice {
  display,  ///< the display window: what is to be looked at
  data,     ///< the data window of `color` (else of the first image input) in the first frame, which may reach beyond (overscan)
};

struct SequenceOptions {
  std::vector<std::string> in;       ///< from --in: "color=beauty_%d.exr", "id=ID_%d.exr:background=-1"; later ones win
  std::optional<FrameRange> frames;  ///< from --frames
  /// What will be read, when that is known: other inputs of a folder that are ambiguous are left out instead of being an error.
  std::optional<std::vector<std::string>> wanted = std::nullopt;
  WindowChoice window = WindowChoice::display;   ///< from --window
  std::optional<Rectangle> crop = std::nullopt;  ///< from --crop: part of that window, in pixels from its upper left corner
};

/// One input as it was found.
struct InputFiles {
  std::string input;
  std::string pattern;               ///< with its folder, as FilePattern writes it
  std::optional<PortType> type;      ///< nothing: not stated, and the name tells nothing
  std::vector<std::int64_t> frames;  ///< on disk, ascending
};

/// A file that a frame needs and the disk lacks.
struct MissingFile {
  std::string input;
  std::int64_t frame = 0;
  std::filesystem::path file;
};

/// Where the images of a run lie, in the coordinates of the sequence's files.
struct PictureWindow {
  Rectangle display;       ///< what is to be looked at
  Rectangle data;          ///< what the run reads and makes, of which it may be a part, or reach beyond it
  float pixel_aspect = 1;  ///< a pixel's width by its height
};

/// Reads frames from files. Each input is known by its name and converted to the meaning of its port type: the type that
/// expect() or the sequence.json states, else the type whose name the input has (`reference`, `emission` and `noisy` are color).
/// How files are named and converted is written in core/sequence/README.md.
class Sequence final : public FrameSource {
 public:
  /// `path` is a folder whose file names are recognized (or that holds a sequence.json), a sequence.json, a pattern of image
  /// files that serve all inputs ("multi.####.exr"), one such file (that frame alone), or empty when options.in names everything.
  /// Throws Error(input) for what is missing, unreadable, ambiguous or wrong in a sequence.json (all mistakes at once),
  /// Error(usage) for a malformed option.
  static std::unique_ptr<Sequence> open(const std::filesystem::path& path, const SequenceOptions& options = {});
  ~Sequence() override;

  /// Tells the type that the graph wants of an input. Call before shape() and read(). Throws Error(input) when the sequence.json
  /// states another type. An input that the sequence does not have is looked for in files that serve several; else it is ignored.
  void expect(std::string_view input, PortType type);

  /// The frames to run when these inputs are needed: those asked for (--frames, else "frames" of the sequence.json), else those
  /// for which every input has a file. Ascending. Throws Error(input) when the sequence lacks one of the inputs.
  std::vector<std::int64_t> frames(const std::vector<std::string>& required) const;
  /// The frames for which every one of these inputs has a file, whatever was asked for. Ascending. Throws as frames().
  std::vector<std::int64_t> complete_frames(const std::vector<std::string>& required) const;
  /// The files that are missing among the frames asked for, or, when none were asked for, among all frames that any of the
  /// required inputs has. By frame, then by input. Of frames asked for, no more than the first kMostMissing files are told: with
  /// a digit too many there may be millions.
  std::vector<MissingFile> missing(const std::vector<std::string>& required) const;
  static constexpr std::size_t kMostMissing = 10'000;
  /// Every input, by name.
  std::vector<InputFiles> inputs() const;
  /// Digits of the frame numbers in file names (of `color` when there is one), for files to be written; 4 when they are not
  /// padded.
  int padding() const;
  /// What was recognized, a line each, for printing: the input, its files, and of files with several layers, or of which
  /// something is stated, also the layer, the channels, the renderer and the conventions.
  std::string describe() const;
  /// The layers of the files that serve several inputs, a line each, for a person who misses one; "" when there are no such
  /// files.
  std::string describe_layers() const;
  /// What a person should know: padding that differs from the disk's, images that cover only part of their frame. Grows while
  /// reading.
  std::vector<std::string> warnings() const;

  /// Of `color` in the first frame, else of the first image input by name; nothing when there is no image.
  std::optional<PictureWindow> picture_window();
  /// The file of an input in a frame, whether it is there or not. Throws Error(input) when there is no such input.
  std::filesystem::path file(std::string_view input, std::int64_t frame) const;
  /// Full names (see FileChannel) of the channels that an image input is read from in a frame, one for each plane. Opens the
  /// file. Throws Error(input).
  std::vector<std::string> channels_read(std::string_view input, std::int64_t frame) const;

  /// An image input as its file holds it, before any conversion: for tests of whether it is read as it was meant. Throws
  /// Error(input).
  StoredImage read_stored(std::string_view input, std::int64_t frame, BufferPool& pool) const;

  std::optional<Shape> shape(std::string_view input) override;
  /// Pixels that are not finite are passed on as they are, except depths (see convert.h).
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override;
  bool uses_processor() const override { return true; }

 private:
  struct State;
  explicit Sequence(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace quell
