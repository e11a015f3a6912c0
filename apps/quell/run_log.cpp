#include "run_log.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "json_lines.h"
#include "quell/graph/graph_hash.h"
#include "quell/sdk/abi.h"
#include "quell/simd/isa.h"
#include "run_options.h"

namespace quell::app {
namespace {

std::string_view name_of_level(int level) {
  if (level >= QUELL_LOG_WARNING) return "warning";
  return level >= QUELL_LOG_INFO ? "info" : "debug";
}

std::string_view name_of(Ending ending) {
  switch (ending) {
    case Ending::done:
      return "done";
    case Ending::failed:
      return "failed";
    case Ending::stopped:
      return "stopped";
    case Ending::interrupted:
      return "interrupted";
  }
  return "";
}

/// "" for no frames, so that it can be tested, and else handed to --frames.
std::string range(const std::vector<std::int64_t>& frames) { return frames.empty() ? "" : FrameRange(frames).text(); }

void write_message(JsonLines& lines, std::string_view level, std::string_view text) {
  lines.write("message", JsonObject().text("level", level).text("text", text));
}

/// By output, by metric.
JsonObject figures(const std::vector<MeasuredOutput>& measured, const std::vector<Metric>& metrics) {
  JsonObject outputs;
  for (const MeasuredOutput& output : measured) {
    JsonObject values;
    for (std::size_t i = 0; i < metrics.size(); ++i)
      values.value(info(metrics[i]).name, quell::value(metrics[i], output.scores[i]));
    outputs.object(output.output, values.number("nonfinite", output.bad_pixels));
  }
  return outputs;
}

class MessageSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit MessageSink(JsonLines& lines) : lines_(lines) { set_level(spdlog::level::warn); }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    write_message(lines_, message.level == spdlog::level::warn ? "warning" : "error",
                  {message.payload.data(), message.payload.size()});
  }
  void flush_() override {}
  JsonLines& lines_;
};

}  // namespace

struct RunLog::State {
  explicit State(const std::filesystem::path& file) : lines(file, "--log-json") {}
  JsonLines lines;
  std::shared_ptr<MessageSink> sink = std::make_shared<MessageSink>(lines);
};

RunLog::RunLog(const std::optional<std::filesystem::path>& file) {
  if (!file) return;
  refuse_to_replace_others(*file, R"({"event":")", "--log-json");
  state_ = std::make_unique<State>(*file);
  spdlog::default_logger()->sinks().push_back(state_->sink);
}

RunLog::~RunLog() {
  if (state_) std::erase(spdlog::default_logger()->sinks(), state_->sink);
}

bool RunLog::ok() const { return !state_ || state_->lines.ok(); }

void RunLog::start(const Job& job, const std::vector<ResultFiles>& results, const SessionOptions& options, const Window& window) {
  if (!state_) return;
  JsonObject inputs;
  for (const InputFiles& input : job.inputs) inputs.text(input.input, input.pattern);
  std::vector<std::string> outputs;
  for (const ResultFiles& series : results) outputs.push_back(series.pattern);
  JsonObject start;
  start.text("version", QUELL_VERSION)
      .text("graph", job.graph->file.string())
      .text("name", job.graph->name)
      .text("graph_hash", graph_hash(*job.graph))
      .text("sequence", job.sequence->describe())
      .object("inputs", inputs)
      .texts("outputs", outputs)
      .text("frames", range(job.frames))
      .number("frame_count", job.frames.size())
      .text("executor", options.schedule == Schedule::serial ? "serial" : "tbb")
      .number("threads", options.threads > 0 ? options.threads : available_threads())
      .text("isa", current_isa())
      .number("frames_in_flight", window.frames)
      .number("memory_limit", window.memory)
      .text("on_error", name_of(options.on_error));
  if (!options.cuts.empty()) start.text("cuts", range(options.cuts));
  state_->lines.write("start", start);
}

void RunLog::frame(const FrameReport& report, const Plan& plan, const BufferPool::Usage& usage,
                   const std::vector<MeasuredOutput>& measured, const std::vector<Metric>& metrics) {
  if (!state_) return;
  JsonObject nodes;
  if (report.node_seconds.size() == plan.nodes.size())
    for (std::size_t i = 0; i < plan.nodes.size(); ++i)
      nodes.seconds(plan.graph->nodes[static_cast<std::size_t>(plan.nodes[i].node)].name, report.node_seconds[i]);
  std::vector<JsonObject> replaced;
  for (const ReplacedValues& values : report.replaced)
    replaced.push_back(JsonObject().text("input", values.input).text("type", name(values.type)).number("count", values.count));
  JsonObject line;
  line.number("frame", report.frame).flag("ok", report.ok);
  if (report.history_only) line.flag("history_only", true);
  if (!report.ok) line.text("error", report.error).text("node", report.node);
  line.seconds("seconds", report.seconds)
      .seconds("read_seconds", report.read_seconds)
      .seconds("write_seconds", report.write_seconds)
      .object("node_seconds", nodes)
      .objects("replaced", replaced)
      .object("memory", JsonObject().number("in_use", usage.in_use).number("idle", usage.idle).number("peak", usage.peak));
  if (!measured.empty()) line.object("figures", figures(measured, metrics));
  state_->lines.write("frame", line);
}

void RunLog::message(int level, std::string_view text) {
  if (state_) write_message(state_->lines, name_of_level(level), text);
}

void RunLog::end(const RunOutcome& outcome, ExitCode code) {
  if (!state_) return;
  JsonObject line;
  line.text("outcome", name_of(outcome.ending))
      .text("done", range(outcome.frames.done))
      .text("failed", range(outcome.frames.failed))
      .text("not_computed", range(outcome.frames.not_computed))
      .seconds("seconds", outcome.seconds)
      .number("peak_bytes", outcome.peak_bytes);
  if (outcome.measuring)
    line.object("figures", figures(outcome.measuring->totals(), outcome.measuring->options().compare.metrics));
  line.number("exit_code", static_cast<int>(code));
  state_->lines.write("end", line);
}

void RunLog::end(std::string_view error, ExitCode code) {
  if (!state_) return;
  state_->lines.write("end",
                      JsonObject().text("outcome", "failed").text("error", error).number("exit_code", static_cast<int>(code)));
}

}  // namespace quell::app
