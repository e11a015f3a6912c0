#include "report_data.h"

#include <algorithm>
#include <ctime>

#include "machine.h"
#include "metric_options.h"
#include "quell/text/json.h"
#include "report_graph_data.h"

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
