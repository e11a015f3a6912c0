// Sessions without files, for benchmarks of scheduling.
#pragma once

#include <chrono>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "quell/runtime/session.h"
#include "quell/sdk/pass.h"

extern "C" const quell_pass_desc* const* quell_plugin_passes(uint32_t* count);

namespace quell::bench {

inline std::shared_ptr<const Graph> make_graph(const std::string& text) {
  static const Registry registry = [] {
    Registry passes;
    std::uint32_t count = 0;
    const quell_pass_desc* const* descriptors = quell_plugin_passes(&count);
    passes.add(descriptors, count);
    return passes;
  }();
  return parse_graph(std::make_shared<const SourceText>(SourceText{"bench.json", text}), registry);
}

/// Serves one image again and again.
class OneImage final : public FrameSource {
 public:
  explicit OneImage(Size size) : image_(QUELL_TYPE_COLOR, size, pool_) {
    const FloatOutput pixels = image_.writable_floats();
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < size.height; ++y) std::fill_n(pixels.row(y, c), size.width, 0.5F);
  }
  std::optional<Shape> shape(std::string_view) override { return shape_of(Item(image_)); }
  Item read(std::string_view, std::int64_t, BufferPool&) override { return image_; }

 private:
  BufferPool pool_;
  Image image_;
};

class Nowhere final : public FrameSink {
 public:
  void write(std::string_view, std::int64_t, const Item&) override {}
};

inline std::vector<std::int64_t> first_frames(int count) {
  std::vector<std::int64_t> frames(static_cast<std::size_t>(count));
  std::iota(frames.begin(), frames.end(), 1);
  return frames;
}

/// Wall time of a run in seconds. Throws when a frame fails.
inline double time_run(const std::shared_ptr<const Graph>& graph, Size size, int frames, const SessionOptions& options) {
  OneImage source(size);
  Nowhere sink;
  Session session(graph, options);
  session.run(first_frames(2), source, sink);  // memory and threads are there from now on
  const auto start = std::chrono::steady_clock::now();
  for (const FrameReport& report : session.run(first_frames(frames), source, sink))
    if (!report.ok) throw Error(Fault::frame, "frame " + std::to_string(report.frame), report.error);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace quell::bench
