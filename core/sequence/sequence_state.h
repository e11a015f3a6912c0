// What Sequence keeps: its inputs and what is known of their files. Private to core/sequence.
#pragma once

#include <map>
#include <mutex>
#include <set>
#include <variant>

#include "quell/sequence/header_camera.h"
#include "quell/sequence/image_input.h"
#include "quell/sequence/input_spec.h"
#include "quell/sequence/sequence.h"
#include "quell/text/error.h"

namespace quell {

/// An input and the files it has.
struct SequenceInput {
  InputSpec spec;
  std::vector<std::int64_t> frames;  ///< on disk, ascending
  bool has_sidecars = false;         ///< frame.<n>.json lie beside the files
};

/// Folders' listings, each read once.
class Listings {
 public:
  const std::vector<std::string>& of(const std::filesystem::path& folder);

 private:
  std::map<std::filesystem::path, std::vector<std::string>> listings_;
};

/// A camera of a part of the image: `window` as in ImageRequest. Jitter stays.
Camera shift(Camera camera, const Rectangle& window);

struct Sequence::State {
  std::string title;  ///< what was recognized
  std::map<std::string, SequenceInput, std::less<>> inputs;
  std::optional<FilePattern> shared;  ///< the files that serve all inputs, when the sequence was given so
  std::optional<FrameRange> asked;
  WindowChoice window_choice = WindowChoice::display;
  std::optional<Rectangle> crop;
  std::map<std::string, PortType, std::less<>> expected;

  mutable std::mutex mutex;  ///< guards what follows
  std::set<std::string> warnings;
  std::map<std::string, Shape, std::less<>> shapes;
  std::optional<std::optional<PictureWindow>> known_window;  ///< once they are known

  std::mutex reading_mutex;                                                                ///< guards what follows
  std::map<std::string, std::variant<HeaderReading, Error>, std::less<>> header_readings;  ///< or why there is none, by input

  void add(InputSpec spec, Listings& listings);
  const SequenceInput* find(std::string_view name) const;
  /// Adds an input of a name that nobody thought of when `shared` was opened. Null when the files have no layer for it.
  const SequenceInput* find_shared(std::string_view name, PortType type);
  /// Throws Error(input) when there is no such input.
  const SequenceInput& require(std::string_view name) const;
  /// The same, also when it has no file at all.
  const SequenceInput& require_files(std::string_view name) const;
  /// Stated, expected by the graph, or told by the name. Throws Error(input) when unknown.
  PortType type(const SequenceInput& input) const;
  /// How to read its files. An id's background that is not stated is 0 beside sidecars (objects are numbered from 1 there), and
  /// every negative value elsewhere. Throws Error(input) when a convention is stated that its type does not have.
  ImageRequest request(const SequenceInput& input);
  /// What is read of the first file of an image input, and how its numbers are meant. Throws Error(input).
  Selection selection(const SequenceInput& input);
  /// For people; "" when there is nothing to be told, or it cannot be told yet.
  std::string describe_choice(const SequenceInput& input);
  /// A frame of a camera input. How the headers of an image sequence are to be read is found out once, from its first frames, and
  /// told in `warnings`.
  Camera read_camera(const SequenceInput& input, std::int64_t frame);
  /// That of the input named `camera`, else of the first camera by name; nothing when it has no file for the frame. Throws
  /// Error(input) when there is no camera at all.
  std::shared_ptr<const Camera> find_camera(std::int64_t frame);
  Shape shape(std::string_view name);
  /// The size of the images, for a camera file that does not tell it: of `color`, else of the first image by name.
  Size resolution(const std::filesystem::path& camera);
  /// Of the main picture in its first frame. Throws Error(usage) when what is to be cropped is not all in it.
  std::optional<PictureWindow> picture_window();
  /// What is to be read of each image, see ImageRequest; nothing for all.
  std::optional<Rectangle> window();

 private:
  PictureWindow find_window(const SequenceInput& picture);
  void require_same_size(const SequenceInput& input);
  HeaderReading reading_of(const SequenceInput& input);
  HeaderReading choose_reading(const SequenceInput& input);
  std::optional<HeaderPositions> find_positions(std::int64_t frame, Size size);
  std::int64_t first_frame(const SequenceInput& input) const;
  bool is_picture(const SequenceInput& input) const;
  /// `color`, else the first image by name; null when there is none.
  const SequenceInput* main_picture() const;
};

}  // namespace quell
