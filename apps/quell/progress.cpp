#include "progress.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quell::app {
namespace {

std::string fixed(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string two_digits(std::int64_t value) { return (value < 10 ? "0" : "") + std::to_string(value); }

std::string bar(std::size_t done, std::size_t total, std::size_t width) {
  const std::size_t full = total == 0 ? width : width * std::min(done, total) / total;
  return "[" + std::string(full, '#') + std::string(width - full, ' ') + "]";
}

}  // namespace

std::string format_duration(double seconds) {
  seconds = std::max(seconds, 0.0);
  if (seconds < 0.995) return fixed(seconds, 2) + " s";
  if (seconds < 9.95) return fixed(seconds, 1) + " s";
  const std::int64_t whole = std::llround(std::min(seconds, 1e12));
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + two_digits(whole % 60) + " s";
  const std::int64_t minutes = (whole + 30) / 60;
  return std::to_string(minutes / 60) + " h " + two_digits(minutes % 60) + " min";
}

std::string format_bytes(std::size_t bytes) {
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  constexpr std::array units{"KiB", "MiB", "GiB", "TiB"};
  double value = static_cast<double>(bytes) / 1024;
  std::size_t unit = 0;
  for (; value >= 999.5 && unit + 1 < units.size(); ++unit) value /= 1024;
  return fixed(value, value < 9.95 ? 1 : 0) + " " + units[unit];
}

std::string format_rate(double rate) { return fixed(rate, rate < 0.995 ? 2 : rate < 9.95 ? 1 : 0); }

std::string plain_line(std::int64_t frame, std::size_t done, std::size_t total, double seconds) {
  return "frame " + std::to_string(frame) + " (" + std::to_string(done) + " of " + std::to_string(total) +
         "): " + format_duration(seconds);
}

std::string progress_line(const ProgressState& state, int columns) {
  std::string text = std::to_string(state.done) + "/" + std::to_string(state.total);
  if (state.done > 0) {
    text += "  frame " + std::to_string(state.frame);
    const double rate = state.seconds > 0 ? static_cast<double>(state.done) / state.seconds : 0;
    if (rate > 0) text += "  " + format_rate(rate) + " frames/s";
    if (rate > 0 && state.done < state.total)
      text += "  " + format_duration(static_cast<double>(state.total - state.done) / rate) + " left";
    if (state.bytes > 0) text += "  " + format_bytes(state.bytes);
  }
  // A full last column would make some terminals begin a new line.
  const int room = std::max(columns - 1, 1);
  const int bar_width = std::min(room - static_cast<int>(text.size()) - 4, 30);  // 4 for brackets and spaces
  if (bar_width < 5) return text.substr(0, static_cast<std::size_t>(room));
  return bar(state.done, state.total, static_cast<std::size_t>(bar_width)) + "  " + text;
}

Progress::Progress(Console& console, std::size_t total) : console_(console), start_(std::chrono::steady_clock::now()) {
  state_.total = total;
  draw();
}

Progress::~Progress() { console_.set_status(""); }

double Progress::seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

void Progress::frame_done(const FrameReport& report, std::size_t bytes, const std::string& figures) {
  ++state_.done;
  state_.frame = report.frame;
  state_.bytes = bytes;
  if (!report.ok)
    spdlog::error("frame {}{} ({} of {}) failed: {}", report.frame, report.history_only ? ", of the pre-roll," : "", state_.done,
                  state_.total, report.error);
  else if (!console_.is_terminal() || !figures.empty())
    spdlog::info(plain_line(report.frame, state_.done, state_.total, report.seconds) + figures);
  draw();
}

void Progress::draw() {
  if (!spdlog::should_log(spdlog::level::info)) return;
  state_.seconds = seconds();
  console_.set_status(progress_line(state_, console_.columns()));
}

}  // namespace quell::app
