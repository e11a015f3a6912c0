// The joint bilateral filter against others, against double precision, and against itself on other threads, radii and sizes.
#include <algorithm>
#include <cmath>
#include <deque>

#include "quell/simd/isa.h"
#include "tests/bench/figure.h"
#include "tests/bench/workload.h"

namespace quell::bench {
namespace {

constexpr Size kSize{512, 512};
constexpr int kRadius = 16;
const std::vector<std::string> kUnits = {"avx512", "avx2"};  // with bars of their own
constexpr double kBars[] = {40, 18};

bool machine_has(const std::string& isa) { return std::ranges::find(isas(), isa) != isas().end(); }

double best_of_five(PassRunner& pass) {
  double best = pass.run();
  for (int i = 1; i < 5; ++i) best = std::min(best, pass.run());
  return best;
}

double run_on(const std::string& isa, PassRunner& pass) {
  const std::string before = current_isa();
  pin_isa(isa, "bench");
  const double best = best_of_five(pass);
  pin_isa(before, "bench");
  return best;
}

void compare_with_others(const BenchFrame& frame, std::vector<Figure>& figures) {
  const InterleavedFrame pixels = interleave(frame);
  PassRunner pass(joint_bilateral_setup(frame, kRadius), acceptance_threads());
  const std::vector<Float3> listing = filter_as_the_course(pixels, {}, acceptance_threads());
  const auto red = [&](int x, int y) { return listing[static_cast<std::size_t>(y * pixels.width + x)].x; };
  require_same_filter(pass.output().floats(), red, "the course's listing");
  std::vector<std::function<double()>> ways = {
      [&] { return best_of_five(pass); },
      [&] { return time_call([&] { filter_as_the_course(pixels, {}, acceptance_threads()); }); }};
  if (kHasOpenCv) ways.push_back([&] { return time_call([&] { filter_with_opencv(pixels, {}, acceptance_threads()); }); });
  std::vector<std::string> units;
  std::ranges::copy_if(kUnits, std::back_inserter(units), machine_has);
  for (const std::string& isa : units) ways.push_back([&pass, isa] { return run_on(isa, pass); });
  const std::vector<double> seconds = time_alternately(3, ways);

  for (std::size_t i = 0; i < kUnits.size(); ++i) {
    Figure figure{.what = "radius 16, 512x512, times as fast as the course's listing, " + kUnits[i], .bar = kBars[i]};
    const auto place = std::ranges::find(units, kUnits[i]);
    if (place == units.end()) {
      figure.skipped = "this machine has no " + kUnits[i];
    } else {
      const double own = seconds[ways.size() - units.size() + static_cast<std::size_t>(place - units.begin())];
      figure.reached = seconds[1] / own;
      figure.note = in_milliseconds(own, seconds[1]);
    }
    figures.push_back(figure);
  }
  figures.push_back({.what = "radius 16, 512x512, times as fast as OpenCV's filter, " + current_isa(), .bar = 6});
  if (kHasOpenCv)
    figures.back().reached = seconds[2] / seconds[0], figures.back().note = in_milliseconds(seconds[0], seconds[2]);
  else
    figures.back().skipped = "OpenCV was not found when this was built";
}

/// The largest relative error on a grid of pixels.
double largest_error(const InterleavedFrame& pixels, const FloatImage& got, int radius) {
  constexpr int kStep = 7;
  const BilateralSettings settings{.radius = radius};
  double largest = 0;
  for (int y = 0; y < pixels.height; y += kStep)
    for (int x = 0; x < pixels.width; x += kStep) {
      const Double3 want = filter_in_double(pixels, settings, x, y);
      const double error[] = {got.at(x, y, 0) / want.x - 1, got.at(x, y, 1) / want.y - 1, got.at(x, y, 2) / want.z - 1};
      for (const double e : error)
        if (std::isfinite(e)) largest = std::max(largest, std::abs(e));
    }
  return largest;
}

void compare_with_double(const BenchFrame& frame, std::vector<Figure>& figures) {
  PassRunner pass(joint_bilateral_setup(frame, kRadius), acceptance_threads());
  const InterleavedFrame pixels = interleave(frame);
  for (const std::string& isa : isas()) {
    if (isa == "scalar") continue;  // the same source without vectors, and slow
    run_on(isa, pass);
    figures.push_back({.what = "largest relative error against double precision, " + isa,
                       .reached = largest_error(pixels, pass.output().floats(), kRadius),
                       .bar = 1e-4,
                       .at_most = true});
  }
}

void compare_threads(const BenchFrame& frame, std::vector<Figure>& figures) {
  Figure figure{.what = "2 threads, times as fast as 1", .bar = 1.85};
  if (acceptance_threads() < 2) {
    figure.skipped = "this machine has one processor";
  } else {
    PassRunner one(joint_bilateral_setup(frame, kRadius), 1), two(joint_bilateral_setup(frame, kRadius), 2);
    const auto seconds = time_alternately(9, {[&] { return one.run(); }, [&] { return two.run(); }});
    figure.reached = seconds[0] / seconds[1];
    figure.note = in_milliseconds(seconds[0], seconds[1]);
  }
  figures.push_back(figure);
}

/// Seconds a tap of the filter in several setups, measured in alternation.
std::vector<double> seconds_a_tap(const std::vector<std::pair<Size, int>>& setups) {
  std::deque<PassRunner> passes;
  std::vector<std::function<double()>> ways;
  for (const auto& [size, radius] : setups)
    passes.emplace_back(joint_bilateral_setup(make_frame(size), radius), acceptance_threads());
  for (PassRunner& pass : passes) ways.push_back([&pass] { return pass.run(); });
  std::vector<double> seconds = time_alternately(7, ways);
  for (std::size_t i = 0; i < seconds.size(); ++i) seconds[i] /= joint_bilateral_work(setups[i].first, setups[i].second).taps;
  return seconds;
}

void compare_with_itself(std::vector<Figure>& figures) {
  const auto radii = seconds_a_tap({{kSize, 4}, {kSize, 8}, {kSize, 16}, {kSize, 32}});
  figures.push_back({.what = "spread of the cost per tap over the radii 4, 8, 16, 32",
                     .reached = spread(radii),
                     .bar = 0.15,
                     .at_most = true,
                     .note = in_nanoseconds(radii, "ns a tap")});
  const auto sizes = seconds_a_tap({{{1280, 720}, 8}, {{1920, 1080}, 8}, {{2560, 1440}, 8}, {{3840, 2160}, 8}});
  figures.push_back({.what = "spread of the cost per tap from 720p to 2160p, radius 8",
                     .reached = spread(sizes),
                     .bar = 0.1,
                     .at_most = true,
                     .note = in_nanoseconds(sizes, "ns a tap")});
}

}  // namespace

std::vector<Figure> joint_bilateral_figures() {
  const BenchFrame frame = make_frame(kSize);
  std::vector<Figure> figures;
  compare_with_others(frame, figures);
  compare_with_double(frame, figures);
  compare_threads(frame, figures);
  compare_with_itself(figures);
  return figures;
}

}  // namespace quell::bench
