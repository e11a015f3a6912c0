#include "tests/core/runtime/counting_new.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> count{0};

void* count_and_allocate(std::size_t size, std::size_t alignment) noexcept {
  count.fetch_add(1, std::memory_order_relaxed);
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void* require(void* block) {
  if (!block) throw std::bad_alloc();
  return block;
}

constexpr std::size_t kUsual = alignof(std::max_align_t);

}  // namespace

std::size_t quell::test::allocations() { return count.load(); }

// Every form that is used: a sanitizer's others do not lead to these.
void* operator new(std::size_t size) { return require(count_and_allocate(size, kUsual)); }
void* operator new[](std::size_t size) { return require(count_and_allocate(size, kUsual)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return count_and_allocate(size, kUsual); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return count_and_allocate(size, kUsual); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return require(count_and_allocate(size, static_cast<std::size_t>(alignment)));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return require(count_and_allocate(size, static_cast<std::size_t>(alignment)));
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete[](void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }
