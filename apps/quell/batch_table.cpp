#include <array>
#include <string>
#include <vector>

#include "batch_run.h"
#include "progress.h"
#include "text_layout.h"

namespace quell::app {
namespace {

constexpr std::size_t kColumnCount = 6;
using Row = std::array<std::string, kColumnCount>;

Row row_of(const std::string& name, const ShotResult& result) {
  const bool is_known = result.was_run || result.frames > 0;
  return {name,
          is_known ? std::to_string(result.done) + "/" + std::to_string(result.frames) : "-",
          is_known ? std::to_string(result.failed) : "-",
          result.was_run ? format_duration(result.seconds) : "-",
          result.was_run ? format_bytes(result.peak_bytes) : "-",
          result.outcome};
}

/// Names and outcomes stand at the left of their columns, numbers at the right.
std::string lay_out(const std::vector<Row>& rows) {
  std::array<std::size_t, kColumnCount> widths{};
  for (const Row& row : rows)
    for (std::size_t i = 0; i < kColumnCount; ++i) widths[i] = std::max(widths[i], columns_of(row[i]));
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kColumnCount; ++i) {
      const std::string room(widths[i] - columns_of(row[i]), ' ');
      const bool is_last = i + 1 == kColumnCount;
      text += (i > 0 ? "  " : "") + (i == 0 ? row[i] + room : is_last ? row[i] : room + row[i]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string describe(const std::vector<Shot>& shots, const std::vector<ShotResult>& results) {
  std::vector<Row> rows = {{"shot", "frames", "failed", "time", "memory", "outcome"}};
  ShotResult sum;
  std::size_t done = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    rows.push_back(row_of(shots[i].name, results[i]));
    sum.done += results[i].done, sum.failed += results[i].failed, sum.frames += results[i].frames;
    sum.was_run = sum.was_run || results[i].was_run;
    sum.seconds += results[i].seconds, sum.peak_bytes = std::max(sum.peak_bytes, results[i].peak_bytes);
    done += results[i].code == kOk && results[i].outcome != "not begun" ? 1 : 0;
  }
  sum.outcome = std::to_string(done) + " of " + std::to_string(shots.size()) + " shots done";
  rows.push_back(row_of("all", sum));
  return lay_out(rows);
}

}  // namespace quell::app
