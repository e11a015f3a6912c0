// What a report tells of a graph: its nodes, how it went, and what it is worth.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "report_data.h"

namespace quell::app {

template <class Range, class Make>
Json list(const Range& range, const Make& make) {
  std::vector<Json> elements;
  for (const auto& element : range) elements.push_back(make(element));
  return make_json(std::move(elements));
}

template <class Range>
Json numbers(const Range& range) {
  return list(range, [](const auto& value) { return make_json(value); });
}

/// Figures of each output by name: of every frame, null where there are none, and of all; "inf" where they are infinite.
Json figures_json(const std::vector<MeasuredOutput>& totals, const std::map<std::int64_t, std::vector<MeasuredOutput>>& measured,
                  const Report& report);

Json graph_json(const ReportedGraph& graph, const Report& report);

}  // namespace quell::app
