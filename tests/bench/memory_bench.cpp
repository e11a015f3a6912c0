// Passes around the filters, which do little with each pixel: what they take beside a copy of as many bytes.
#include <algorithm>
#include <map>
#include <string>

#include "tests/bench/graph_frames.h"
#include "tests/bench/kernel_bench.h"

namespace quell::bench {
namespace {

constexpr Size kSize{1920, 1080};

// An input of one of two consecutive frames.
Item input(std::string_view name, int frame = 1) {
  static BufferPool pool;
  static GraphFrames frames({{"albedo", QUELL_TYPE_ALBEDO},
                             {"camera", QUELL_TYPE_CAMERA},
                             {"color", QUELL_TYPE_COLOR},
                             {"depth", QUELL_TYPE_DEPTH},
                             {"id", QUELL_TYPE_ID},
                             {"motion", QUELL_TYPE_MOTION},
                             {"normal", QUELL_TYPE_NORMAL},
                             {"position", QUELL_TYPE_POSITION}},
                            kSize, 2);
  return frames.read(name, frame, pool);
}

Item filled(PortType type, float value) {
  static BufferPool pool;
  Image image(type, kSize, pool);
  for (int y = 0; y < kSize.height; ++y) std::fill_n(image.writable_floats().row(y), kSize.width, value);
  return image;
}

PassSetup back_project_setup() {
  return {.pass = "back_project",
          .inputs = {{"depth", input("depth")},
                     {"id", input("id")},
                     {"camera", input("camera")},
                     {"previous_camera", input("camera", 0)}},
          .outputs = {"motion"}};
}
PassSetup motion_setup() {
  return {.pass = "motion",
          .params = R"({"sign": "current-previous", "unit": "uv"})",
          .inputs = {{"vectors", input("motion")}, {"camera", input("camera")}, {"previous_camera", input("camera", 0)}},
          .outputs = {"motion"}};
}
PassSetup previous_position_setup() {
  return {.pass = "previous_position",
          .inputs = {{"position", input("position")},
                     {"id", input("id")},
                     {"camera", input("camera")},
                     {"previous_camera", input("camera", 0)}},
          .outputs = {"position", "depth"}};
}
PassSetup sanitize_setup() { return {.pass = "sanitize", .params = R"({"max": 100})", .inputs = {{"color", input("color")}}}; }
PassSetup validate_setup() {
  return {.pass = "validate",
          .inputs = {{"motion", input("motion")},
                     {"normal", input("normal")},
                     {"depth", input("depth")},
                     {"image", input("albedo")},
                     {"history", input("albedo", 0)},
                     {"valid", filled(QUELL_TYPE_MASK, 1)},
                     {"length", filled(QUELL_TYPE_SCALAR, 8)},
                     {"rejected", filled(QUELL_TYPE_SCALAR, 0.25F)}},
          .outputs = {"picture"}};
}

double bytes_of(const Item& item) {
  if (!item.image()) return 0;
  return 4.0 * info(item.image()->type()).channels * item.image()->width() * item.image()->height();
}

// Each image that the pass reads read once, and each that it yields written once.
void measure(benchmark::State& state, const PassSetup& setup, int threads) {
  PassRunner pass(setup, threads);
  double total = 0;
  for ([[maybe_unused]] auto _ : state) {
    const double seconds = pass.run();
    state.SetIterationTime(seconds);
    total += seconds;
  }
  const double seconds = total / static_cast<double>(state.iterations());
  double bytes = 0;
  for (const auto& [port, item] : setup.inputs) bytes += bytes_of(item);
  for (const std::string& port : setup.outputs) bytes += bytes_of(pass.output(port));
  state.counters["ns/px"] = seconds * 1e9 / (double{1} * kSize.width * kSize.height);
  state.counters["GB/s"] = bytes / seconds / 1e9;
  state.counters["of_copy"] = bytes / seconds / ceilings(threads).bytes_per_second;
}

}  // namespace

void add_memory_benchmarks() {
  const std::map<std::string, PassSetup (*)()> setups = {{"back_project_of_depth", back_project_setup},
                                                         {"motion", motion_setup},
                                                         {"previous_position", previous_position_setup},
                                                         {"sanitize", sanitize_setup},
                                                         {"validate", validate_setup}};
  for (const auto& [name, make_setup] : setups)
    for (const int threads : thread_counts()) {
      const std::string full = name + "/" + text(kSize) + "/threads:" + std::to_string(threads);
      benchmark::RegisterBenchmark(
          full.c_str(), [=, make_setup = make_setup](benchmark::State& state) { measure(state, make_setup(), threads); })
          ->Unit(benchmark::kMillisecond)
          ->UseManualTime();
    }
}

}  // namespace quell::bench
