// Measures all figures that must be reached, prints a line for each, and returns 1 when one is missed. Wants a machine that has
// nothing else to do.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "quell/runtime/executor.h"
#include "quell/simd/isa.h"
#include "quell/text/diagnostic.h"
#include "tests/bench/figure.h"

namespace quell::bench {
namespace {

constexpr double kIdle = 0.3;  // load of the last minute

void print(const Figure& figure) {
  if (!figure.skipped.empty()) {
    std::printf("skip     -          %-72s  %s\n", figure.what.c_str(), figure.skipped.c_str());
  } else {
    std::printf("%-4s %9.4g  %-8s %6.4g  %-52s  %s\n", figure.missed() ? "MISS" : "pass", figure.reached,
                figure.at_most ? "at most" : "at least", figure.bar, figure.what.c_str(), figure.note.c_str());
  }
  std::fflush(stdout);
}

/// Whether all are reached.
bool measure(const char* subject, std::vector<Figure> (*figures)()) {
  std::printf("%s\n", subject);
  std::fflush(stdout);
  bool all = true;
  for (const Figure& figure : figures()) {
    print(figure);
    all = all && !figure.missed();
  }
  return all;
}

int run() {
  std::printf("%d processors; vector units %s\n", available_threads(), list_names(isas(), "and").c_str());
  double load = 0;
  if (getloadavg(&load, 1) == 1 && load > kIdle)
    std::printf("the machine is not idle (load %.1f): what is said of several threads, and of misses, counts for little\n", load);
  bool all = measure("scheduler", scheduler_figures);
  all = measure("joint_bilateral", joint_bilateral_figures) && all;
  all = measure("flip", flip_figures) && all;
  all = measure("atrous", atrous_figures) && all;
  return all ? 0 : 1;
}

}  // namespace
}  // namespace quell::bench

int main() {
  try {
    return quell::bench::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
