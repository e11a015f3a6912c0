#include "quell/runtime/trace.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>

#include "quell/text/json.h"

namespace quell {
namespace {

constexpr std::string_view name_of(Trace::Kind kind) {
  switch (kind) {
    case Trace::Kind::node:
      return "node";
    case Trace::Kind::help:
      return "help";
    case Trace::Kind::read:
      return "read";
    case Trace::Kind::write:
      return "write";
  }
  return "";
}

/// Whole units and three decimals, exactly: slices that nest as times do so as text.
std::string thousandths(std::int64_t count) {
  std::string decimals = std::to_string(count % 1000);
  decimals.insert(0, 3 - decimals.size(), '0');
  return std::to_string(count / 1000) + "." + decimals;
}

std::string mebibytes(std::size_t bytes) {
  std::array<char, 32> text{};
  const double value = static_cast<double>(bytes) / (1 << 20);
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 3).ptr};
}

}  // namespace

// The format's array form: it may be cut off behind any event.
struct Trace::State {
  // What one thread did.
  struct Lane {
    int id = 0;
    bool computes = false, files = false;
  };

  std::ostream& out;
  const Clock::time_point start = Clock::now();
  std::mutex mutex;
  std::map<std::thread::id, Lane> lanes;
  int compute_lanes = 0, file_lanes = 0, mixed_lanes = 0;
  BufferPool::Usage last = {};
  bool finished = false;

  explicit State(std::ostream& stream) : out(stream) {
    out << R"([{"ph":"M","pid":1,"name":"process_name","args":{"name":"quell"}})";
  }

  std::int64_t nanoseconds(Clock::duration time) const {
    return std::max<std::int64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(time).count(), 0);
  }
  std::string microseconds(Clock::duration time) const { return thousandths(nanoseconds(time)); }

  void name_lane(const Lane& lane) {
    const std::string name = lane.computes && lane.files
                                 ? (++mixed_lanes == 1 ? "session" : "session " + std::to_string(mixed_lanes))
                             : lane.computes ? "compute " + std::to_string(++compute_lanes)
                                             : "files " + std::to_string(++file_lanes);
    out << ",\n"
        << R"({"ph":"M","pid":1,"tid":)" << lane.id << R"(,"name":"thread_name","args":{"name":")" << name << R"("}})";
  }

  // The lane is named by what its thread did so far; of two names the later one counts.
  int lane_of_this_thread(Kind kind) {
    const auto [found, is_new] = lanes.try_emplace(std::this_thread::get_id());
    Lane& lane = found->second;
    if (is_new) lane.id = static_cast<int>(lanes.size());
    bool& does = kind == Kind::node || kind == Kind::help ? lane.computes : lane.files;
    if (!std::exchange(does, true)) name_lane(lane);
    return lane.id;
  }
};

Trace::Trace(std::ostream& out) : state_(std::make_unique<State>(out)) {}
Trace::~Trace() = default;

void Trace::slice(Kind kind, std::string_view name, std::int64_t frame, Clock::time_point start, Clock::time_point end) {
  State& s = *state_;
  start = std::max(start, s.start);
  const std::string quoted = quote_json(name);
  const std::scoped_lock lock(s.mutex);
  if (s.finished) return;
  const int lane = s.lane_of_this_thread(kind);
  s.out << ",\n"
        << R"({"ph":"X","pid":1,"tid":)" << lane << R"(,"ts":)" << s.microseconds(start - s.start) << R"(,"dur":)"
        << s.microseconds(end - start) << R"(,"cat":")" << name_of(kind) << R"(","name":)" << quoted << R"(,"args":{"frame":)"
        << frame << "}}";
}

void Trace::memory(const BufferPool::Usage& usage) {
  State& s = *state_;
  const std::scoped_lock lock(s.mutex);
  if (s.finished || (usage.in_use == s.last.in_use && usage.idle == s.last.idle)) return;
  s.last = usage;
  s.out << ",\n"
        << R"({"ph":"C","pid":1,"ts":)" << s.microseconds(Clock::now() - s.start);
  s.out << R"(,"name":"memory, MiB",)";
  s.out << R"("args":{"in use":)" << mebibytes(usage.in_use) << R"(,"idle":)" << mebibytes(usage.idle) << "}}";
}

void Trace::finish() {
  const std::scoped_lock lock(state_->mutex);
  if (!state_->finished) state_->out << "]\n";
  state_->finished = true;
}

}  // namespace quell
