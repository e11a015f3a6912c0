// What Sequence keeps: its inputs and what is known of their files. Private to core/sequence.
#pragma once

#include <map>
#include <mutex>
#include <set>

#include "quell/sequence/image_input.h"
#include "quell/sequence/input_spec.h"
#include "quell/sequence/sequence.h"

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

struct Sequence::State {
  std::string title;  ///< what was recognized
  std::map<std::string, SequenceInput, std::less<>> inputs;
  std::optional<FrameRange> asked;
  std::map<std::string, PortType, std::less<>> expected;

  mutable std::mutex mutex;  ///< guards what follows
  std::set<std::string> warnings;
  std::map<std::string, Shape, std::less<>> shapes;

  void add(InputSpec spec, Listings& listings);
  const SequenceInput* find(std::string_view name) const;
  /// Throws Error(input) when there is no such input.
  const SequenceInput& require(std::string_view name) const;
  /// The same, also when it has no file at all.
  const SequenceInput& require_files(std::string_view name) const;
  /// Stated, expected by the graph, or told by the name. Throws Error(input) when unknown.
  PortType type(const SequenceInput& input) const;
  /// How to read its files. An id's background that is not stated is 0 beside sidecars (objects are numbered from 1 there), and
  /// every negative value elsewhere.
  ImageRequest request(const SequenceInput& input) const;
  Shape shape(std::string_view name);
  /// The size of the images, for a camera file that does not tell it: of `color`, else of the first image by name.
  Size resolution(const std::filesystem::path& camera);

 private:
  std::int64_t first_frame(const SequenceInput& input) const;
  bool is_picture(const SequenceInput& input) const;
};

}  // namespace quell
