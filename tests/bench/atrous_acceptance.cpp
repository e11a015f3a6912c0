// A level of the à-trous wavelet with the stops of SVGF against a plain version, the machine's ceilings, and itself.
#include <algorithm>
#include <deque>

#include "quell/simd/isa.h"
#include "tests/bench/figure.h"
#include "tests/bench/workload.h"

namespace quell::bench {
namespace {

constexpr Size kSize{1920, 1080};

/// In a row, as frames follow each other: a processor that was idle is slow at first.
double best_of_ten(PassRunner& pass) {
  double best = pass.run();
  for (int i = 1; i < 10; ++i) best = std::min(best, pass.run());
  return best;
}

/// `issue` is the least time that a core takes for the operations.
Figure part_of_bound(double seconds, double issue) {
  const double copy = atrous_work(kSize, 0).bytes / measure_copy_bandwidth(acceptance_threads());
  return {.what = std::string("1080p, part of the ") + (issue > copy ? "issue" : "bandwidth") + " bound, the lower one",
          .reached = std::max(issue, copy) / seconds,
          .bar = 0.6,
          .note = "issue and bandwidth bound " + in_milliseconds(issue, copy)};
}

void compare_with_others(const BenchFrame& frame, std::vector<Figure>& figures) {
  const int threads = acceptance_threads();
  const AtrousFrame pixels = interleave_for_atrous(frame);
  PassRunner pass(atrous_setup(frame, 0), threads);
  const AtrousResult plain = filter_as_the_paper(pixels, {}, threads);
  const auto red = [&](int x, int y) { return plain.color[static_cast<std::size_t>(y * pixels.width + x)].x; };
  require_same_filter(pass.output().floats(), red, "the plain version");
  // The bound, too: it is what the machine can do at the time.
  const auto seconds = time_alternately(
      5, {[&] { return best_of_ten(pass); }, [&] { return time_call([&] { filter_as_the_paper(pixels, {}, threads); }); },
          [&] { return atrous_work(kSize, 0).units * measure_issue_bound(Kernel::atrous, threads); }});
  figures.push_back({.what = "1080p, times as fast as the plain version, " + current_isa(),
                     .reached = seconds[1] / seconds[0],
                     .bar = 25,
                     .note = in_milliseconds(seconds[0], seconds[1])});
  figures.push_back(part_of_bound(seconds[0], seconds[2]));
}

void compare_threads(const BenchFrame& frame, std::vector<Figure>& figures) {
  Figure figure{.what = "2 threads, times as fast as 1", .bar = 1.85};
  if (acceptance_threads() < 2) {
    figure.skipped = "this machine has one processor";
  } else {
    PassRunner one(atrous_setup(frame, 0), 1), two(atrous_setup(frame, 0), 2);
    const auto seconds = time_alternately(5, {[&] { return best_of_ten(one); }, [&] { return best_of_ten(two); }});
    figure.reached = seconds[0] / seconds[1];
    figure.note = in_milliseconds(seconds[0], seconds[1]);
  }
  figures.push_back(figure);
}

void compare_sizes(std::vector<Figure>& figures) {
  std::deque<PassRunner> passes;
  std::vector<std::function<double()>> ways;
  for (const Size size : {Size{1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}}) {
    PassRunner& pass = passes.emplace_back(atrous_setup(make_frame(size), 0), acceptance_threads());
    ways.push_back([&pass, pixels = atrous_work(size, 0).pixels] { return pass.run() / pixels; });
  }
  const std::vector<double> seconds = time_alternately(15, ways);
  figures.push_back({.what = "spread of the cost per pixel from 720p to 2160p",
                     .reached = spread(seconds),
                     .bar = 0.1,
                     .at_most = true,
                     .note = in_nanoseconds(seconds, "ns a pixel")});
}

}  // namespace

std::vector<Figure> atrous_figures() {
  const BenchFrame frame = make_frame(kSize);
  std::vector<Figure> figures;
  compare_with_others(frame, figures);
  compare_threads(frame, figures);
  compare_sizes(figures);
  return figures;
}

}  // namespace quell::bench
