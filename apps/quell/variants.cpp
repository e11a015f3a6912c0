#include "variants.h"

#include <algorithm>

#include "console.h"

namespace quell::app {
namespace {

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::string describe_computed(const RerunReport& report) {
  const std::string total = std::to_string(report.frames.size());
  std::vector<std::pair<int, std::vector<std::string>>> groups;  // nodes that ran equally often
  for (std::size_t i = 0; i < report.nodes.size(); ++i) {
    const auto same = [&](const auto& group) { return group.first == report.computed[i]; };
    auto group = std::ranges::find_if(groups, same);
    if (group == groups.end()) group = groups.insert(groups.end(), {report.computed[i], {}});
    group->second.push_back(report.nodes[i]);
  }
  std::ranges::stable_partition(groups, [](const auto& group) { return group.first > 0; });
  std::string text;
  for (const auto& [count, nodes] : groups)
    text += (text.empty() ? "" : "; ") + list(nodes) +
            (count == 0 ? ": kept" : ": " + std::to_string(count) + " of " + total + " frames");
  return text;
}

void tell_computed(const RerunReport& report, bool is_first) {
  if (!report.all_anew.empty()) spdlog::info("all is computed, because {}", report.all_anew);
  if (!is_first && report.results.empty()) spdlog::info("nothing that is written has changed");
  if (!is_first && !report.results.empty()) spdlog::info(describe_computed(report));
  if (!report.no_room.empty())
    spdlog::info("memory has no room to keep {}; with more --memory, less is computed after a change", list(report.no_room));
}

void tell_left_files(const std::vector<ResultFiles>& before, const std::vector<ResultFiles>& now) {
  for (const ResultFiles& series : before) {
    const auto is_it = [&](const ResultFiles& other) { return other.pattern == series.pattern; };
    if (std::ranges::none_of(now, is_it))
      spdlog::info("the graph has no '{}' any more; {} is left as it is", series.result, series.pattern);
  }
}

std::vector<ResultFiles> select_results(const std::vector<ResultFiles>& all, const RerunReport& report) {
  std::vector<ResultFiles> selected;
  for (const ResultFiles& series : all)
    if (std::ranges::find(report.results, series.result) != report.results.end()) selected.push_back(series);
  return selected;
}

bool same_inputs(const Graph& a, const Graph& b) {
  const auto same = [](const GraphInput& x, const GraphInput& y) { return x.name == y.name && x.type == y.type; };
  return std::ranges::equal(a.inputs, b.inputs, same);
}

bool same_files(const Job& a, const Job& b) {
  return std::ranges::all_of(a.inputs, [&](const InputFiles& files) {
    const auto other = std::ranges::find(b.inputs, files.input, &InputFiles::input);
    return other == b.inputs.end() || other->pattern == files.pattern;
  });
}

}  // namespace quell::app
