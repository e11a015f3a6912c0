#include "run_options.h"

#include <CLI/CLI.hpp>
#include <cctype>
#include <charconv>
#include <cmath>

#include "arguments.h"
#include "quell/sequence/frame_range.h"
#include "quell/text/error.h"

namespace quell::app {
namespace {

constexpr int kMostThreads = 1024;
constexpr int kMostFrames = 1024;
constexpr std::string_view kUnits = "KMGT";

// In the order of OnError.
const std::vector<std::string> kOnError = {"continue", "stop", "reset", "hold"};

int parse_frames_in_flight(const std::string& text, bool serial) {
  const int frames = text == "auto" ? 0 : parse_count(text, "--frames-in-flight", 1, kMostFrames, ", or 'auto'");
  if (frames > 1 && serial)
    throw Error(Fault::usage, "--frames-in-flight",
                "'" + text + "' is not possible with --executor serial, which takes one frame after the other");
  return serial ? 1 : frames;
}

}  // namespace

std::string_view name_of(OnError on_error) { return kOnError[static_cast<std::size_t>(on_error)]; }

std::size_t parse_memory(const std::string& text) {
  constexpr double kMost = 1e18;
  if (text == "auto") return 0;
  std::string_view digits = text;
  const char last = digits.empty() ? '\0' : digits.back();
  const std::size_t unit = kUnits.find(static_cast<char>(std::toupper(static_cast<unsigned char>(last))));
  const bool has_unit = unit != std::string_view::npos;
  if (has_unit) digits.remove_suffix(1);

  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  const bool is_number =
      error == std::errc() && end == digits.data() + digits.size() && digits.front() >= '0' && digits.front() <= '9';
  const double bytes = has_unit ? std::ldexp(value, 10 * (static_cast<int>(unit) + 1)) : value;
  const bool is_half_a_byte = !has_unit && value != std::floor(value);  // "1.5": the unit was forgotten
  if (!is_number || is_half_a_byte || bytes < 1 || bytes > kMost)
    throw Error(Fault::usage, "--memory",
                "'" + text +
                    "' is not an amount of memory; write bytes, with K, M, G or T for powers of 1024, such as 512M or 1.5G, or "
                    "'auto'");
  return static_cast<std::size_t>(bytes);
}

SessionOptions parse_schedule(const ScheduleArguments& arguments) {
  SessionOptions options;
  options.threads = parse_count(arguments.threads, "--threads", 0, kMostThreads);
  const bool serial = parse_choice(arguments.executor, "--executor", {"serial", "tbb"}) == 0;
  options.schedule = serial ? Schedule::serial : Schedule::concurrent;
  options.frames_in_flight = parse_frames_in_flight(arguments.frames_in_flight, serial);
  options.memory = parse_memory(arguments.memory);
  options.on_error = static_cast<OnError>(parse_choice(arguments.on_error, "--on-error", kOnError));
  if (!arguments.cut.empty()) options.cuts = FrameRange::parse(arguments.cut, "--cut").frames();
  return options;
}

void add_options(CLI::App& app, ScheduleArguments& arguments) {
  add_text(app, "--threads", arguments.threads, "N",
           "Threads that compute, decode and encode at a time; 0, the default, for as many as there are processors.")
      ->group(kScheduleGroup);
  add_text(app, "--frames-in-flight", arguments.frames_in_flight, "N",
           "Most frames at a time, from reading to writing: 1 to 1024, or auto, the default: what loops, memory and threads "
           "make useful.")
      ->group(kScheduleGroup);
  add_text(app, "--memory", arguments.memory, "SIZE",
           "Most resident memory: bytes, or with K, M, G or T, such as 512M or 1.5G. A run that cannot keep within it does not "
           "start, and tells how much it needs. auto, the default, is half of what there is, for images.")
      ->group(kScheduleGroup);
  add_text(app, "--executor", arguments.executor, "NAME",
           "tbb, the default, or serial: one node after the other, for comparison. The results are the same.")
      ->group(kScheduleGroup);
  add_text(
      app, "--on-error", arguments.on_error, "WHAT",
      "When a frame fails: continue, the default, with the others; stop; or continue, where it could not be computed, with the "
      "history ended (reset) or that of the frame before (hold).")
      ->group(kScheduleGroup);
  add_text(app, "--cut", arguments.cut, "FRAMES",
           "Frames with which a new shot begins, such as 101,240: nothing of the frames before them is used from there on.")
      ->group(kScheduleGroup);
}

void warn_of_idle_cuts(const std::vector<std::int64_t>& cuts, const std::vector<std::int64_t>& frames, const Plan& plan) {
  if (cuts.empty()) return;
  if (plan.histories.empty())
    return spdlog::warn("--cut has no effect: every frame of the graph '{}' is computed by itself", plan.graph->name);
  std::vector<std::int64_t> idle = cuts;
  std::erase_if(idle, [&](std::int64_t cut) { return !frames.empty() && frames.front() < cut && cut <= frames.back(); });
  if (!idle.empty())
    spdlog::warn("--cut: nothing is separated at {}; the run has frames {}", FrameRange(idle).text(), FrameRange(frames).text());
}

}  // namespace quell::app
