#include "quell/runtime/window.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "quell/runtime/wiring.h"
#include "quell/text/error.h"

namespace quell {
namespace {

std::size_t physical_memory() {
  return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// "max", which does not parse, means that there is no limit; so does a file that is not there.
std::size_t read_limit(const std::string& file) {
  std::size_t bytes = 0;
  return std::ifstream(file) >> bytes ? bytes : SIZE_MAX;
}

// The path of this process's control group (version 2), such as "/user.slice/job"; "" when there is none.
std::string control_group() {
  std::ifstream file("/proc/self/cgroup");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("0::/")) return line.substr(3) == "/" ? "" : line.substr(3);
  return "";
}

std::size_t add(std::size_t a, std::size_t b) { return a > SIZE_MAX - b ? SIZE_MAX : a + b; }

std::string mebibytes(std::size_t bytes) { return std::to_string(bytes / (1 << 20) + (bytes % (1 << 20) > 0 ? 1 : 0)) + " MiB"; }

constexpr int kReadAndWritten = 2;  // beside the frames in computation: one that is being read, one that is being written
constexpr int kMostChosen = 16;     // with so many, threads that have nothing to do have other reasons

// How many frames can be computed at a time, whatever the number of threads, when every node is part of a loop: each lets no more
// in than its delay. 0: any number.
int frames_within_loops(const Plan& plan) {
  std::set<int> inside;
  int delay = 0;
  for (const PlannedLoop& loop : plan.loops) {
    inside.insert(loop.nodes.begin(), loop.nodes.end());
    delay = std::min(delay + std::min(loop.delay, kMostChosen), kMostChosen);
  }
  return inside.size() == plan.nodes.size() ? delay : 0;
}

}  // namespace

std::size_t available_memory() {
  std::size_t bytes = physical_memory();
  bytes = std::min(bytes, read_limit("/sys/fs/cgroup/memory/memory.limit_in_bytes"));  // version 1
  for (std::string group = control_group();; group.resize(group.rfind('/'))) {
    bytes = std::min(bytes, read_limit("/sys/fs/cgroup" + group + "/memory.max"));
    if (group.empty()) return bytes;
  }
}

Window choose_window(const Plan& plan, int threads, int frames, std::size_t memory, std::size_t reserved) {
  Window window;
  for (std::size_t step = 0; step < plan.turns.size(); ++step) {
    const std::size_t alive = plan.alive_bytes[static_cast<std::size_t>(plan.turns[step].nodes.front())];
    window.bytes_per_frame = std::max(window.bytes_per_frame, add(alive, thread_memory(plan, step, threads)));
  }
  window.bytes_per_frame = std::max(window.bytes_per_frame, plan.frame_bytes);
  window.fixed_bytes = plan.history_bytes;
  for (const InitialConstant& constant : Wiring(plan).constants)
    if (is_image(constant.shape.type))
      window.fixed_bytes = add(window.fixed_bytes, Image::bytes_needed(constant.shape.type, constant.shape.size));

  const std::size_t least = add(window.fixed_bytes, window.bytes_per_frame);
  const std::size_t available = available_memory();
  // Half leaves room for the files' codecs and for others; a graph that needs more than that gets it.
  if (memory == 0) reserved = 0;
  window.memory = memory > 0 ? memory - std::min(memory, reserved) : std::max(available / 2, std::min(least, available));
  if (least > window.memory)
    throw Error(Fault::memory, plan.graph->name,
                "a frame takes " + mebibytes(window.bytes_per_frame) + " and history " + mebibytes(window.fixed_bytes) +
                    (reserved > 0 ? ", the program and its files " + mebibytes(reserved) : "") + ", so at least " +
                    mebibytes(add(least, reserved)) + " are needed; " +
                    (memory > 0 ? "the limit is " : "this process may have ") +
                    mebibytes(add(window.memory, std::min(memory, reserved))));

  const int within = frames_within_loops(plan);
  if (frames > 0) {
    window.frames = frames;
    window.reason = "as asked for";
  } else if (within > 0 && within < threads) {
    window.frames = std::min(within + kReadAndWritten, kMostChosen);
    window.reason = "a loop holds every node";
  } else {
    window.frames = std::min(threads + kReadAndWritten, kMostChosen);
    window.reason = threads == 1 ? "1 thread" : std::to_string(threads) + " threads";
  }
  const std::size_t room = (window.memory - window.fixed_bytes) / std::max<std::size_t>(window.bytes_per_frame, 1);
  if (room < static_cast<std::size_t>(window.frames)) {
    window.frames = static_cast<int>(room);
    window.reason = "what the memory limit has room for";
  }
  return window;
}

std::size_t thread_memory(const Plan& plan, std::size_t step, int threads) {
  const auto lines = [](std::size_t bytes) { return (bytes + 63) / 64 * 64; };
  std::size_t scratch = 0;  // the nodes of a thread take turns
  for (const int position : plan.turns[step].nodes)
    scratch = std::max(scratch, lines(plan.nodes[static_cast<std::size_t>(position)].slot_scratch_bytes));
  const std::size_t bytes = add(scratch, lines(plan.turns[step].window_bytes)), count = static_cast<std::size_t>(threads);
  return bytes > SIZE_MAX / count ? SIZE_MAX : bytes * count;
}

}  // namespace quell
