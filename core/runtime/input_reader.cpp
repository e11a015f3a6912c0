#include "quell/runtime/input_reader.h"

namespace quell {

InputReader::Read InputReader::read_one(const std::string& name, std::int64_t frame) {
  Read read{source_.read(name, frame, pool_), 0};
  if (!read.item) throw Error(Fault::input, name, "the source has nothing for frame " + std::to_string(frame));
  read.replaced = sanitize(read.item, executor_, pool_);
  return read;
}

std::vector<Item> InputReader::read(std::int64_t frame, const Plan& plan, std::vector<ReplacedValues>& replaced) {
  const auto& inputs = plan.graph->inputs;
  std::vector<Item> items(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (!plan.input_used[i]) continue;
    const auto early = ahead_.find({i, frame});
    Read read = early != ahead_.end() ? std::move(early->second) : read_one(inputs[i].name, frame);
    if (early != ahead_.end()) ahead_.erase(early);
    if (read.replaced > 0) replaced.push_back({inputs[i].name, read.item.type(), read.replaced});
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
