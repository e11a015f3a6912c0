// Where frames come from and where they go. core/sequence implements both for files; tests and programs that embed quell
// implement them in memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "quell/image/item.h"

namespace quell {

/// Serves the inputs of a graph. Calls may come from several threads at once, and for later frames before earlier ones.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The shape of an input, which must be the same for most frames (a frame that differs resets history); nothing when the
  /// source does not have the input at all. Throws Error when it should, but cannot be read.
  virtual std::optional<Shape> shape(std::string_view input) = 0;
  /// The input in one frame; the session replaces NaN and infinity. Throws Error(Fault::input) when missing or unreadable.
  virtual Item read(std::string_view input, std::int64_t frame, BufferPool& pool) = 0;
  /// Whether reading keeps a processor busy (decoding a file): the session then counts it among its threads. What only hands
  /// over, or waits, says false.
  virtual bool uses_processor() const { return false; }
};

/// Takes results. Calls may come from several threads at once, each for another frame or output, and later frames before earlier
/// ones.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// `output` is the name of a graph output, or "node.port" of an inner image that was asked for ("input.color" for a graph
  /// input). Throws Error when it cannot be written; no other output of that frame follows then.
  virtual void write(std::string_view output, std::int64_t frame, const Item& item) = 0;
  /// As FrameSource::uses_processor, for writing.
  virtual bool uses_processor() const { return false; }
};

}  // namespace quell
