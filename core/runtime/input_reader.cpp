#include "quell/runtime/input_reader.h"

#include "quell/runtime/sanitize.h"

namespace quell {

std::string sanitize_input(const std::string& name, Item& item, Executor& executor, BufferPool& pool) {
  const std::int64_t replaced = sanitize(item, executor, pool);
  if (replaced == 0) return {};
  const char* by = item.type() == QUELL_TYPE_DEPTH ? "1e10 (no surface)" : "0";
  return name + ": " + std::to_string(replaced) + (replaced == 1 ? " value was" : " values were") +
         " NaN or infinite and count as " + by;
}

InputReader::Read InputReader::read_one(const std::string& name, std::int64_t frame) {
  Read read{source_.read(name, frame, pool_), {}};
  if (!read.item) throw Error(Fault::input, name, "the source has nothing for frame " + std::to_string(frame));
  read.warning = sanitize_input(name, read.item, executor_, pool_);
  return read;
}

std::vector<Item> InputReader::read(std::int64_t frame, const Plan& plan, std::vector<std::string>& warnings) {
  const auto& inputs = plan.graph->inputs;
  std::vector<Item> items(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (!plan.input_used[i]) continue;
    const auto early = ahead_.find({i, frame});
    Read read = early != ahead_.end() ? std::move(early->second) : read_one(inputs[i].name, frame);
    if (early != ahead_.end()) ahead_.erase(early);
    if (!read.warning.empty()) warnings.push_back(read.warning);
    items[i] = std::move(read.item);
  }
  return items;
}

Item InputReader::read_ahead(std::size_t input, std::int64_t frame, const Plan& plan) {
  if (!frames_.contains(frame)) return {};
  const auto key = std::pair(input, frame);
  if (const auto known = ahead_.find(key); known != ahead_.end()) return known->second.item;
  try {
    return ahead_.emplace(key, read_one(plan.graph->inputs[input].name, frame)).first->second.item;
  } catch (const Error&) { return {}; }
}

void InputReader::advance(std::int64_t frame) {
  std::erase_if(ahead_, [&](const auto& entry) { return entry.first.second <= frame; });
}

}  // namespace quell
