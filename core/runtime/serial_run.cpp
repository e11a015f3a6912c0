#include "quell/runtime/serial_run.h"

#include <utility>

#include "quell/runtime/failure.h"
#include "quell/runtime/input_reader.h"
#include "quell/runtime/single_frame.h"

namespace quell {
namespace {

class SerialRun {
 public:
  SerialRun(SessionState& session, const RunFrames& frames, FrameSource& source, FrameSink& sink)
      : session_(session),
        run_(frames),
        reader_(*session.graph, source, frames, session.pool, session.options.trace),
        sink_(sink) {}

  FrameReport run(std::int64_t frame) {
    FrameReport report;
    report.frame = frame;
    report.history_only = run_.is_history_only(frame);
    const auto start = Trace::Clock::now();
    try {
      read(frame);
      report.error = reader_.error(frame);
    } catch (...) { report.error = what_failed(session_.pool); }
    report.ok = report.computed = report.error.empty();
    FrameInputs inputs = reader_.take(report, *session_.running);
    if (report.ok) compute(report, std::move(inputs));
    session_.finish(report);
    report.seconds = std::chrono::duration<double>(Trace::Clock::now() - start).count();
    return report;
  }

 private:
  void read(std::int64_t frame) {
    while (true) {
      reader_.want(frame, *session_.running);
      while (const auto key = reader_.next()) reader_.put(*key, reader_.read(*key, session_.executor));
      const InputShapes shapes = reader_.shapes(frame, session_.planned_for);
      if (!reader_.error(frame).empty() || !session_.needs_plan(shapes)) return;
      session_.plan_for(shapes);
    }
  }

  void compute(FrameReport& report, FrameInputs inputs) {
    Lane& lane = session_.lane(0);
    lane.begin(report.frame, std::move(inputs));
    compute_steps(lane, *session_.running, report.history_only);
    report_nodes(report, lane);
    if (report.ok && !report.history_only)
      write_results(report, lane, session_.running->wiring, sink_, session_.pool, session_.options.trace);
    lane.clear();
  }

  SessionState& session_;
  RunFrames run_;
  InputReader reader_;
  FrameSink& sink_;
};

}  // namespace

std::vector<FrameReport> run_serially(SessionState& session, const RunFrames& frames, FrameSource& source, FrameSink& sink) {
  SerialRun serial(session, frames, source, sink);
  std::vector<FrameReport> reports;
  for (const std::int64_t frame : frames.computed) {
    if (session.cancelled()) break;
    try {
      reports.push_back(serial.run(frame));
    } catch (const Cancelled&) {
      session.lane(0).clear();
      session.running->history.forget_from(frame);
      break;
    }
    if (session.options.on_frame) session.options.on_frame(reports.back());
    if (session.ends_with_failure() && !reports.back().ok) break;
  }
  return reports;
}

}  // namespace quell
