#include "batch_run.h"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <memory>

#include "progress.h"
#include "quell/text/error.h"
#include "shot_process.h"

namespace quell::app {
namespace {

constexpr int kThreadsOfAShot = 4;
constexpr std::size_t kMemoryOfAShot = std::size_t{2} << 30;
constexpr int kPollMilliseconds = 200;  // between looks at how far the shots are

/// SIGINT, SIGTERM and the end of a child, to be read where the batch waits.
class Signals {
 public:
  Signals() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&set, signal);
    sigprocmask(SIG_BLOCK, &set, nullptr);
    descriptor_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
    if (descriptor_ < 0) throw Error(Fault::usage, "", std::string("no signals can be waited for: ") + std::strerror(errno));
  }
  ~Signals() { close(descriptor_); }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Waits a while. How many requests to end came, each as often as it was given.
  int wait() const {
    pollfd wanted{descriptor_, POLLIN, 0};
    if (poll(&wanted, 1, kPollMilliseconds) <= 0) return 0;
    int requests = 0;
    signalfd_siginfo info{};
    while (read(descriptor_, &info, sizeof info) == sizeof info)
      requests += info.ssi_signo == static_cast<std::uint32_t>(SIGCHLD) ? 0 : 1;
    return requests;
  }

 private:
  int descriptor_ = -1;
};

std::string count_text(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// What does not depend on the share, from "run" on.
std::vector<std::string> without_share(std::vector<std::string> words) {
  for (std::size_t i = 0; i + 1 < words.size();)
    if (words[i] == "--threads" || words[i] == "--memory")
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(i), words.begin() + static_cast<std::ptrdiff_t>(i) + 2);
    else
      ++i;
  return words;
}

class Batch {
 public:
  Batch(const std::vector<Shot>& shots, const BatchOptions& options, Console& console)
      : shots_(shots), options_(options), console_(console), results_(shots.size(), ShotResult{.outcome = "not begun"}) {}

  std::vector<ShotResult> run() {
    leave_out_done();
    while (true) {
      start_shots();
      if (running_.empty()) break;
      if (const int requests = signals_.wait(); requests > 0) pass_on(requests);
      for (const auto& shot : running_) follow(*shot);
      std::erase_if(running_, [&](const std::unique_ptr<Running>& shot) { return has_ended(*shot); });
      show_status();
    }
    console_.set_status("");
    if (signals_seen_ > 0)
      for (ShotResult& result : results_)
        if (!result.was_run && result.outcome == "not begun") result.code = kInterrupted;
    return std::move(results_);
  }

 private:
  struct Running {
    Running(std::size_t index_, const ShotFiles& files, const std::vector<std::string>& words)
        : index(index_), events(files.events), process(words, files.log) {}
    std::size_t index;
    int threads = 0;
    std::size_t memory = 0;
    EventReader events;
    ShotProcess process;
  };
  struct Waiting {
    std::size_t index = 0;
    bool alone = false;  ///< its share was too small
  };

  ShotFiles files_of(std::size_t index) const { return {options_.logs, shots_[index].name}; }

  void leave_out_done() {
    for (std::size_t i = 0; i < shots_.size(); ++i) {
      const std::optional<ShotResult> before = options_.resume ? done_before(shots_[i], files_of(i)) : std::nullopt;
      if (before)
        results_[i] = *before, ++through_;
      else
        waiting_.push_back({i});
    }
    if (options_.resume) spdlog::info("{} done before, {} left", count_text(through_, "shot"), waiting_.size());
  }

  void start_shots() {
    while (!waiting_.empty() && !is_stopping_ && running_.size() < static_cast<std::size_t>(options_.budget.jobs)) {
      const Waiting next = waiting_.front();
      if (next.alone && !running_.empty()) return;
      int threads = options_.budget.threads;
      std::size_t memory = options_.budget.memory;
      for (const auto& shot : running_) threads -= shot->threads, memory -= shot->memory;
      // What is free, shared with those that may begin at once; the last ones have more.
      const std::size_t beside = static_cast<std::size_t>(options_.budget.jobs) - running_.size();
      const std::size_t shares = next.alone ? 1 : std::min(beside, waiting_.size());
      threads /= static_cast<int>(shares), memory /= shares;
      if (threads < 1 || memory < 1) return;
      waiting_.pop_front();
      start(next.index, threads, memory);
    }
  }

  void start(std::size_t index, int threads, std::size_t memory) {
    const ShotFiles files = files_of(index);
    std::vector<std::string> words = run_words(shots_[index], files, threads, memory);
    ShotResult& result = results_[index];
    result = ShotResult{.outcome = "failed (not started)", .code = kFramesFailed, .was_run = true};
    try {
      files.begin(words);
      words.insert(words.begin(), "quell");
      running_.push_back(std::make_unique<Running>(index, files, words));
    } catch (const Error& error) {
      spdlog::error("{}: {}", shots_[index].name, error.what());
      ++through_;
      is_stopping_ = is_stopping_ || options_.stop_on_error;
      return;
    }
    running_.back()->threads = threads, running_.back()->memory = memory;
    spdlog::info("{}: begun with {} and {}", shots_[index].name, count_text(static_cast<std::size_t>(threads), "thread"),
                 format_bytes(memory));
  }

  void follow(Running& shot) {
    ShotResult& result = results_[shot.index];
    const std::string& name = shots_[shot.index].name;
    shot.events.read([&](const Json& event) {
      const Json* kind = event.find("event");
      const Json *frame = event.find("frame"), *count = event.find("frame_count"), *ok = event.find("ok");
      if (kind && kind->string == "start" && count) result.frames = count->integer;
      if (!kind || kind->string != "frame" || !frame || !ok) return;
      ++(ok->boolean ? result.done : result.failed);
      ++frames_through_;
      const auto through = static_cast<std::size_t>(result.done + result.failed);
      const auto total = static_cast<std::size_t>(result.frames);
      const Json *seconds = event.find("seconds"), *error = event.find("error");
      if (!ok->boolean)
        spdlog::error("{}: frame {} ({} of {}) failed: {}", name, frame->integer, through, total, error ? error->string : "");
      else if (!console_.is_terminal())
        spdlog::info("{}: {}", name, plain_line(frame->integer, through, total, seconds ? seconds->number : 0));
    });
  }

  bool has_ended(Running& shot) {
    const std::optional<ProcessEnd> end = shot.process.end();
    if (!end) return false;
    follow(shot);  // what it wrote last
    const ShotFiles files = files_of(shot.index);
    if (end->code == kMemory && shot.memory < options_.budget.memory && !is_stopping_) {
      spdlog::info("{}: {} are too little; it is run alone, when the others are through", shots_[shot.index].name,
                   format_bytes(shot.memory));
      results_[shot.index] = ShotResult{.outcome = "not begun"};
      waiting_.push_back({shot.index, true});
      return true;
    }
    finish(shot, *end, read_shot_report(files.report));
    return true;
  }

  void finish(const Running& shot, const ProcessEnd& end, const std::optional<ShotReport>& report) {
    ShotResult& result = results_[shot.index];
    result.seconds = end.seconds, result.peak_bytes = end.peak_bytes;
    if (report && report->frames > 0) result.done = report->done, result.failed = report->failed, result.frames = report->frames;
    result.outcome = outcome_of(end);
    result.code = end.signal == 0 && end.code == kOk ? kOk : end.code == kInterrupted ? kInterrupted : kFramesFailed;
    if (signals_seen_ > 0 && end.signal != 0) result.code = kInterrupted;  // the batch has killed it
    ++through_;
    const std::string sums = std::to_string(through_) + " of " + count_text(shots_.size(), "shot") + " through, " +
                             count_text(frames_through_, "frame");
    const std::string frames =
        std::to_string(result.done) + " of " + std::to_string(result.frames) + " frames in " + format_duration(result.seconds);
    const std::string& name = shots_[shot.index].name;
    if (result.code == kOk) {
      spdlog::info("{}: done, {} ({})", name, frames, sums);
      return;
    }
    spdlog::error("{}: {}, {} ({}){}; {} tells all", name, result.outcome, frames, sums,
                  report && !report->error.empty() ? ":\n" + report->error : "", files_of(shot.index).log.string());
    is_stopping_ = is_stopping_ || options_.stop_on_error;
  }

  static std::string outcome_of(const ProcessEnd& end) {
    if (end.signal != 0) return "killed by signal " + std::to_string(end.signal) + " (" + strsignal(end.signal) + ")";
    if (end.code == kOk) return "done";
    if (end.code == kInterrupted) return "interrupted";
    return end.code == kFramesFailed ? "failed" : "failed (exit code " + std::to_string(end.code) + ")";
  }

  void pass_on(int requests) {
    for (int i = 0; i < requests; ++i) {
      ++signals_seen_;
      if (signals_seen_ == 1) spdlog::warn("stopping; give the signal once more to stop at once");
      if (signals_seen_ <= 2)
        for (const auto& shot : running_) shot->process.send(signals_seen_ == 1 ? SIGTERM : SIGKILL);
    }
    is_stopping_ = true;
  }

  void show_status() {
    if (!spdlog::should_log(spdlog::level::info)) return;
    std::string line =
        std::to_string(through_) + "/" + std::to_string(shots_.size()) + " shots, " + count_text(frames_through_, "frame");
    for (const auto& shot : running_) {
      const ShotResult& result = results_[shot->index];
      line += "  " + shots_[shot->index].name + " " + std::to_string(result.done + result.failed) + "/" +
              std::to_string(result.frames);
    }
    console_.set_status(line.substr(0, static_cast<std::size_t>(std::max(console_.columns() - 1, 1))));
  }

  const std::vector<Shot>& shots_;
  const BatchOptions& options_;
  Console& console_;
  Signals signals_;
  std::vector<ShotResult> results_;
  std::deque<Waiting> waiting_;
  std::vector<std::unique_ptr<Running>> running_;
  std::size_t through_ = 0, frames_through_ = 0;
  int signals_seen_ = 0;
  bool is_stopping_ = false;
};

}  // namespace

int choose_jobs(int wanted, std::size_t shots, int threads, std::size_t memory) {
  if (wanted > threads)
    throw Error(Fault::usage, "--jobs",
                "each shot needs a thread, and there are " + std::to_string(threads) + " for " + std::to_string(wanted) +
                    " shots; state --threads, or fewer jobs");
  if (wanted == 0)
    wanted = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(std::max(1, threads / kThreadsOfAShot)),
                                                    std::max<std::size_t>(1, memory / kMemoryOfAShot)));
  return static_cast<int>(std::min(static_cast<std::size_t>(wanted), std::max<std::size_t>(shots, 1)));
}

std::vector<std::string> run_words(const Shot& shot, const ShotFiles& files, int threads, std::size_t memory) {
  std::vector<std::string> words = command_of(shot.options);
  words.insert(words.end(), {"--threads", std::to_string(threads), "--memory", std::to_string(memory), "--log-json",
                             files.events.string(), "--report", files.report.string()});
  return words;
}

std::optional<ShotResult> done_before(const Shot& shot, const ShotFiles& files) {
  const std::optional<ShotReport> report = read_shot_report(files.report);
  if (!report || report->outcome != "done" || report->exit_code != kOk || report->version != QUELL_VERSION) return std::nullopt;
  if (report->command.empty() || report->folder != std::filesystem::current_path()) return std::nullopt;
  const std::vector<std::string> words = {report->command.begin() + 1, report->command.end()};
  if (without_share(words) != without_share(run_words(shot, files, 1, 1))) return std::nullopt;
  std::error_code error;
  const auto is_there = [&](const std::string& file) { return std::filesystem::exists(file, error); };
  if (!std::ranges::all_of(report->files, is_there)) return std::nullopt;
  return ShotResult{.outcome = "done before", .done = report->done, .failed = report->failed, .frames = report->frames};
}

std::vector<ShotResult> run_batch(const std::vector<Shot>& shots, const BatchOptions& options, Console& console) {
  return Batch(shots, options, console).run();
}

}  // namespace quell::app
