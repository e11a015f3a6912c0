// Measures the figures that must be reached, prints a line for each, and returns 1 when one is missed. Wants a machine that has
// nothing else to do.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "quell/runtime/executor.h"
#include "quell/simd/isa.h"
#include "quell/text/diagnostic.h"
#include "quell/text/error.h"
#include "tests/bench/figure.h"

namespace quell::bench {
namespace {

constexpr double kIdle = 0.3;  // load of the last minute

struct Subject {
  std::string name;
  std::vector<Figure> (*figures)();
};
const std::vector<Subject> kSubjects = {{"scheduler", scheduler_figures},   {"joint_bilateral", joint_bilateral_figures},
                                        {"atrous", atrous_figures},         {"flip", flip_figures},
                                        {"games202", games202_figures},     {"svgf", svgf_figures},
                                        {"throughput", throughput_figures}, {"files", file_figures}};

std::vector<std::string> subject_names() {
  std::vector<std::string> names;
  for (const Subject& subject : kSubjects) names.push_back(subject.name);
  return names;
}

/// Those that are named, in the order of the list; all when none is.
std::vector<Subject> choose(const std::vector<std::string>& wanted) {
  const std::vector<std::string> names = subject_names();
  for (const std::string& name : wanted)
    if (std::ranges::find(names, name) == names.end())
      throw Error(
          Fault::usage, "bench_acceptance",
          "'" + printable(name) + "' is no subject" + did_you_mean(name, names) + "; choose of " + list_names(names, "and"));
  std::vector<Subject> chosen;
  std::ranges::copy_if(kSubjects, std::back_inserter(chosen), [&](const Subject& subject) {
    return wanted.empty() || std::ranges::find(wanted, subject.name) != wanted.end();
  });
  return chosen;
}

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
bool measure(const Subject& subject) {
  std::printf("%s\n", subject.name.c_str());
  std::fflush(stdout);
  bool all = true;
  for (const Figure& figure : subject.figures()) {
    print(figure);
    all = all && !figure.missed();
  }
  return all;
}

int run(const std::vector<std::string>& arguments) {
  if (std::ranges::any_of(arguments, [](std::string_view a) { return a == "--help" || a == "-h"; })) {
    std::printf("bench_acceptance [SUBJECT...]: the figures that must be reached, of all subjects or of those named: %s\n",
                list_names(subject_names(), "and").c_str());
    return 0;
  }
  const std::vector<Subject> subjects = choose(arguments);
  pin_isa_from_environment();
  std::printf("%d processors; vector units %s; computing on %s\n", available_threads(), list_names(isas(), "and").c_str(),
              current_isa().c_str());
  double load = 0;
  if (getloadavg(&load, 1) == 1 && load > kIdle)
    std::printf("the machine is not idle (load %.1f): what is said of several threads, and of misses, counts for little\n", load);
  bool all = true;
  for (const Subject& subject : subjects) all = measure(subject) && all;
  return all ? 0 : 1;
}

}  // namespace
}  // namespace quell::bench

int main(int argc, char** argv) {
  try {
    return quell::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
