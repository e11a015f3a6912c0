// What a run leaves in memory for the next one: values of nodes and inputs, by name and frame. Private to this box.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/stream.h"
#include "quell/runtime/executor.h"

namespace quell {

/// Values by the names of their endpoints: "filter.color", or "color" for a graph input. Copies of what it gets, in a pool of its
/// own. All members may be called from several threads.
class Remembered {
 public:
  /// From now on values of that name are kept, in the given shape.
  void expect(const std::string& name, const Shape& shape);
  void forget(std::string_view name);
  void forget_all();
  /// Drops what is not among the names.
  void forget_others(const std::set<std::string>& names);

  bool expects(std::string_view name) const;
  std::optional<Shape> shape(std::string_view name) const;
  /// Nothing when it is not there.
  Item find(std::string_view name, std::int64_t frame) const;
  /// Whether it is there in every one of the frames.
  bool has_all(std::string_view name, const std::vector<std::int64_t>& frames) const;

  /// Keeps a value that is expected. A value of a node is given up for good when it is of another shape, or holds NaN or
  /// infinity: coming in as an input, either would be something else than it was.
  void put(std::string_view name, std::int64_t frame, const Item& item, bool is_input);
  BufferPool::Usage usage() const { return pool_.usage(); }

 private:
  struct Value {
    Shape shape;
    std::map<std::int64_t, Item> items;
    bool is_unfit = false;
  };
  Item copy(const Item& item);

  BufferPool pool_;
  Executor alone_{1, ThreadSource::threads};
  mutable std::mutex mutex_;
  std::map<std::string, Value, std::less<>> values_;
};

/// Serves what is remembered, and all else from a source, which is then remembered, too, where that is expected.
class RememberingSource final : public FrameSource {
 public:
  /// `fed`: the inputs that only memory has.
  RememberingSource(FrameSource& source, Remembered& memory, std::set<std::string> fed)
      : source_(source), memory_(memory), fed_(std::move(fed)) {}

  std::optional<Shape> shape(std::string_view input) override;
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override;
  bool uses_processor() const override { return source_.uses_processor(); }

  /// Whether every read so far succeeded, and brought an item of the input's shape.
  bool is_steady() const { return steady_; }

 private:
  Item read_source(std::string_view input, std::int64_t frame, BufferPool& pool);
  FrameSource& source_;
  Remembered& memory_;
  const std::set<std::string> fed_;
  std::mutex mutex_;
  std::map<std::string, std::optional<Shape>, std::less<>> shapes_;
  std::atomic<bool> steady_{true};
};

/// Hands results on to a sink; those called "remember:filter.color" go to memory.
class RememberingSink final : public FrameSink {
 public:
  static constexpr std::string_view kMark = "remember:";
  RememberingSink(FrameSink& sink, Remembered& memory) : sink_(sink), memory_(memory) {}

  void write(std::string_view output, std::int64_t frame, const Item& item) override;
  bool uses_processor() const override { return sink_.uses_processor(); }
  /// Whether writing this frame failed.
  bool has_failed(std::int64_t frame) const;

 private:
  FrameSink& sink_;
  Remembered& memory_;
  mutable std::mutex mutex_;
  std::set<std::int64_t> failed_;
};

}  // namespace quell
