#include "run_log.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "json_lines.h"
#include "quell/sdk/abi.h"
#include "run_record.h"
#include "run_report.h"

namespace quell::app {
namespace {

std::string_view name_of_level(int level) {
  if (level >= QUELL_LOG_WARNING) return "warning";
  return level >= QUELL_LOG_INFO ? "info" : "debug";
}

class MessageSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit MessageSink(RunLog& log) : log_(log) { set_level(spdlog::level::warn); }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    log_.message(message.level == spdlog::level::warn ? "warning" : "error", {message.payload.data(), message.payload.size()});
  }
  void flush_() override {}
  RunLog& log_;
};

std::filesystem::path full_path(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
  return error ? file : full;
}

}  // namespace

struct RunLog::State {
  explicit State(const RunLogFiles& named) : files(named) {
    if (files.lines) lines.emplace(*files.lines, "--log-json");
    if (files.report) report.emplace(*files.report);
  }
  void end(const JsonObject& record, ExitCode code) {
    if (lines) {
      lines->write("end", JsonObject(record).number("exit_code", static_cast<int>(code)));
      if (!lines->ok()) spdlog::error("--log-json: {} could not be written", files.lines->string());
    }
    if (report && !report->end(record, code)) is_reported = false;
  }
  RunLogFiles files;
  std::optional<JsonLines> lines;
  std::optional<RunReport> report;
  bool is_reported = true;  // as far as it was to be
  std::shared_ptr<MessageSink> sink;
};

RunLog::RunLog(const RunLogFiles& files) {
  if (!files.lines && !files.report) return;
  if (files.lines) refuse_to_replace_others(*files.lines, R"({"event":")", "--log-json");
  if (files.lines && files.report && full_path(*files.lines) == full_path(*files.report))
    throw Error(Fault::usage, "--report", files.report->string() + " is the file of --log-json, too; choose another name");
  state_ = std::make_unique<State>(files);
  state_->sink = std::make_shared<MessageSink>(*this);
  spdlog::default_logger()->sinks().push_back(state_->sink);
}

RunLog::~RunLog() {
  if (state_) std::erase(spdlog::default_logger()->sinks(), state_->sink);
}

bool RunLog::ok() const { return !state_ || ((!state_->lines || state_->lines->ok()) && state_->is_reported); }

void RunLog::resume(const PastFrames& past) {
  if (state_ && state_->report) state_->report->resume(past);
}

void RunLog::start(const Job& job, const std::vector<ResultFiles>& results, const SessionOptions& options, const Window& window) {
  if (!state_) return;
  const JsonObject record = record_start(job, results, options, window);
  if (state_->lines) state_->lines->write("start", record);
  if (state_->report) state_->report->start(job, results, record);
}

void RunLog::frame(const FrameReport& report, const Plan& plan, const BufferPool::Usage& usage,
                   const std::vector<MeasuredOutput>& measured, const std::vector<Metric>& metrics) {
  if (!state_) return;
  const JsonObject record = record_frame(report, plan, usage, measured, metrics);
  if (state_->lines) state_->lines->write("frame", record);
  if (state_->report) state_->report->frame(report, plan, record);
}

void RunLog::message(int level, std::string_view text) { message(name_of_level(level), text); }

void RunLog::message(std::string_view level, std::string_view text) {
  if (!state_) return;
  const JsonObject record = JsonObject().text("level", level).text("text", text);
  if (state_->lines) state_->lines->write("message", record);
  if (state_->report) state_->report->message(record);
}

void RunLog::end(const RunOutcome& outcome, ExitCode code) {
  if (state_) state_->end(record_end(outcome), code);
}

void RunLog::end(std::string_view error, ExitCode code) {
  if (state_) state_->end(record_end(error), code);
}

}  // namespace quell::app
