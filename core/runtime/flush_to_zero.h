// Numbers that are too small to be worth their time.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#elif defined(__aarch64__)
#include <cstdint>
#endif

namespace quell {

/// While it lives, floats below 1.2e-38 (those with less than all digits) count as 0 on this thread. Weights of filters get that
/// small, and a processor may take 150 cycles for an operation on one: a filter then takes three times as long. For the
/// loops of passes only: readers of half floats may go by numbers of that size.
class FlushToZero {
 public:
#if defined(__SSE2__)
  FlushToZero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | kResults | kOperands); }
  ~FlushToZero() { _mm_setcsr(before_); }
#elif defined(__aarch64__)
  FlushToZero() : before_(get()) { set(before_ | kFlush); }
  ~FlushToZero() { set(before_); }
#else
  FlushToZero() = default;
#endif
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;

 private:
#if defined(__SSE2__)
  static constexpr unsigned kResults = 1U << 15, kOperands = 1U << 6;  // of the control and status register
  unsigned before_;
#elif defined(__aarch64__)
  static constexpr std::uint64_t kFlush = 1U << 24;  // of the control register
  static std::uint64_t get() {
    std::uint64_t value;
    asm volatile("mrs %0, fpcr" : "=r"(value));
    return value;
  }
  static void set(std::uint64_t value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
  std::uint64_t before_;
#endif
};

}  // namespace quell
