#include "run_record.h"

#include "quell/graph/graph_hash.h"
#include "quell/simd/isa.h"
#include "run_options.h"

namespace quell::app {
namespace {

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

/// By input or result.
JsonObject sizes(const std::vector<ReportedSize>& images) {
  JsonObject all;
  for (const ReportedSize& image : images)
    all.object(image.name, JsonObject().number("width", image.size.width).number("height", image.size.height));
  return all;
}

}  // namespace

std::string range_text(const std::vector<std::int64_t>& frames) { return frames.empty() ? "" : FrameRange(frames).text(); }

JsonObject record_start(const Job& job, const std::vector<ResultFiles>& results, const SessionOptions& options,
                        const Window& window) {
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
      .text("frames", range_text(job.frames))
      .number("frame_count", job.frames.size())
      .text("executor", options.schedule == Schedule::serial ? "serial" : "tbb")
      .number("threads", options.threads > 0 ? options.threads : available_threads())
      .text("isa", current_isa())
      .number("frames_in_flight", window.frames)
      .number("memory_limit", options.memory > 0 ? options.memory : window.memory)
      .text("on_error", name_of(options.on_error));
  if (!options.cuts.empty()) start.text("cuts", range_text(options.cuts));
  return start;
}

JsonObject record_frame(const FrameReport& report, const Plan& plan, const BufferPool::Usage& usage,
                        const std::vector<MeasuredOutput>& measured, const std::vector<Metric>& metrics) {
  JsonObject nodes;
  if (report.node_seconds.size() == plan.nodes.size())
    for (std::size_t i = 0; i < plan.nodes.size(); ++i)
      nodes.seconds(plan.graph->nodes[static_cast<std::size_t>(plan.nodes[i].node)].name, report.node_seconds[i]);
  std::vector<JsonObject> replaced;
  for (const ReplacedValues& values : report.replaced)
    replaced.push_back(JsonObject().text("input", values.input).text("type", name(values.type)).number("count", values.count));
  JsonObject frame;
  frame.number("frame", report.frame).flag("ok", report.ok);
  if (report.history_only) frame.flag("history_only", true);
  if (!report.ok) frame.text("error", report.error).text("node", report.node);
  frame.seconds("seconds", report.seconds)
      .seconds("read_seconds", report.read_seconds)
      .seconds("write_seconds", report.write_seconds)
      .object("node_seconds", nodes)
      .object("inputs", sizes(report.inputs))
      .object("results", sizes(report.results))
      .objects("replaced", replaced)
      .object("memory", JsonObject().number("in_use", usage.in_use).number("idle", usage.idle).number("peak", usage.peak));
  if (!measured.empty()) frame.object("figures", figures(measured, metrics));
  return frame;
}

JsonObject record_end(const RunOutcome& outcome) {
  JsonObject end;
  end.text("outcome", name_of(outcome.ending))
      .text("done", range_text(outcome.frames.done))
      .text("failed", range_text(outcome.frames.failed))
      .text("not_computed", range_text(outcome.frames.not_computed))
      .seconds("seconds", outcome.seconds)
      .number("peak_bytes", outcome.peak_bytes);
  if (outcome.measuring)
    end.object("figures", figures(outcome.measuring->totals(), outcome.measuring->options().compare.metrics));
  return end;
}

JsonObject record_end(std::string_view error) { return JsonObject().text("outcome", "failed").text("error", error); }

}  // namespace quell::app
