// The loops use as many registers as the smallest unit has (16), and tell the compiler by empty assembly what it may not fold: an
// operand may have changed since it was last seen, a result is needed. Neither costs an instruction.
#include "tests/bench/ceilings.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <barrier>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "quell/simd/isa.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/ceilings.cpp"  // from the repository root
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "quell/simd/vectors-inl.h"

#ifndef QUELL_BENCH_CEILINGS_SHARED  // what is the same for all vector units
#define QUELL_BENCH_CEILINGS_SHARED
namespace quell::bench {

enum class Op { fma, add, mul, min_max, divide, root, estimate, shift, logic };

constexpr int kChains = 10;  // sums of multiply-adds: as many as hide their latency
constexpr int kCacheLines = 8;

// An operation of a mix. A multiply-add goes to the chain behind that of the one before; the second operand of some is loaded.
struct Step {
  Op op;
  int chain;
  int line;  // that is loaded; -1: none
};

// The operations of a mix in an order in which each kind is spread evenly, and so are loads.
template <Mix kMix>
constexpr auto spread() {
  constexpr int kCounts[] = {kMix.fma,  kMix.add,      kMix.mul,   kMix.min_max, kMix.divide,
                             kMix.root, kMix.estimate, kMix.shift, kMix.logic};
  constexpr int kAll = kMix.operations();
  std::array<Step, static_cast<std::size_t>(kAll)> steps{};
  int done[std::size(kCounts)] = {};
  for (int i = 0; i < kAll; ++i) {
    std::size_t next = 0;
    double largest = -1;
    for (std::size_t k = 0; k < std::size(kCounts); ++k) {
      const double behind = static_cast<double>(i + 1) * kCounts[k] / kAll - done[k];
      if (done[k] < kCounts[k] && behind > largest) largest = behind, next = k;
    }
    const bool loads = (i + 1) * kMix.load / kAll > i * kMix.load / kAll;
    const auto op = static_cast<Op>(next);
    steps[static_cast<std::size_t>(i)] = {op, op == Op::fma ? done[next] % kChains : 0, loads ? i % kCacheLines : -1};
    ++done[next];
  }
  return steps;
}

// Once for all vector units: a compiler takes minutes when each step asks anew.
template <Mix kMix>
constexpr auto kSteps = spread<kMix>();

}  // namespace quell::bench
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::bench::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

#if HWY_ARCH_X86
#define QUELL_VECTOR_REGISTER "v"
#else
#define QUELL_VECTOR_REGISTER "w"
#endif
HWY_INLINE void may_change(V& v) { asm volatile("" : "+" QUELL_VECTOR_REGISTER(v.raw)); }
HWY_INLINE void need(V v) { asm volatile("" : : QUELL_VECTOR_REGISTER(v.raw)); }
#undef QUELL_VECTOR_REGISTER

// Members instead of an array, which would lie in memory.
struct Chains {
  V c0, c1, c2, c3, c4, c5, c6, c7, c8, c9;
};
template <int kIndex>
HWY_INLINE V& chain_of(Chains& c) {
  if constexpr (kIndex == 0) return c.c0;
  if constexpr (kIndex == 1) return c.c1;
  if constexpr (kIndex == 2) return c.c2;
  if constexpr (kIndex == 3) return c.c3;
  if constexpr (kIndex == 4) return c.c4;
  if constexpr (kIndex == 5) return c.c5;
  if constexpr (kIndex == 6) return c.c6;
  if constexpr (kIndex == 7) return c.c7;
  if constexpr (kIndex == 8) return c.c8;
  if constexpr (kIndex == 9) return c.c9;
}
HWY_INLINE Chains no_sums() { return {zero(), zero(), zero(), zero(), zero(), zero(), zero(), zero(), zero(), zero()}; }
HWY_INLINE void need(const Chains& c) {
  need(c.c0), need(c.c1), need(c.c2), need(c.c3), need(c.c4), need(c.c5), need(c.c6), need(c.c7), need(c.c8), need(c.c9);
}

// An operation whose second operand is `b`. A multiply-add goes to a chain, since its result takes the place of an operand; all
// others are by themselves.
template <Op kOp>
HWY_INLINE void operate(V& chain, V& a, V b) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  may_change(a);
  if constexpr (kOp == Op::fma) chain = hn::MulAdd(a, b, chain);
  if constexpr (kOp == Op::add) need(hn::Sub(a, b));
  if constexpr (kOp == Op::mul) need(hn::Mul(a, b));
  if constexpr (kOp == Op::min_max) need(hn::Min(a, b));
  if constexpr (kOp == Op::divide) need(hn::Div(a, b));
  if constexpr (kOp == Op::root) need(hn::Sqrt(a));
  if constexpr (kOp == Op::estimate) need(hn::ApproximateReciprocal(a));
  if constexpr (kOp == Op::shift) need(hn::BitCast(d, hn::ShiftLeft<23>(hn::BitCast(du, a))));
  if constexpr (kOp == Op::logic) need(hn::And(a, b));
}

template <Step kStep>
HWY_INLINE void take(Chains& chains, V& a, V b, const float* memory) {
  if constexpr (kStep.line >= 0) b = hn::LoadU(D(), memory + kStep.line * kMaxLanes);
  operate<kStep.op>(chain_of<kStep.chain>(chains), a, b);
}

template <Mix kMix, std::size_t... kIndices>
HWY_INLINE void take_all(Chains& chains, V& a, V b, const float* memory, std::index_sequence<kIndices...>) {
  (take<kSteps<kMix>[kIndices]>(chains, a, b, memory), ...);
}

template <Mix kMix>
void run_mix(std::int64_t rounds) {
  HWY_ALIGN float memory[kCacheLines * kMaxLanes];
  std::fill_n(memory, kCacheLines * kMaxLanes, 1.0F);
  Chains chains = no_sums();
  V a = set(1.0F);
  const V b = set(1.0F);
  for (std::int64_t i = 0; i < rounds; ++i) {
    asm volatile("" : : "r"(memory) : "memory");
    take_all<kMix>(chains, a, b, memory, std::make_index_sequence<kSteps<kMix>.size()>());
  }
  need(chains);
}

void RunMix(Kernel kernel, std::int64_t rounds) {
  switch (kernel) {
    case Kernel::joint_bilateral:
      return run_mix<kJointBilateralMix>(rounds);
    case Kernel::atrous:
      return run_mix<kAtrousMix>(rounds);
  }
}

void RunFma(std::int64_t rounds) {
  Chains chains = no_sums();
  V a = set(1.0F), b = a;
  const auto add = [&](V& chain) { chain = hn::MulAdd(a, b, chain); };
  for (std::int64_t i = 0; i < rounds; ++i) {
    may_change(a), may_change(b);
    add(chains.c0), add(chains.c1), add(chains.c2), add(chains.c3), add(chains.c4);
    add(chains.c5), add(chains.c6), add(chains.c7), add(chains.c8), add(chains.c9);
  }
  need(chains);
}

// Past the caches: a kernel's output is not read again before it has left them.
void Copy(const float* from, float* to, std::size_t count) {
  const D d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) hn::Stream(hn::Load(d, from + i), d, to + i);
  hwy::FlushStream();
}

int CountLanes() { return lanes(); }

}  // namespace quell::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::bench {

HWY_EXPORT(RunMix);
HWY_EXPORT(RunFma);
HWY_EXPORT(Copy);
HWY_EXPORT(CountLanes);

namespace {

constexpr int kRepeats = 5;
constexpr std::int64_t kFmaRounds = 3'000'000;  // some 10 ms
constexpr std::int64_t kMixOperations = 40'000'000;

double best_of_repeats(const std::function<double()>& seconds) {
  double best = seconds();
  for (int i = 1; i < kRepeats; ++i) best = std::min(best, seconds());
  return best;
}

/// Floats of each of the two images of the copy: four times the last-level cache, at most 1 GiB.
std::size_t copied_floats() {
  const long cache = std::max(sysconf(_SC_LEVEL3_CACHE_SIZE), 8L << 20);
  return static_cast<std::size_t>(std::min(4 * cache, 1L << 30)) / sizeof(float);
}

}  // namespace

double time_threads(int count, const std::function<void(int)>& body) {
  using Clock = std::chrono::steady_clock;
  Clock::time_point start;
  std::barrier together(count, [&]() noexcept { start = Clock::now(); });
  {
    std::vector<std::jthread> helpers;
    const auto run = [&](int i) {
      together.arrive_and_wait();
      body(i);
    };
    for (int i = 1; i < count; ++i) helpers.emplace_back(run, i);
    run(0);
  }
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double measure_copy_bandwidth(int threads) {
  constexpr std::size_t kAlign = 64 / sizeof(float);
  const std::size_t share = copied_floats() / static_cast<std::size_t>(threads) / kAlign * kAlign;
  const std::size_t count = share * static_cast<std::size_t>(threads);
  const auto make = [&] { return std::make_unique<float[]>(count + kAlign); };
  const auto aligned = [](float* p) { return p + (64 - reinterpret_cast<std::uintptr_t>(p) % 64) % 64 / sizeof(float); };
  const auto from = make(), to = make();
  const double seconds = best_of_repeats([&] {
    return time_threads(threads, [&](int i) {
      const std::size_t first = share * static_cast<std::size_t>(i);
      HWY_DYNAMIC_DISPATCH(Copy)(aligned(from.get()) + first, aligned(to.get()) + first, share);
    });
  });
  return 2.0 * sizeof(float) * static_cast<double>(count) / seconds;
}

double measure_peak_flops(int threads) {
  const double seconds = best_of_repeats([&] {
    return time_threads(threads, [](int) {
      HWY_DYNAMIC_DISPATCH(RunFma)
      (kFmaRounds);
    });
  });
  return 2.0 * kChains * vector_lanes() * static_cast<double>(kFmaRounds) * threads / seconds;
}

const Mix& mix_of(Kernel kernel) {
  static constexpr Mix kMixes[] = {kJointBilateralMix, kAtrousMix};
  return kMixes[static_cast<std::size_t>(kernel)];
}

double measure_issue_bound(Kernel kernel, int threads) {
  const std::int64_t rounds = kMixOperations / mix_of(kernel).operations();
  const double seconds = best_of_repeats([&] {
    return time_threads(threads, [&](int) {
      HWY_DYNAMIC_DISPATCH(RunMix)
      (kernel, rounds);
    });
  });
  return seconds / (static_cast<double>(rounds) * vector_lanes() * threads);
}

const Ceilings& ceilings(int threads) {
  static std::map<std::pair<std::string, int>, Ceilings> known;
  const auto [place, is_new] = known.try_emplace({current_isa(), threads});
  if (is_new) place->second = {measure_copy_bandwidth(threads), measure_peak_flops(threads)};
  return place->second;
}

double issue_bound(Kernel kernel, int threads) {
  static std::map<std::tuple<std::string, Kernel, int>, double> known;
  const auto [place, is_new] = known.try_emplace({current_isa(), kernel, threads});
  if (is_new) place->second = measure_issue_bound(kernel, threads);
  return place->second;
}

int vector_lanes() { return HWY_DYNAMIC_DISPATCH(CountLanes)(); }

}  // namespace quell::bench
#endif
