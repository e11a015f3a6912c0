#include "report_size.h"

#include "report_page.h"

namespace quell::app {
namespace {

// Of values of noise, deflated and in Base64, which makes 4 characters of 3 bytes: the lowest 13 of a float's 32 bits, or 10 of a
// half float's 16, do not get smaller. Measured on images of graphs/sample.
constexpr double kOfFloat = 4.2, kOfHalf = 2.05;
constexpr double kOfFlat = 0.1;  // of ids and masks, which have large areas of one value

class Sum {
 public:
  void add(const Shape& shape, std::size_t frames, double bytes_per_value) {
    const double pixels = static_cast<double>(shape.size.width) * shape.size.height;
    const bool is_flat = shape.type == QUELL_TYPE_MASK || shape.type == QUELL_TYPE_ID;
    bytes_ += pixels * info(shape.type).channels * (is_flat ? kOfFlat : bytes_per_value) * static_cast<double>(frames);
  }
  double bytes() const { return bytes_; }

 private:
  double bytes_ = static_cast<double>(kReportPage.size());
};

/// An image of every frame that is kept; in those with inner images it may be exact.
void add_series(Sum& sum, const Report& report, const Shape& shape) {
  sum.add(shape, report.frames.kept.size() - report.frames.inner.size(), kOfHalf);
  sum.add(shape, report.frames.inner.size(), kOfFloat);
}

void add_graph(Sum& sum, const Report& report, const ReportedGraph& graph) {
  const Plan& plan = graph.job.plan;
  for (const PlannedResult& result : plan.results()) add_series(sum, report, plan.shape(result.from));
  for (const std::string& name : graph.inner)
    sum.add(plan.shape(plan.graph->find(name)),
            report.frames.inner.size() + (graph.weighed.before.contains(name) ? report.frames.before.size() : 0), kOfFloat);
}

}  // namespace

double estimate_bytes(const Report& report) {
  Sum sum;
  std::set<std::string> added;
  for (const ReportedGraph& graph : report.graphs) {
    add_graph(sum, report, graph);
    for (const InputFiles& input : graph.job.inputs) {
      const std::optional<Shape> shape = graph.job.sequence->shape(input.input);
      if (!shape || !is_image(shape->type) || !added.insert(input.input).second) continue;
      const bool is_carried = graph.weighed.before.contains(input.input);
      if (input.input == kNoisyInput)
        add_series(sum, report, *shape);
      else
        sum.add(*shape, report.frames.inner.size() + (is_carried ? report.frames.before.size() : 0), kOfFloat);
      if (input.input == kNoisyInput && report.measuring) sum.add(*shape, report.frames.kept.size(), kOfHalf);  // the reference
    }
  }
  return sum.bytes();
}

}  // namespace quell::app
