#include "report_graph_data.h"

#include <algorithm>
#include <cmath>

#include "quell/graph/graph_hash.h"

namespace quell::app {
namespace {

Json values_json(const std::vector<Metric>& metrics, const MeasuredOutput& output) {
  std::vector<Json> values;
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const double figure = value(metrics[i], output.scores[i]);
    values.push_back(std::isinf(figure) ? make_json("inf") : make_json(figure));  // JSON has no infinity, and NaN becomes null
  }
  return make_json(std::move(values));
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

}  // namespace

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

}  // namespace quell::app
