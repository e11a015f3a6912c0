// Memory for pixels: 64-byte aligned blocks that are counted, and reused by size.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace quell {

class BufferPool;

/// A block of pixels shared by whoever holds it; it returns to its pool, if it has one, when the last holder lets go. Holding one
/// more costs no allocation. Copies may be made and dropped on any thread.
class Buffer {
 public:
  Buffer() = default;
  /// A block that belongs to no pool, 64-byte aligned, content unspecified. Throws std::bad_alloc.
  static Buffer allocate(std::size_t bytes);
  Buffer(const Buffer& other);
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer other) noexcept;
  ~Buffer();

  explicit operator bool() const { return block_ != nullptr; }
  void* data() const;
  std::size_t bytes() const;
  /// True when nobody else holds the block, so that it may be written over.
  bool unique() const;

 private:
  friend class BufferPool;
  struct Block;
  explicit Buffer(Block* block) : block_(block) {}
  Block* block_ = nullptr;
};

/// Hands out blocks, and keeps those that come back for the next request of the same size. Thread-safe. Blocks may outlive the
/// pool.
class BufferPool {
 public:
  struct Usage {
    std::size_t in_use = 0;     ///< bytes held by somebody
    std::size_t idle = 0;       ///< bytes kept for reuse
    std::size_t peak = 0;       ///< largest in_use + idle so far; requests that failed do not count
    std::size_t allocated = 0;  ///< blocks taken from the system so far
  };
  BufferPool();
  ~BufferPool();
  BufferPool(const BufferPool&) = delete;
  BufferPool& operator=(const BufferPool&) = delete;

  /// At least `bytes` bytes, 64-byte aligned, content unspecified; without an allocation when a block of that size is idle.
  /// Throws std::bad_alloc when the system has no room even without the idle blocks.
  Buffer acquire(std::size_t bytes);
  /// From now on in_use + idle stays within `bytes` (0: no limit) for as long as in_use alone does: idle blocks go back to the
  /// system, the largest first. A request is met all the same when in_use would pass the limit, so whoever decides what work
  /// begins has to count what it will hold; then nothing is kept idle.
  void set_limit(std::size_t bytes);
  Usage usage() const;
  /// Gives idle blocks back to the system.
  void trim();
  /// From now on every block is filled with `byte` before it is handed out, so that a test sees when unspecified content is used:
  /// 0xff makes floats NaN.
  void fill(unsigned char byte);

 private:
  friend class Buffer;
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace quell
