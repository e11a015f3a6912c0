// How far a run is: one line redrawn on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "console.h"
#include "quell/runtime/session.h"

namespace quell::app {

/// What a progress line tells.
struct ProgressState {
  std::size_t done = 0;    ///< frames computed, those that failed included
  std::size_t total = 0;   ///< frames of the run
  std::int64_t frame = 0;  ///< the latest one; meaningless while done is 0
  double seconds = 0;      ///< since the start
  std::size_t bytes = 0;   ///< held by images; 0: nobody counts them
};

/// "[######      ]  4/12  frame 3  1.2 frames/s  7 s left  250 MiB", shorter than `columns`: the bar gives way first.
std::string progress_line(const ProgressState& state, int columns);
/// "frame 3 (4 of 12): 0.81 s"
std::string plain_line(std::int64_t frame, std::size_t done, std::size_t total, double seconds);

/// "0.81 s", "9.3 s", "42 s", "3 min 20 s", "2 h 05 min".
std::string format_duration(double seconds);
/// "640 bytes", "12 KiB", "3.4 MiB", "120 MiB", "1.5 GiB".
std::string format_bytes(std::size_t bytes);
/// "0.25", "1.2", "37": two digits that matter.
std::string format_rate(double rate);

/// Shows the progress of one run. Quiet when the log's level is above info.
class Progress {
 public:
  Progress(Console& console, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Tells the frame's result; a failed one by its reason, in every verbosity. Figures of a frame stand behind it, on a terminal,
  /// too, where its line is left out otherwise.
  void frame_done(const FrameReport& report, std::size_t bytes, const std::string& figures = "");
  /// No frame is done: all are computed again.
  void restart() { state_.done = 0; }
  double seconds() const;

 private:
  void draw();
  Console& console_;
  ProgressState state_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace quell::app
