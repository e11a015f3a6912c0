#include "quell/image/buffer_pool.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <new>
#include <optional>
#include <utility>

namespace quell {
namespace {
constexpr std::align_val_t kAlignment{64};
}

// Blocks that come back wait here, by size. The state is shared with every block that is out, so it outlives the pool.
struct BufferPool::State {
  std::mutex mutex;
  std::map<std::size_t, std::vector<Buffer::Block*>> idle;
  Usage usage;
  std::optional<unsigned char> fill;  // what blocks hold when they are handed out; nothing: whatever they held
  bool open = true;                   // false once the pool is gone: nothing is kept any more

  void take_back(Buffer::Block* block);
  void free_idle();
};

struct Buffer::Block {
  std::atomic<int> holders{1};
  std::size_t bytes = 0;
  void* data = nullptr;
  std::shared_ptr<BufferPool::State> state;  // set while somebody holds the block

  explicit Block(std::size_t size) : bytes(size), data(::operator new(size, kAlignment)) {}
  ~Block() { ::operator delete(data, kAlignment); }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
};

void BufferPool::State::take_back(Buffer::Block* block) {
  {
    const std::scoped_lock lock(mutex);
    usage.in_use -= block->bytes;
    if (open) {
      idle[block->bytes].push_back(block);
      usage.idle += block->bytes;
      return;
    }
  }
  delete block;
}

void BufferPool::State::free_idle() {
  for (auto& [bytes, blocks] : idle) {
    for (Buffer::Block* block : blocks) delete block;
    usage.idle -= bytes * blocks.size();
    blocks.clear();
  }
}

Buffer::Buffer(const Buffer& other) : block_(other.block_) {
  if (block_) block_->holders.fetch_add(1, std::memory_order_relaxed);
}
Buffer::Buffer(Buffer&& other) noexcept : block_(std::exchange(other.block_, nullptr)) {}
Buffer& Buffer::operator=(Buffer other) noexcept {
  std::swap(block_, other.block_);
  return *this;
}
Buffer::~Buffer() {
  if (!block_ || block_->holders.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  const std::shared_ptr<BufferPool::State> state = std::move(block_->state);
  state->take_back(block_);
}
void* Buffer::data() const { return block_->data; }
std::size_t Buffer::bytes() const { return block_->bytes; }
bool Buffer::unique() const { return block_->holders.load(std::memory_order_acquire) == 1; }

BufferPool::BufferPool() : state_(std::make_shared<State>()) {}

BufferPool::~BufferPool() {
  const std::scoped_lock lock(state_->mutex);
  state_->open = false;
  state_->free_idle();
}

Buffer::Block* BufferPool::new_block(std::size_t bytes) {
  try {
    return new Buffer::Block(bytes);
  } catch (const std::bad_alloc&) {
    trim();  // blocks of other sizes that nobody holds may make room
    return new Buffer::Block(bytes);
  }
}

Buffer BufferPool::acquire(std::size_t bytes) {
  Buffer::Block* block = nullptr;
  {
    const std::scoped_lock lock(state_->mutex);
    auto& idle = state_->idle[bytes];
    if (!idle.empty()) {
      block = idle.back();
      idle.pop_back();
      state_->usage.idle -= bytes;
      state_->usage.in_use += bytes;
      block->holders.store(1, std::memory_order_relaxed);
    }
  }
  if (!block) {
    block = new_block(bytes);
    const std::scoped_lock lock(state_->mutex);
    Usage& usage = state_->usage;
    usage.in_use += bytes;
    ++usage.allocated;
    usage.peak = std::max(usage.peak, usage.in_use + usage.idle);
  }
  block->state = state_;
  if (state_->fill) std::memset(block->data, *state_->fill, bytes);
  return Buffer(block);
}

BufferPool::Usage BufferPool::usage() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->usage;
}

void BufferPool::fill(unsigned char byte) { state_->fill = byte; }

void BufferPool::trim() {
  const std::scoped_lock lock(state_->mutex);
  state_->free_idle();
}

}  // namespace quell
