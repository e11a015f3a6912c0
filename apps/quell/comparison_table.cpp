#include "comparison_table.h"

#include <algorithm>
#include <cmath>

#include "figure_text.h"
#include "metric_options.h"
#include "text_layout.h"

namespace quell::app {
namespace {

enum class Side { left, right };

struct Column {
  std::string head, below;
  Side side = Side::right;
  std::vector<std::string> cells = {};
  bool has_marks = false;  ///< the last character of a cell is its mark, or a space
};

std::size_t width_of(const Column& column) {
  std::size_t width = std::max(columns_of(column.head), columns_of(column.below)) + (column.has_marks ? 1 : 0);
  for (const std::string& cell : column.cells) width = std::max(width, columns_of(cell));
  return width;
}

std::string pad(const std::string& text, std::size_t width, Side side) {
  const std::string blanks(width - std::min(width, columns_of(text)), ' ');
  return side == Side::right ? blanks + text : text + blanks;
}

std::string lay_out(const std::vector<Column>& columns) {
  std::vector<std::size_t> widths;
  for (const Column& column : columns) widths.push_back(width_of(column));
  std::string text;
  const auto add_line = [&](const auto& cell_of) {
    std::string line;
    for (std::size_t i = 0; i < columns.size(); ++i)
      line += (i == 0 ? "" : "  ") + pad(cell_of(columns[i]), widths[i], columns[i].side);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  const auto mark_room = [](const Column& column) { return column.has_marks ? std::string(" ") : std::string(); };
  add_line([&](const Column& column) { return column.head + mark_room(column); });
  add_line([&](const Column& column) { return column.below + mark_room(column); });
  for (std::size_t row = 0; row < columns.front().cells.size(); ++row)
    add_line([&](const Column& column) { return column.cells[row]; });
  return text;
}

/// The lines of one frame, or of all.
struct Group {
  std::string name;
  const std::vector<ImageFigures>& images;
};

std::vector<Group> list_groups(const std::vector<ComparedFrame>& frames, const std::vector<ImageFigures>& sums,
                               bool summary_only) {
  std::vector<Group> groups;
  if (!summary_only)
    for (const ComparedFrame& frame : frames)
      if (frame.error.empty()) groups.push_back({std::to_string(frame.frame), frame.images});
  groups.push_back({"all", sums});
  return groups;
}

Column make_metric_column(const std::vector<Metric>& metrics, std::size_t m, const std::vector<Group>& groups, bool has_marks) {
  const MetricInfo& about = info(metrics[m]);
  Column column{std::string(about.name) + (about.unit.empty() ? "" : " " + std::string(about.unit)), better_text(metrics[m])};
  column.has_marks = has_marks;
  std::vector<double> figures;
  for (const Group& group : groups)
    for (const ImageFigures& image : group.images) figures.push_back(value(metrics[m], image.scores[m]));
  const int decimals = decimals_for(metrics[m], figures);
  std::size_t at = 0;
  for (const Group& group : groups) {
    const std::vector<std::vector<bool>> best = find_best(metrics, group.images);
    for (std::size_t i = 0; i < group.images.size(); ++i)
      column.cells.push_back(figure_text(figures[at++], decimals) + (has_marks ? best[i][m] ? "*" : " " : ""));
  }
  return column;
}

/// The label, or its beginning.
std::string shorten(const std::string& label, std::size_t room) {
  if (columns_of(label) <= room) return label;
  std::string text = label;
  while (columns_of(text) + 3 > room && !text.empty()) {
    do text.pop_back();
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0u) == 0x80u);
  }
  return text + "...";
}

std::string make_figures(const ComparisonJob& job, const std::vector<Group>& groups) {
  constexpr std::size_t kShortestLabel = 8;
  const bool has_several = job.images.size() > 1;
  std::vector<Column> columns;
  std::size_t taken = 0;
  for (std::size_t m = 0; m < job.options.metrics.size(); ++m) {
    columns.push_back(make_metric_column(job.options.metrics, m, groups, has_several));
    taken += width_of(columns.back()) + 2;
  }
  Column frames{"frame", ""}, labels{"image", "", Side::left};
  for (const Group& group : groups)
    for (std::size_t i = 0; i < group.images.size(); ++i) frames.cells.push_back(i == 0 ? group.name : "");
  taken += width_of(frames) + 2;
  const std::size_t room = std::max(taken < kColumns ? kColumns - taken : 0, kShortestLabel);
  for (const Group& group : groups)
    for (std::size_t i = 0; i < group.images.size(); ++i) labels.cells.push_back(shorten(job.labels[i], room));
  if (has_several) columns.insert(columns.begin(), labels);
  columns.insert(columns.begin(), frames);
  return lay_out(columns);
}

bool is_about_display(Metric metric) { return metric != Metric::relmse && metric != Metric::smape && metric != Metric::hdr_flip; }

std::string describe_exposures(const Exposures& exposures) {
  return figure_text(exposures.start, 2) + " to " + figure_text(exposures.stop, 2) + " stops, " +
         std::to_string(exposures.count) + " in all";
}

/// What is compared, and how.
std::string describe_job(const ComparisonJob& job) {
  const std::vector<Metric>& metrics = job.options.metrics;
  std::vector<std::pair<std::string, std::string>> lines = {{"reference", job.reference.files()}};
  for (std::size_t i = 0; i < job.images.size(); ++i) lines.emplace_back(job.labels[i], job.images[i].files());
  if (std::ranges::any_of(metrics, is_about_display)) lines.emplace_back("display", describe(info(job.options.display)));
  if (contains(metrics, Metric::hdr_flip) && job.options.exposures)
    lines.emplace_back("exposures", describe_exposures(*job.options.exposures));
  if (contains(metrics, Metric::warped))
    lines.emplace_back("motion", job.motion ? job.motion->files() : "none given: warped takes pixels to stand still");
  std::size_t width = 0;
  for (const auto& [name, text] : lines) width = std::max(width, columns_of(name));
  std::string text;
  for (const auto& [name, line] : lines) text += pad(name, width, Side::left) + "  " + line + "\n";
  return text;
}

}  // namespace

std::vector<std::vector<bool>> find_best(const std::vector<Metric>& metrics, const std::vector<ImageFigures>& images) {
  std::vector<std::vector<bool>> best(images.size(), std::vector<bool>(metrics.size()));
  for (std::size_t m = 0; m < metrics.size(); ++m)
    for (std::size_t i = 0; i < images.size(); ++i) {
      const double own = value(metrics[m], images[i].scores[m]);
      bool beats_one = false, is_beaten = std::isnan(own);
      for (const ImageFigures& other : images) {
        const double theirs = value(metrics[m], other.scores[m]);
        beats_one = beats_one || is_better(metrics[m], own, theirs);
        is_beaten = is_beaten || is_better(metrics[m], theirs, own);
      }
      best[i][m] = beats_one && !is_beaten;
    }
  return best;
}

std::string make_table(const ComparisonJob& job, const std::vector<ComparedFrame>& frames, bool summary_only) {
  const std::vector<ImageFigures> sums = add_up(frames, job.images.size(), job.options.metrics.size());
  return describe_job(job) + "\n" + make_figures(job, list_groups(frames, sums, summary_only));
}

}  // namespace quell::app
