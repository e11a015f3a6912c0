#include "node_times.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "progress.h"

namespace quell::app {
namespace {

constexpr std::size_t kMostNodes = 20;

struct Row {
  std::string name;
  double seconds = 0;
  int frames = 0;  // in which it ran

  void add(double time) {
    seconds += time;
    frames += time > 0 ? 1 : 0;
  }
};

std::vector<Row> add_up_nodes(const Plan& plan, const std::vector<FrameReport>& reports) {
  std::vector<Row> rows;
  for (const PlannedNode& planned : plan.nodes) rows.push_back({plan.graph->nodes[static_cast<std::size_t>(planned.node)].name});
  for (const FrameReport& report : reports)
    if (report.node_seconds.size() == rows.size())
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].add(report.node_seconds[i]);
  return rows;
}

double sum(const std::vector<Row>& rows) {
  double seconds = 0;
  for (const Row& row : rows) seconds += row.seconds;
  return seconds;
}

/// "0.42 ms", "38.6 ms", "1250 ms"
std::string format_milliseconds(double seconds) {
  const double value = seconds * 1000;
  return fmt::format("{:.{}f} ms", value, value < 9.995 ? 2 : value < 99.95 ? 1 : 0);
}

std::string format_line(const Row& row, std::size_t width, const std::string& share = "") {
  const double mean = row.frames > 0 ? row.seconds / row.frames : 0;
  std::string line =
      fmt::format("\n  {:<{}}  {:>12}  {:>8}", row.name, width, format_duration(row.seconds), format_milliseconds(mean));
  return share.empty() ? line : line + fmt::format("  {:>5}", share);
}

}  // namespace

std::string time_table(const Plan& plan, const std::vector<FrameReport>& reports, double seconds) {
  std::vector<Row> nodes = add_up_nodes(plan, reports);
  std::erase_if(nodes, [](const Row& row) { return row.frames == 0; });  // kept from an earlier run, or never reached
  const double in_nodes = sum(nodes);
  if (in_nodes <= 0) return "";
  std::stable_sort(nodes.begin(), nodes.end(), [](const Row& a, const Row& b) { return a.seconds > b.seconds; });
  const std::size_t left_out = nodes.size() - std::min(nodes.size(), kMostNodes);
  nodes.resize(nodes.size() - left_out);
  std::vector<Row> files = {{"reading files"}, {"writing files"}};
  for (const FrameReport& report : reports) files[0].add(report.read_seconds), files[1].add(report.write_seconds);
  const double work = in_nodes + sum(files);
  std::erase_if(files, [](const Row& row) { return row.seconds <= 0; });

  std::size_t width = 0;
  for (const std::vector<Row>& rows : {nodes, files})
    for (const Row& row : rows) width = std::max(width, row.name.size());
  std::string text = "time of all frames added up";
  if (work > seconds) text += ", " + format_duration(work) + " of work in " + format_duration(seconds);
  text += fmt::format(":\n  {:<{}}  {:>12}  {:>8}  {:>5}", "", width, "total", "a frame", "share");
  for (const Row& row : nodes) text += format_line(row, width, fmt::format("{:.0f}%", 100 * row.seconds / in_nodes));
  if (left_out > 0) text += "\n  and " + std::to_string(left_out) + " more";
  for (const Row& row : files) text += format_line(row, width);
  return text;
}

}  // namespace quell::app
