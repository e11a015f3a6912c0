#include "quell/runtime/input_reader.h"

#include <algorithm>

#include "quell/runtime/failure.h"

namespace quell {

// A frame that looks ahead past the end of the run, or a cut, finds nothing there.
std::vector<InputReader::Key> InputReader::keys(std::int64_t frame, const PlanState& state) const {
  std::vector<Key> keys;
  for (std::size_t input = 0; input < state.plan.input_used.size(); ++input)
    if (state.plan.input_used[input]) keys.push_back({frame, input});
  for (const AheadRead& ahead : state.wiring.ahead)
    if (frames_.contains(frame + ahead.frames) && state.history.is_uncut(frame, frame + ahead.frames))
      keys.push_back({frame + ahead.frames, static_cast<std::size_t>(ahead.input)});
  return keys;
}

void InputReader::want(std::int64_t frame, const PlanState& state) {
  for (const Key& key : keys(frame, state))
    if (known_.try_emplace(key).second) queue_.insert(key);
}

std::optional<InputReader::Key> InputReader::next() {
  if (queue_.empty()) return std::nullopt;
  return queue_.extract(queue_.begin()).value();
}

InputReader::Read InputReader::read(const Key& key, Executor& executor) const {
  const std::string& name = graph_.inputs[key.input].name;
  Read read;
  const auto start = Trace::Clock::now();
  try {
    read.item = source_.read(name, key.frame, pool_);
    if (!read.item) throw Error(Fault::input, name, "the source has nothing for frame " + std::to_string(key.frame));
    read.replaced = sanitize(read.item, executor, pool_);
  } catch (...) {
    read = {};
    read.error = what_failed(pool_);
  }
  const auto end = Trace::Clock::now();
  read.seconds = std::chrono::duration<double>(end - start).count();
  if (trace_) trace_->slice(Trace::Kind::read, name, key.frame, start, end);
  return read;
}

bool InputReader::is_ready(std::int64_t frame, const PlanState& state) const {
  return std::ranges::all_of(keys(frame, state), [&](const Key& key) {
    const auto found = known_.find(key);
    return found != known_.end() && found->second.has_value();
  });
}

const InputReader::Read* InputReader::find(std::int64_t frame, std::size_t input) const {
  const auto found = known_.find({frame, input});
  return found != known_.end() && found->second ? &*found->second : nullptr;
}

std::string InputReader::error(std::int64_t frame) const {
  for (std::size_t input = 0; input < graph_.inputs.size(); ++input)
    if (const Read* read = find(frame, input); read && !read->error.empty()) return read->error;
  return {};
}

InputShapes InputReader::shapes(std::int64_t frame, InputShapes planned) const {
  for (std::size_t input = 0; input < graph_.inputs.size(); ++input)
    if (const Read* read = find(frame, input); read && read->item) planned[graph_.inputs[input].name] = shape_of(read->item);
  return planned;
}

FrameInputs InputReader::take(FrameReport& report, const PlanState& state) {
  FrameInputs taken;
  // Those that look ahead share what is there; one that cannot be read counts as absent until its own turn reports it.
  for (const AheadRead& ahead : state.wiring.ahead) {
    const std::int64_t frame = report.frame + ahead.frames;
    const Read* read = state.history.is_uncut(report.frame, frame) ? find(frame, static_cast<std::size_t>(ahead.input)) : nullptr;
    taken.ahead.push_back(read ? read->item : Item());
  }
  taken.items.resize(graph_.inputs.size());
  for (std::size_t input = 0; input < graph_.inputs.size(); ++input) {
    const auto found = known_.find({report.frame, input});
    if (found == known_.end() || !found->second) continue;
    Read& read = *found->second;
    if (read.replaced > 0) report.replaced.push_back({graph_.inputs[input].name, read.item.type(), read.replaced});
    report.read_seconds += read.seconds;
    if (read.item && is_image(read.item.type())) report.inputs.push_back({graph_.inputs[input].name, shape_of(read.item).size});
    taken.items[input] = std::move(read.item);
  }
  known_.erase(known_.begin(), known_.upper_bound({report.frame, graph_.inputs.size()}));
  return taken;
}

}  // namespace quell
