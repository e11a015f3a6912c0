// Runs graphs over made-up frames under any schedule, and keeps all that comes out, so that two runs can be compared bit for bit.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "quell/runtime/session.h"
#include "tests/core/runtime/schedule_graph.h"

namespace quell::test {

/// Frames, and what is wrong with them.
struct Scene {
  std::vector<std::int64_t> frames;
  Size size{13, 19};
  std::map<std::int64_t, Size> odd = {};                           ///< frames of another size
  std::set<std::pair<std::string, std::int64_t>> unreadable = {};  ///< inputs in some frames
  std::set<std::int64_t> unwritable = {};
  std::vector<std::int64_t> cuts = {};
  std::set<std::int64_t> dirty = {};  ///< each input has a NaN, at dirty_pixel()

  Size size_of(std::int64_t frame) const;
  static bool is_dirty_pixel(int x, int y, int c) { return x == 0 && y == 0 && c == 0; }
};
Scene random_scene(Dice& dice);

/// The number in a pixel of the `input`th input, below the modulus of ring.h.
std::int64_t pattern(int input, std::int64_t frame, int x, int y, int c);

/// Serves pattern().
class PatternSource : public FrameSource {
 public:
  PatternSource(std::vector<TestInput> inputs, Scene scene) : inputs_(std::move(inputs)), scene_(std::move(scene)) {}
  std::function<void(std::string_view input, std::int64_t frame)> on_read;  ///< called first; may throw
  bool keeps_busy = false;                                                  ///< see FrameSource::uses_processor

  std::optional<Shape> shape(std::string_view input) override;
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override;
  bool uses_processor() const override { return keeps_busy; }

 private:
  std::vector<TestInput> inputs_;
  Scene scene_;
};

/// An item by its numbers: of images by plane, row and column.
struct Picture {
  PortType type = QUELL_TYPE_COLOR;
  Size size;
  std::vector<double> numbers;
  bool operator==(const Picture& other) const;  // bit for bit
};
Picture picture(const Item& item);

using Pictures = std::map<std::pair<std::string, std::int64_t>, Picture>;  // by output and frame

/// Copies what it gets and holds none of it.
class RecordingSink : public FrameSink {
 public:
  explicit RecordingSink(std::set<std::int64_t> unwritable = {}) : unwritable_(std::move(unwritable)) {}
  std::function<void(std::string_view output, std::int64_t frame)> on_write;  ///< called first; may throw
  std::function<void(std::string_view output, std::int64_t frame)> on_written;
  bool keeps_busy = false;  ///< see FrameSink::uses_processor

  void write(std::string_view output, std::int64_t frame, const Item& item) override;
  bool uses_processor() const override { return keeps_busy; }
  Pictures take();

 private:
  std::set<std::int64_t> unwritable_;
  std::mutex mutex_;
  Pictures pictures_;
};

struct Outcome {
  Pictures pictures;
  std::vector<FrameReport> reports;
};
/// Fails unless both handed out the same frames and bits, and told the same of each frame.
void expect_same(const Outcome& got, const Outcome& want);

/// One of the ways in which a graph may run.
struct Setting {
  int threads = 1;
  int frames = 1;  ///< in flight
};
inline constexpr int kSettings = 16;
/// {1, 2, 4, 8} threads and as many frames in flight, by number.
Setting setting(int number);
std::string describe(const Setting& setting);
SessionOptions concurrent(const Setting& setting);
SessionOptions serial();

/// Runs over all frames of the scene; every block of the pool is filled with NaN before it is used. `keeps_busy`: whether
/// reading and writing count among the threads.
Outcome run(const std::shared_ptr<const Graph>& graph, const std::vector<TestInput>& inputs, const Scene& scene,
            SessionOptions options, bool keeps_busy = false);
/// The same, where after each of these frames the session ends, and another one goes on with what it has saved.
Outcome run_in_parts(const std::shared_ptr<const Graph>& graph, const std::vector<TestInput>& inputs, const Scene& scene,
                     const SessionOptions& options, const std::set<std::int64_t>& last_frames);
/// The same as run(), where nothing but the history is wanted of some frames, as RunContext has it.
Outcome run_for_history(const std::shared_ptr<const Graph>& graph, const std::vector<TestInput>& inputs, const Scene& scene,
                        SessionOptions options, const std::vector<std::int64_t>& history_only);
/// Runs serially, then in all 16 settings, and expects the same.
void expect_same_in_all_settings(const std::shared_ptr<const Graph>& graph, const std::vector<TestInput>& inputs,
                                 const Scene& scene, const std::vector<std::string>& dumps = {});

}  // namespace quell::test
