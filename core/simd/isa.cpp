#include "quell/simd/isa.h"

#include <hwy/highway.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <iterator>

#include "quell/text/diagnostic.h"
#include "quell/text/error.h"

namespace quell {
namespace {

struct Isa {
  std::int64_t target;
  const char* name;
};
// All that Highway knows by names of their own, best first for each kind of processor. Others go by Highway's name.
constexpr Isa kKnown[] = {{HWY_AVX3, "avx512"}, {HWY_AVX2, "avx2"}, {HWY_SSE4, "sse4"},    {HWY_SSSE3, "ssse3"},
                          {HWY_NEON, "neon"},   {HWY_PPC8, "ppc8"}, {HWY_SCALAR, "scalar"}};

std::string name_of(std::int64_t target) {
  const auto known = std::ranges::find(kKnown, target, &Isa::target);
  return known == std::end(kKnown) ? hwy::TargetName(target) : known->name;
}

std::atomic<bool> is_pinned{false};

/// Lower bits are better, as Highway has it.
std::vector<std::int64_t> split(std::int64_t targets) {
  std::vector<std::int64_t> all;
  for (; targets != 0; targets &= targets - 1) all.push_back(targets & -targets);
  return all;
}

/// Of this machine, whatever is pinned later: the first call is made before that.
std::int64_t here() {
  static const std::int64_t targets = hwy::SupportedTargets();
  return targets;
}

const std::vector<std::int64_t>& machine_targets() {
  static const std::vector<std::int64_t> all = split(here() & HWY_TARGETS);
  return all;
}

[[noreturn]] void refuse(std::string_view name, std::string_view where) {
  std::vector<std::string> possible = isas();
  possible.insert(possible.begin(), "best");
  const bool is_known = std::ranges::find(kKnown, name, &Isa::name) != std::end(kKnown);
  const std::string quoted = "'" + printable(name) + "'";
  throw Error(Fault::usage, std::string(where),
              (is_known ? "this machine has no " + quoted : quoted + " is no vector unit" + did_you_mean(name, possible)) +
                  "; choose " + list_names(possible));
}

}  // namespace

const std::vector<std::string>& isas() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const std::int64_t target : machine_targets()) all.push_back(name_of(target));
    return all;
  }();
  return names;
}

std::string current_isa() { return name_of(split(hwy::SupportedTargets() & HWY_TARGETS).front()); }

void pin_isa(std::string_view name, std::string_view where) {
  const auto place = std::ranges::find(isas(), name);
  if (name != "best" && place == isas().end()) refuse(name, where);
  // Not DisableTargets(), which the next call of SupportedTargets(), whoever makes it, would undo for kernels. A target and all
  // behind it, which are worse, are what is left; none stands for all of the machine.
  const std::int64_t target = name == "best" ? 0 : machine_targets()[static_cast<std::size_t>(place - isas().begin())];
  hwy::SetSupportedTargetsForTest(-target & here());
  is_pinned = true;
}

void pin_isa_from_environment() {
  if (is_pinned) return;
  const char* name = std::getenv("QUELL_ISA");
  if (name && *name) pin_isa(name, "QUELL_ISA");
}

}  // namespace quell
