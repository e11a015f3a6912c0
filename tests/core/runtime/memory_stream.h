// Frames in memory: a source that is told what to serve, and a sink that keeps what it gets. Sessions call both from any thread;
// the fields are for before and after a run.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "quell/image/stream.h"
#include "quell/runtime/session.h"
#include "quell/sdk/pass.h"

extern "C" const quell_pass_desc* const* quell_plugin_passes(uint32_t* count);

namespace quell {

inline Registry test_passes() {
  Registry registry;
  std::uint32_t count = 0;
  const quell_pass_desc* const* passes = quell_plugin_passes(&count);
  registry.add(passes, count);
  return registry;
}

inline std::shared_ptr<const Graph> test_graph(const std::string& text) {
  static const Registry registry = test_passes();
  return parse_graph(std::make_shared<const SourceText>(SourceText{"test.json", text}), registry);
}

inline Image flat_color(Size size, float value, BufferPool& pool) {
  Image image(QUELL_TYPE_COLOR, size, pool);
  const FloatOutput view = image.writable_floats();
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) view.at(x, y, c) = value;
  return image;
}

/// Serves colors that have the frame's number in every pixel, unless told otherwise.
class MemorySource final : public FrameSource {
 public:
  Size size{8, 6};
  std::set<std::string> absent;           // inputs that it does not have
  std::set<std::int64_t> unreadable;      // frames that fail
  std::map<std::int64_t, Size> odd_size;  // frames of another size
  std::function<void(Image&, std::int64_t frame)> paint = [](Image&, std::int64_t) {};
  std::vector<std::pair<std::string, std::int64_t>> reads;

  std::optional<Shape> shape(std::string_view input) override {
    if (absent.contains(std::string(input))) return std::nullopt;
    return Shape{QUELL_TYPE_COLOR, size, 0, true};
  }
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override {
    {
      const std::scoped_lock lock(mutex_);
      reads.emplace_back(input, frame);
    }
    if (unreadable.contains(frame)) throw Error(Fault::input, "color." + std::to_string(frame) + ".exr", "no such file");
    const auto odd = odd_size.find(frame);
    Image image = flat_color(odd == odd_size.end() ? size : odd->second, static_cast<float>(frame), pool);
    paint(image, frame);
    return image;
  }

 private:
  std::mutex mutex_;
};

class MemorySink final : public FrameSink {
 public:
  std::set<std::int64_t> unwritable;
  std::map<std::pair<std::string, std::int64_t>, Item> items;

  void write(std::string_view output, std::int64_t frame, const Item& item) override {
    if (unwritable.contains(frame)) throw Error(Fault::frame, "out.exr", "disk full");
    const std::scoped_lock lock(mutex_);
    items[{std::string(output), frame}] = item;
  }
  bool has(const std::string& output, std::int64_t frame) const {
    const std::scoped_lock lock(mutex_);
    return items.contains({output, frame});
  }
  float pixel(const std::string& output, std::int64_t frame, int x = 0, int y = 0) const {
    const std::scoped_lock lock(mutex_);
    return items.at({output, frame}).image()->floats().at(x, y);
  }

 private:
  mutable std::mutex mutex_;
};

/// The sum of all frames so far.
inline const char* const kSumGraph = R"({"quell": 1, "inputs": {"color": "color"},
  "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color",
                    "history": {"from": "sum.color", "delay": 1, "initial": "none"}}}},
  "outputs": {"color": "sum.color"}})";

}  // namespace quell
