// Rendered frames of any size in memory, whose motion and cameras fit them: what whole graphs are measured with.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "quell/graph/graph.h"
#include "quell/image/stream.h"

namespace quell::bench {

/// Consecutive frames of the room where the data lies beside the repository, else of the sample that ships, with every pixel
/// repeated until the size is reached: mirror images, with which the benchmarks of single passes continue a frame, would be seen
/// by no camera. They are served lap after lap; the frame after a lap's last is its first again, as after a cut.
class GraphFrames final : public FrameSource {
 public:
  static constexpr int kFrames = 6;  // 0.9 GB of 1920 x 1080

  /// Reads what is wanted and the sequence has. What it lacks but is required is served by the input that is named after its type
  /// (diffuse and specular light by the color), which costs a graph the same.
  GraphFrames(const std::vector<GraphInput>& inputs, Size size, int count = kFrames);

  /// The frames of a lap, counted from 0.
  std::vector<std::int64_t> lap(int number) const;
  const std::string& from() const { return from_; }

  std::optional<Shape> shape(std::string_view input) override;
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override;

 private:
  int count_;
  BufferPool pool_;
  std::map<std::string, std::vector<Item>, std::less<>> items_;  // by input
  std::string from_;                                             // for people
};

}  // namespace quell::bench
