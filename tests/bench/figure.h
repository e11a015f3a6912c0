// Figures that must be reached, each a ratio within one run, so that it holds on slow and fast machines alike.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "quell/sdk/types.h"

namespace quell::bench {

struct Figure {
  std::string what;
  double reached = 0;
  double bar = 0;
  bool at_most = false;  ///< the bar must not be exceeded
  std::string skipped;   ///< why there is no figure; empty: there is
  std::string note;      ///< what it is made of, for people

  bool missed() const { return skipped.empty() && !(at_most ? reached <= bar : reached >= bar); }
};

/// What each part of the acceptance measures, one function a subject.
std::vector<Figure> scheduler_figures();
std::vector<Figure> joint_bilateral_figures();
std::vector<Figure> flip_figures();
std::vector<Figure> atrous_figures();
std::vector<Figure> games202_figures();
std::vector<Figure> svgf_figures();
std::vector<Figure> throughput_figures();
std::vector<Figure> file_figures();

/// The seconds of several ways to do something, in their order, again and again in alternation, so that all see the same
/// neighbors: of each the smallest, to which the machine's other work has added least.
std::vector<double> time_alternately(int repeats, const std::vector<std::function<double()>>& ways);

/// Throws when `got`'s red and `want(x, y)` differ by more than 1e-2 in more than one pixel of ten: that what is timed beside
/// each other is the same filter.
void require_same_filter(const FloatImage& got, const std::function<float(int x, int y)>& want, const std::string& what);

/// How much the largest value lies above the smallest, as a fraction.
double spread(const std::vector<double>& values);

/// "12.3 ms and 45.6 ms"
std::string in_milliseconds(double a, double b);
/// "1.2, 1.3 ns a tap"
std::string in_nanoseconds(const std::vector<double>& seconds, const char* unit);

/// Threads of the bars: two, or one where there is no more.
int acceptance_threads();

}  // namespace quell::bench
