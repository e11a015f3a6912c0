#include "report_data.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "machine.h"
#include "metric_options.h"
#include "quell/graph/graph_hash.h"
#include "quell/text/json.h"

namespace quell::app {
namespace {

std::string_view name_of(ReportImage::Kind kind) {
  switch (kind) {
    case ReportImage::Kind::noisy:
      return "noisy";
    case ReportImage::Kind::reference:
      return "reference";
    case ReportImage::Kind::result:
      return "result";
    case ReportImage::Kind::input:
      return "input";
    case ReportImage::Kind::inner:
      return "inner";
  }
  return "";
}

template <class Range, class Make>
Json list(const Range& range, const Make& make) {
  std::vector<Json> elements;
  for (const auto& element : range) elements.push_back(make(element));
  return make_json(std::move(elements));
}

template <class Range>
Json numbers(const Range& range) {
  return list(range, [](const auto& value) { return make_json(value); });
}

Json by_frame(const std::map<std::int64_t, int>& frames) {
  JsonMembers members;
  for (const auto& [frame, number] : frames) members.add(std::to_string(frame), number);
  return members.take();
}

Json image_json(const ReportImage& image, int graph) {
  JsonMembers members;
  members.add("name", image.name).add("kind", name_of(image.kind)).add("type", name(image.type));
  if (graph >= 0) members.add("graph", graph);
  members.add("frames", by_frame(image.frames));
  return members.take();
}

Json packed_json(const PackedImage& image) {
  return JsonMembers()
      .add("width", image.size.width)
      .add("height", image.size.height)
      .add("channels", image.channels)
      .add("format", image.format)
      .take();
}

Json metric_json(Metric metric) {
  const MetricInfo& about = info(metric);
  return JsonMembers()
      .add("name", about.name)
      .add("unit", about.unit)
      .add("higher", about.higher_is_better)
      .add("summary", about.summary)
      .take();
}

Json values_json(const std::vector<Metric>& metrics, const MeasuredOutput& output) {
  std::vector<Json> values;
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const double figure = value(metrics[i], output.scores[i]);
    values.push_back(std::isinf(figure) ? make_json("inf") : make_json(figure));  // JSON has no infinity, and NaN becomes null
  }
  return make_json(std::move(values));
}

/// Figures of each output by name: of every frame, null where there are none, and of all.
Json figures_json(const std::vector<MeasuredOutput>& totals, const std::map<std::int64_t, std::vector<MeasuredOutput>>& measured,
                  const Report& report) {
  JsonMembers outputs;
  if (!report.measuring) return outputs.take();
  const std::vector<Metric>& metrics = report.measuring->compare.metrics;
  for (const MeasuredOutput& total : totals) {
    const Json frames = list(report.frames.all, [&](std::int64_t frame) {
      if (const auto found = measured.find(frame); found != measured.end())
        for (const MeasuredOutput& output : found->second)
          if (output.output == total.output) return values_json(metrics, output);
      return Json();
    });
    outputs.add(total.output, JsonMembers().add("all", values_json(metrics, total)).add("frames", frames).take());
  }
  return outputs.take();
}

Json params_json(const Node& node) {
  JsonMembers params;
  for (std::uint32_t i = 0; i < node.pass->param_count; ++i) {
    const quell_param_desc& desc = *QUELL_AT(quell_param_desc, node.pass->params, i);
    params.add(desc.name, to_json(desc, node.instance->values()[i]));
  }
  return params.take();
}

Json inputs_json(const Graph& graph, const Node& node) {
  std::vector<Json> inputs;
  for (std::size_t port = 0; port < node.inputs.size(); ++port)
    for (const Edge& edge : node.inputs[port]) {
      if (edge.from.is_nothing()) continue;
      const quell_port_desc& desc = *QUELL_AT(quell_port_desc, node.pass->inputs, port);
      JsonMembers input;
      input.add("port", desc.name).add("from", graph.describe(edge.from));
      if (edge.delay != 0) input.add("delay", edge.delay);
      if (edge.initial.kind == Initial::Kind::constant) input.add("initial", numbers(edge.initial.constant));
      if (edge.initial.kind == Initial::Kind::endpoint) input.add("initial", graph.describe(edge.initial.endpoint));
      inputs.push_back(input.take());
    }
  return make_json(std::move(inputs));
}

/// Names of what a node yields, as images go by them, with the name of the port.
Json outputs_json(const Plan& plan, const PlannedNode& planned) {
  std::vector<Json> outputs;
  const Node& node = plan.graph->nodes[static_cast<std::size_t>(planned.node)];
  const std::vector<PlannedResult> results = plan.results();
  for (std::size_t port = 0; port < planned.outputs.size(); ++port)
    for (std::size_t item = 0; item < planned.outputs[port].size(); ++item) {
      const Endpoint endpoint{planned.node, static_cast<int>(port), static_cast<int>(item)};
      const auto result = std::ranges::find(results, endpoint, &PlannedResult::from);
      JsonMembers output;
      output.add("port", QUELL_AT(quell_port_desc, node.pass->outputs, port)->name)
          .add("name", plan.graph->describe(endpoint))
          .add("type", name(planned.outputs[port][item].type));
      if (result != results.end()) output.add("result", result->name);
      outputs.push_back(output.take());
    }
  return make_json(std::move(outputs));
}

Json node_json(const ReportedGraph& graph, std::size_t index) {
  const Plan& plan = graph.job.plan;
  const PlannedNode& planned = plan.nodes[index];
  const Node& node = plan.graph->nodes[static_cast<std::size_t>(planned.node)];
  std::vector<Json> seconds;
  for (const FrameReport& frame : graph.frames)
    if (frame.ok && index < frame.node_seconds.size()) seconds.push_back(make_json(frame.node_seconds[index]));
  JsonMembers members;
  if (!node.resets.empty()) members.add("resets", true);
  return members.add("name", node.name)
      .add("pass", node.pass->id)
      .add("version", static_cast<std::int64_t>(node.pass->version))
      .add("summary", node.pass->summary)
      .add("doc", node.doc)
      .add("params", params_json(node))
      .add("inputs", inputs_json(*plan.graph, node))
      .add("outputs", outputs_json(plan, planned))
      .add("seconds", make_json(std::move(seconds)))
      .take();
}

Json files_json(const ReportedGraph& graph) {
  return list(graph.files,
              [](const auto& file) { return JsonMembers().add("name", file.first).add("text", file.second).take(); });
}

template <class Member>
Json seconds_json(const ReportedGraph& graph, Member member) {
  return list(graph.frames, [&](const FrameReport& frame) { return make_json(frame.*member); });
}

Json graph_json(const ReportedGraph& graph, const Report& report) {
  const Plan& plan = graph.job.plan;
  std::vector<Json> nodes;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) nodes.push_back(node_json(graph, i));
  std::vector<std::string> failed;
  for (const FrameReport& frame : graph.frames)
    if (!frame.ok) failed.push_back("frame " + std::to_string(frame.frame) + ": " + frame.error);
  JsonMembers members;
  members.add("label", graph.label)
      .add("name", plan.graph->name)
      .add("doc", plan.graph->doc)
      .add("hash", graph_hash(*plan.graph))
      .add("edits", make_json(plan.graph->edits))
      .add("files", files_json(graph))
      .add("nodes", make_json(std::move(nodes)))
      .add("failed", make_json(failed))
      .add("figures", figures_json(graph.totals, graph.measured, report))
      .add("seconds", graph.seconds)
      .add("read", seconds_json(graph, &FrameReport::read_seconds))
      .add("memory", JsonMembers()
                         .add("frame", static_cast<std::int64_t>(plan.frame_bytes))
                         .add("history", static_cast<std::int64_t>(plan.history_bytes))
                         .add("unshared", static_cast<std::int64_t>(plan.unshared_bytes))
                         .take());
  if (graph.drawing.empty())
    members.add("noDrawing", graph.no_drawing);
  else
    members.add("drawing", graph.drawing);
  return members.take();
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
  return text;
}

Json provenance_json(const Report& report) {
  const Machine machine = describe_machine();
  std::error_code error;
  std::vector<Json> inputs;
  for (const ReportedGraph& graph : report.graphs)
    for (const InputFiles& input : graph.job.inputs) {
      const auto is_it = [&](const Json& known) { return known.find("input")->string == input.input; };
      if (std::ranges::none_of(inputs, is_it))
        inputs.push_back(JsonMembers().add("input", input.input).add("files", input.pattern).take());
    }
  return JsonMembers()
      .add("version", version_text())
      .add("made", now())
      .add("command", make_json(command_words()))
      .add("folder", std::filesystem::current_path(error).string())
      .add("processor", machine.processor)
      .add("system", machine.system)
      .add("isa", machine.isa)
      .add("processors", machine.processors)
      .add("threads", report.threads)
      .add("inputs", make_json(std::move(inputs)))
      .take();
}

Json images_json(const Report& report) {
  std::vector<Json> images;
  for (const ReportImage& image : report.inputs.images) images.push_back(image_json(image, -1));
  for (std::size_t i = 0; i < report.graphs.size(); ++i) {
    const ReportedGraph& graph = report.graphs[i];
    const auto add = [&](const std::string& name) {
      if (const auto found = graph.images.find(name); found != graph.images.end())
        images.push_back(image_json(found->second, static_cast<int>(i)));
    };
    for (const int output : graph.job.plan.outputs) add(graph.job.graph->outputs[static_cast<std::size_t>(output)].name);
    for (const std::string& name : graph.inner) add(name);
  }
  return make_json(std::move(images));
}

}  // namespace

Json report_data(const Report& report, const PackedImages& packed) {
  JsonMembers data;
  data.add("title", report.title)
      .add("sequence", report.sequence)
      .add("frames", numbers(report.frames.all))
      .add("kept", numbers(report.frames.kept))
      .add("inner", numbers(report.frames.inner));
  if (report.measuring)
    data.add("metrics", list(report.measuring->compare.metrics, metric_json))
        .add("display", info(report.measuring->compare.display).name)
        .add("pixelsPerDegree", report.measuring->compare.pixels_per_degree)
        .add("reference", report.measuring->reference.files());
  return data.add("noisy", figures_json(report.inputs.totals, report.inputs.measured, report))
      .add("graphs", list(report.graphs, [&](const ReportedGraph& graph) { return graph_json(graph, report); }))
      .add("images", images_json(report))
      .add("packed", list(packed.all(), packed_json))
      .add("provenance", provenance_json(report))
      .take();
}

}  // namespace quell::app
