#include "quell/image/buffer_pool.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <new>
#include <optional>
#include <utility>

namespace quell {
namespace {

constexpr std::size_t kCacheLine = 64, kHugePage = std::size_t{2} << 20;

// Pixels of large images are spread over thousands of small pages, more than a processor can remember the places of: a pass that
// reads a dozen planes is then slowed down by looking them up. Huge pages are asked for where a block has room for some.
bool wants_huge_pages(std::size_t bytes) { return bytes >= 2 * kHugePage; }
std::align_val_t alignment(std::size_t bytes) { return std::align_val_t{wants_huge_pages(bytes) ? kHugePage : kCacheLine}; }
void* allocate_block(std::size_t bytes) {
  void* data = ::operator new(bytes, alignment(bytes));
  // Advice: without huge pages everything works as well. What lies behind the last whole one is not ours alone.
  if (wants_huge_pages(bytes)) ::madvise(data, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);
  return data;
}

}  // namespace

// The state is shared with every block that is out, so it outlives the pool.
struct BufferPool::State {
  std::mutex mutex;
  std::map<std::size_t, Buffer::Block*> idle;  // the blocks that came back, by size: lists, empty ones included
  Usage usage;
  std::size_t limit = std::numeric_limits<std::size_t>::max();
  std::optional<unsigned char> fill;  // what blocks hold when they are handed out; nothing: whatever they held
  bool open = true;                   // false once the pool is gone: nothing is kept any more

  Buffer::Block* take_idle(std::size_t bytes);                                   // null when there is none
  Buffer::Block* take_from_system(std::size_t bytes, std::size_t held_with_it);  // which are in_use already
  void take_back(Buffer::Block* block) noexcept;
  void free_idle(std::size_t most) noexcept;  // until `most` bytes are held, or none is idle
  std::size_t held() const { return usage.in_use + usage.idle; }
};

struct Buffer::Block {
  std::atomic<int> holders{1};
  std::size_t bytes = 0;
  void* data = nullptr;
  Block* next = nullptr;                     // of the idle blocks of this size
  std::shared_ptr<BufferPool::State> state;  // set while somebody holds the block; null without a pool

  explicit Block(std::size_t size) : bytes(size), data(allocate_block(size)) {}
  ~Block() { ::operator delete(data, alignment(bytes)); }
  static Block* try_make(std::size_t size) {
    try {
      return new Block(size);
    } catch (const std::bad_alloc&) { return nullptr; }
  }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
};

Buffer::Block* BufferPool::State::take_idle(std::size_t bytes) {
  Buffer::Block*& first = idle[bytes];
  if (!first) return nullptr;
  Buffer::Block* block = std::exchange(first, first->next);
  usage.idle -= bytes;
  block->holders.store(1, std::memory_order_relaxed);
  return block;
}

Buffer::Block* BufferPool::State::take_from_system(std::size_t bytes, std::size_t held_with_it) {
  Buffer::Block* block = Buffer::Block::try_make(bytes);
  if (!block) {  // blocks of other sizes that nobody holds may make room
    {
      const std::scoped_lock lock(mutex);
      free_idle(0);
      held_with_it = held();
    }
    block = Buffer::Block::try_make(bytes);
  }
  const std::scoped_lock lock(mutex);
  if (!block) {
    usage.in_use -= bytes;
    throw std::bad_alloc();
  }
  ++usage.allocated;
  usage.peak = std::max(usage.peak, held_with_it);
  return block;
}

void BufferPool::State::take_back(Buffer::Block* block) noexcept {
  const std::scoped_lock lock(mutex);
  const bool keep = open && held() <= limit;
  usage.in_use -= block->bytes;
  if (!keep) {
    delete block;
    return;
  }
  block->next = std::exchange(idle.find(block->bytes)->second, block);  // the list is there since the block was asked for
  usage.idle += block->bytes;
}

void BufferPool::State::free_idle(std::size_t most) noexcept {
  for (auto list = idle.rbegin(); list != idle.rend(); ++list)
    while (list->second && held() > most) {
      Buffer::Block* block = std::exchange(list->second, list->second->next);
      usage.idle -= block->bytes;
      delete block;
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
  if (state)
    state->take_back(block_);
  else
    delete block_;
}
Buffer Buffer::allocate(std::size_t bytes) { return Buffer(new Block(bytes)); }
void* Buffer::data() const { return block_->data; }
std::size_t Buffer::bytes() const { return block_->bytes; }
bool Buffer::unique() const { return block_->holders.load(std::memory_order_acquire) == 1; }

BufferPool::BufferPool() : state_(std::make_shared<State>()) {}

BufferPool::~BufferPool() {
  const std::scoped_lock lock(state_->mutex);
  state_->open = false;
  state_->free_idle(0);
}

Buffer BufferPool::acquire(std::size_t bytes) {
  bytes = std::max<std::size_t>(bytes, 1);
  State& state = *state_;
  Buffer::Block* block = nullptr;
  std::size_t held_with_it = 0;
  {
    const std::scoped_lock lock(state.mutex);
    block = state.take_idle(bytes);
    if (!block) state.free_idle(bytes < state.limit ? state.limit - bytes : 0);
    state.usage.in_use += bytes;  // before they are taken from the system, so that threads that do so at a time see each other
    held_with_it = state.held();
  }
  if (!block) block = state.take_from_system(bytes, held_with_it);
  block->state = state_;
  if (state.fill) std::memset(block->data, *state.fill, bytes);
  return Buffer(block);
}

BufferPool::Usage BufferPool::usage() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->usage;
}

void BufferPool::set_limit(std::size_t bytes) {
  const std::scoped_lock lock(state_->mutex);
  state_->limit = bytes > 0 ? bytes : std::numeric_limits<std::size_t>::max();
  state_->free_idle(state_->limit);
}

void BufferPool::fill(unsigned char byte) { state_->fill = byte; }

void BufferPool::trim() {
  const std::scoped_lock lock(state_->mutex);
  state_->free_idle(0);
}

}  // namespace quell
