#include "tests/bench/graph_frames.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "quell/sequence/sequence.h"

namespace quell::bench {
namespace {

namespace fs = std::filesystem;

const fs::path kRoom = fs::path(QUELL_SOURCE_DIR) / "../shared/data/room";
const fs::path kSample = fs::path(QUELL_SOURCE_DIR) / "graphs/sample";
constexpr int kFirst = 2;  // the first frame's motion leads to one that is not there

template <class From, class To>
void repeat(const From& from, const To& to) {
  for (int c = 0; c < from.channels; ++c)
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x) to.row(y, c)[x] = from.row(y * from.height / to.height, c)[x * from.width / to.width];
}

Image enlarged(const Image& image, Size size, BufferPool& pool) {
  Image larger(image.type(), size, pool);
  if (info(image.type()).format == QUELL_FORMAT_U32)
    repeat(image.ids(), larger.writable_ids());
  else
    repeat(image.floats(), larger.writable_floats());
  if (image.type() != QUELL_TYPE_MOTION) return larger;
  const FloatOutput motion = larger.writable_floats();
  const float scale[] = {static_cast<float>(size.width) / static_cast<float>(image.width()),
                         static_cast<float>(size.height) / static_cast<float>(image.height())};
  for (int c = 0; c < 2; ++c)
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) motion.row(y, c)[x] *= scale[c];
  return larger;
}

Camera enlarged(Camera camera, Size size) {
  const double scale[] = {double(size.width) / camera.size.width, double(size.height) / camera.size.height};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (std::size_t column = 0; column < 4; ++column) camera.world_to_screen[4 * axis + column] *= scale[axis];
    camera.jitter[axis] *= scale[axis];
  }
  camera.size = size;
  return camera;
}

}  // namespace

GraphFrames::GraphFrames(const std::vector<GraphInput>& inputs, Size size, int count) : count_(count) {
  const bool is_room = fs::is_directory(kRoom);
  from_ = is_room ? "the room" : "graphs/sample (the room is not beside the repository)";
  const std::unique_ptr<Sequence> sequence = Sequence::open(is_room ? kRoom : kSample);
  for (const GraphInput& input : inputs) {
    sequence->expect(input.name, input.type);
    std::string source = input.name;
    if (!sequence->shape(source) && !input.optional) source = name(input.type);
    if (!sequence->shape(source)) continue;
    for (std::int64_t frame = kFirst; frame < kFirst + count; ++frame) {
      const Item item = sequence->read(source, frame, pool_);
      if (item.image())
        items_[input.name].emplace_back(enlarged(*item.image(), size, pool_));
      else
        items_[input.name].emplace_back(item.camera() ? Item(enlarged(item.camera()->camera(), size)) : item);
    }
  }
}

std::vector<std::int64_t> GraphFrames::lap(int number) const {
  std::vector<std::int64_t> frames;
  for (int i = 0; i < count_; ++i) frames.push_back(std::int64_t{number} * count_ + i);
  return frames;
}

std::optional<Shape> GraphFrames::shape(std::string_view input) {
  const auto found = items_.find(input);
  return found == items_.end() ? std::nullopt : std::optional(shape_of(found->second.front()));
}

Item GraphFrames::read(std::string_view input, std::int64_t frame, BufferPool&) {
  return items_.find(input)->second[static_cast<std::size_t>(frame % count_)];
}

}  // namespace quell::bench
