#include "quell/runtime/scheduler.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "quell/runtime/failure.h"

namespace quell {
namespace {

using namespace std::chrono_literals;
constexpr auto kBetweenQuestions = 5ms;  // how often the caller is asked whether the run is cancelled
constexpr int kMostFileThreads = 17;     // beyond it, drives and memory are what is waited for

// One more than threads, so that one may wait for a drive while the others have work.
int file_threads(std::uint32_t threads) { return std::min(static_cast<int>(threads) + 1, kMostFileThreads); }

}  // namespace

Scheduler::Scheduler(SessionState& session, const RunFrames& frames, FrameSource& source, FrameSink& sink)
    : session_(session),
      run_(frames),
      frames_(frames.computed),
      source_(source),
      sink_(sink),
      reading_counts_(source.uses_processor()),
      writing_counts_(sink.uses_processor()),
      reader_(*session.graph, source, frames, session.pool, session.options.trace),
      flight_(frames.computed),
      end_(frames.computed.size()) {
  flight_.use(*session.running, session.window, static_cast<int>(session.executor.slots()));
  in_flight_.resize(flight_.places());
}

std::vector<FrameReport> Scheduler::run() {
  try {
    session_.executor.budget().on_free([this] {
      const Lock lock(mutex_);
      start_drivers(flight_.ready());
    });
    for (int i = 0; i < file_threads(session_.executor.slots()); ++i) file_threads_.emplace_back([this] { serve_files(); });
    Lock lock(mutex_);
    advance();
    wait_until_finished(lock);
    if (failure_) std::rethrow_exception(failure_);
    collect_rest();
    tell_reports(lock);
  } catch (...) {  // from the session's callbacks
    shut_down();
    throw;
  }
  shut_down();
  return std::move(reports_);
}

// ---- the caller ----

void Scheduler::wait_until_finished(Lock& lock) {
  while (!is_finished()) {
    const auto is_awaited = [&] { return is_finished() || told_ < reports_.size(); };
    if (session_.options.cancelled) {
      caller_wakes_.wait_for(lock, kBetweenQuestions, is_awaited);
      lock.unlock();
      const bool cancelled = session_.cancelled();
      lock.lock();
      stopped_ = stopped_ || cancelled;
    } else {
      caller_wakes_.wait(lock, is_awaited);
    }
    tell_reports(lock);
  }
}

void Scheduler::tell_reports(Lock& lock) {
  while (told_ < reports_.size()) {
    const FrameReport report = reports_[told_++];  // a copy: more may be added meanwhile
    if (!session_.options.on_frame) continue;
    lock.unlock();
    session_.options.on_frame(report);
    lock.lock();
  }
}

bool Scheduler::is_finished() const {
  if (drivers_ > 0 || busy_file_threads_ > 0) return false;
  return stopped_ || flight_.retired() >= end_;
}

// What unfinished frames leave is void.
void Scheduler::shut_down() {
  {
    Lock lock(mutex_);
    stopped_ = closing_ = true;
    caller_wakes_.wait(lock, [&] { return drivers_ == 0 && busy_file_threads_ == 0; });
  }
  files_wake_.notify_all();
  file_threads_.clear();
  session_.executor.budget().on_free({});
  for (std::size_t index = flight_.retired(); index < flight_.begun(); ++index) lane(index).clear();
  if (flight_.retired() < frames_.size()) session_.running->history.forget_from(frames_[flight_.retired()]);
}

// Of a run that was cut short, frames that were written before an earlier one count, too.
void Scheduler::collect_rest() {
  stopped_ = true;
  for (std::size_t index = flight_.retired(); index < std::min(flight_.admitted(), end_); ++index)
    if (frame(index).phase == Phase::ended) reports_.push_back(std::move(frame(index).report));
}

// ---- drivers ----

// A driver that will look for the next node itself is counted by its caller.
void Scheduler::start_drivers(std::size_t nodes) {
  while (!stopped_ && idle_drivers_ < nodes && session_.executor.budget().try_take(true)) {
    ++idle_drivers_, ++drivers_;
    session_.executor.spawn(drive_);
  }
}

void Scheduler::drive() {
  Lock lock(mutex_);
  --idle_drivers_;
  try {
    compute_nodes(lock);
  } catch (...) { fail(lock); }
  lock.unlock();
  session_.executor.budget().give_back();
  lock.lock();
  --drivers_;
  if (drivers_ == 0) caller_wakes_.notify_all();
}

void Scheduler::compute_nodes(Lock& lock) {
  while (!stopped_) {
    if (session_.executor.budget().is_wanted()) return start_drivers(flight_.ready());  // when there is room again
    const std::optional<FrameStep> node = flight_.take();
    if (!node) return;
    compute(*node, lock);
    if (const std::size_t more = flight_.ready(); more > 1) start_drivers(more - 1);
  }
}

void Scheduler::compute(const FrameStep& node, Lock& lock) {
  Lane& at = lane(node.index);
  if (node.index >= end_ || !is_wanted(node) || at.is_lost(node.step)) {
    at.skip(node.step);
  } else {
    at.fetch(node.step);
    lock.unlock();
    bool cancelled = false;
    try {
      at.run(node.step);
    } catch (const Cancelled&) { cancelled = true; }
    lock.lock();
    if (cancelled) {
      stopped_ = true;
      return;
    }
    at.publish(node.step);
  }
  const bool last = flight_.complete(node);
  if (last) end_computation(node.index);
  if (last || flight_.may_admit()) advance();
}

// ---- file threads ----

void Scheduler::serve_files() {
  Lock lock(mutex_);
  while (true) {
    files_wake_.wait(lock, [&] { return closing_ || can_read() || next_write(); });
    if (closing_) return;
    ++busy_file_threads_;
    try {
      serve_one(lock);
      advance();
    } catch (...) { fail(lock); }
    --busy_file_threads_;
    if (is_finished()) caller_wakes_.notify_all();
  }
}

void Scheduler::serve_one(Lock& lock) {
  if (const auto index = next_write())  // first, because it makes room
    write_one(*index, lock);
  else
    read_one(lock);
}

bool Scheduler::can_read() { return !stopped_ && flight_.retired() < end_ && reader_.has_next(); }

std::optional<std::size_t> Scheduler::next_write() {
  if (stopped_) return std::nullopt;
  for (std::size_t index = flight_.retired(); index < std::min(flight_.begun(), end_); ++index) {
    if (frame(index).phase == Phase::computed) return index;
    if (session_.ends_with_failure()) break;  // an earlier one may still fail
  }
  return std::nullopt;
}

void Scheduler::read_one(Lock& lock) {
  const InputReader::Key key = *reader_.next();
  lock.unlock();
  if (reading_counts_) session_.executor.budget().take();
  InputReader::Read read = reader_.read(key, alone_);
  if (reading_counts_) session_.executor.budget().give_back();
  lock.lock();
  reader_.put(key, std::move(read));
}

void Scheduler::write_one(std::size_t index, Lock& lock) {
  Frame& written = frame(index);
  Lane& at = lane(index);
  written.phase = Phase::writing;
  lock.unlock();
  if (writing_counts_) session_.executor.budget().take();
  write_results(written.report, at, session_.running->wiring, sink_, session_.pool, session_.options.trace);
  if (writing_counts_) session_.executor.budget().give_back();
  lock.lock();
  end_frame(index);
}

// ---- what an event makes possible ----

void Scheduler::advance() {
  while (retire_next() || admit_next() || begin_next()) {}
  start_drivers(flight_.ready());
  if (can_read() || next_write()) files_wake_.notify_all();
  if (is_finished() || told_ < reports_.size()) caller_wakes_.notify_all();
}

bool Scheduler::admit_next() {
  if (stopped_ || flight_.admitted() >= end_ || !flight_.may_admit()) return false;
  const std::size_t index = flight_.admitted();
  flight_.admit();
  frame(index) = {Phase::reading, {}, Trace::Clock::now()};
  frame(index).report.frame = frames_[index];
  frame(index).report.history_only = run_.is_history_only(frames_[index]);
  reader_.want(frames_[index], *session_.running);
  return true;
}

bool Scheduler::begin_next() {
  const std::size_t index = flight_.begun();
  if (stopped_ || index >= std::min(flight_.admitted(), end_) || !reader_.is_ready(frames_[index], *session_.running))
    return false;
  frame(index).report.error = reader_.error(frames_[index]);
  if (frame(index).report.error.empty()) {
    const InputShapes shapes = reader_.shapes(frames_[index], session_.planned_for);
    if (session_.needs_plan(shapes)) {
      if (flight_.retired() < index) return false;  // frames of the former size must be through
      if (plan_anew(shapes)) return true;
    }
  }
  FrameReport& report = frame(index).report;
  report.ok = report.computed = report.error.empty();
  FrameInputs inputs = reader_.take(report, *session_.running);
  if (report.ok) lane(index).begin(frames_[index], std::move(inputs));
  flight_.begin(report.ok);
  frame(index).phase = Phase::computing;
  if (!report.ok)
    end_frame(index);
  else if (session_.running->wiring.steps.empty())
    end_computation(index);
  return true;
}

// True when it succeeded; the frame has not begun yet.
bool Scheduler::plan_anew(const InputShapes& shapes) {
  const std::size_t first = flight_.begun();
  try {
    session_.plan_for(shapes);
  } catch (...) {
    frame(first).report.error = what_failed(session_.pool);
    return false;
  }
  std::vector<Frame> waiting;
  for (std::size_t index = first; index < flight_.admitted(); ++index) waiting.push_back(std::move(frame(index)));
  flight_.use(*session_.running, session_.window, static_cast<int>(session_.executor.slots()));
  in_flight_.clear();
  in_flight_.resize(flight_.places());
  if (flight_.admitted() < end_) reader_.forget_from(frames_[flight_.admitted()]);
  for (std::size_t index = first; index < flight_.admitted(); ++index) {
    frame(index) = std::move(waiting[index - first]);
    reader_.want(frames_[index], *session_.running);
  }
  return true;
}

void Scheduler::end_computation(std::size_t index) {
  frame(index).phase = Phase::computed;
  lane(index).drop_ahead();
  report_nodes(frame(index).report, lane(index));
  if (frame(index).report.ok && !frame(index).report.history_only)
    flight_.hold(index, true);
  else
    end_frame(index);
}

void Scheduler::end_frame(std::size_t index) {
  Frame& ended = frame(index);
  ended.phase = Phase::ended;
  ended.report.seconds = std::chrono::duration<double>(Trace::Clock::now() - ended.start).count();
  if (!ended.report.ok && session_.ends_with_failure()) end_ = std::min(end_, index + 1);
  lane(index).clear();
  flight_.hold(index, false);
}

void Scheduler::fail(Lock& lock) {
  if (!lock.owns_lock()) lock.lock();
  if (!failure_) failure_ = std::current_exception();
  stopped_ = true;
}

bool Scheduler::retire_next() {
  const std::size_t index = flight_.retired();
  if (index >= std::min(flight_.begun(), end_) || frame(index).phase != Phase::ended) return false;
  session_.finish(frame(index).report);
  reports_.push_back(std::move(frame(index).report));
  flight_.retire();
  return true;
}

}  // namespace quell
