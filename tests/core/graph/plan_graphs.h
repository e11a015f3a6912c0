// Graphs made by hand for the tests of the plan, and passes that do nothing but answer infer.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quell/graph/plan.h"
#include "quell/sdk/pass.h"

namespace quell::test {

class Idle : public Pass {
 public:
  void run(const Frame&) const override {}
};

/// Any image in, the same out, and further images to look at.
struct MixParams {
  bool in_place = false;
  int radius = 0;
  int scratch = 0;
  void describe(auto&& field) {
    field("in_place", in_place, "Write 'color' over 'color'.");
    field("radius", radius, Range<int>{-1, 99}, "px", "Of 'more'.");
    field("scratch", scratch, Range<int>{}, "bytes", "For a frame.");
  }
};
class Mix : public Idle {
 public:
  explicit Mix(const MixParams& params) : params_(params) {}
  void infer(Inference& inference) const override {
    if (params_.in_place) inference.set_in_place("color", "color");
    inference.set_radius("more", params_.radius);
    inference.set_scratch(static_cast<std::size_t>(params_.scratch));
  }

 private:
  MixParams params_;
};
inline const quell_pass_desc* mix() {
  return detail::Descriptor::make<Mix, MixParams>(
             {.id = "mix",
              .inputs = {{"color", kAnyImage},
                         {.name = "more", .types = kAnyImage, .optional = true, .array = true},
                         {.name = "camera", .types = kCamera, .optional = true}},
              .outputs = {{.name = "color", .same_as = "color"}, {"weight", kScalar}}})
      .get();
}

/// Works row by row: reads `color` around a pixel, and `more` at it.
struct RowsParams {
  int radius = 0;
  bool in_place = false;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{-1, 99}, "px", "Of 'color'.");
    field("in_place", in_place, "Write over 'color'.");
  }
};
class Rows : public Idle {
 public:
  explicit Rows(const RowsParams& params) : params_(params) {}
  void infer(Inference& inference) const override {
    inference.set_by_rows();
    inference.set_radius("color", params_.radius);
    if (params_.in_place) inference.set_in_place("color", "color");
  }

 private:
  RowsParams params_;
};
inline const quell_pass_desc* rows() {
  return detail::Descriptor::make<Rows, RowsParams>(
             {.id = "rows",
              .inputs = {{"color", kAnyImage}, {.name = "more", .types = kAnyImage, .optional = true, .array = true}},
              .outputs = {{.name = "color", .same_as = "color"}}})
      .get();
}

/// Averages with what it made before, where there is something.
struct NoParams {};
class Blend : public Idle {
 public:
  explicit Blend(const NoParams&) {}
};
inline const quell_pass_desc* blend() {
  return detail::Descriptor::make<Blend, NoParams>(
             {.id = "blend",
              .inputs = {{.name = "history", .types = kAnyImage, .optional = true}, {"color", kAnyImage}},
              .outputs = {{.name = "color", .same_as = "color"}}})
      .get();
}

/// Another size: times `multiply`, divided by `divide`, rounded up.
struct ResizeParams {
  int multiply = 1;
  int divide = 2;
  void describe(auto&& field) {
    field("multiply", multiply, Range<int>{1, 1 << 20}, "", "");
    field("divide", divide, Range<int>{1, 1 << 20}, "", "");
  }
};
class Resize : public Idle {
 public:
  explicit Resize(const ResizeParams& params) : params_(params) {}
  void infer(Inference& inference) const override {
    const Size size = inference.size("color");
    if (size.width % params_.divide != 0) throw std::runtime_error("the width must divide by " + std::to_string(params_.divide));
    const auto scaled = [&](int side) { return (side * params_.multiply + params_.divide - 1) / params_.divide; };
    inference.set_size("color", {scaled(size.width), scaled(size.height)});
    inference.set_unbounded("color");
  }

 private:
  ResizeParams params_;
};
inline const quell_pass_desc* resize() {
  return detail::Descriptor::make<Resize, ResizeParams>(
             {.id = "resize", .inputs = {{"color", kAnyImage}}, .outputs = {{.name = "color", .same_as = "color"}}})
      .get();
}

/// At the size of its guide, which may be another.
class Guided : public Idle {
 public:
  explicit Guided(const NoParams&) {}
  void infer(Inference& inference) const override {
    inference.set_size("color", inference.size("guide"));
    inference.set_unbounded("color");
  }
};
inline const quell_pass_desc* guided() {
  return detail::Descriptor::make<Guided, NoParams>({.id = "guided",
                                                     .inputs = {{.name = "guide", .types = kAnyImage, .any_size = true},
                                                                {"color", kAnyImage},
                                                                {.name = "more", .types = kAnyImage, .optional = true}},
                                                     .outputs = {{.name = "color", .same_as = "color"}, {"weight", kScalar}}})
      .get();
}

/// Several images, each for itself, under one guide.
class Channels : public Idle {
 public:
  explicit Channels(const MixParams& params) : in_place_(params.in_place) {}
  void infer(Inference& inference) const override {
    if (in_place_) inference.set_in_place("out", "in");
  }

 private:
  bool in_place_;
};
inline const quell_pass_desc* channels() {
  return detail::Descriptor::make<Channels, MixParams>(
             {.id = "channels",
              .inputs = {{"guide", kAnyImage}, {.name = "in", .types = kAnyImage, .optional = true, .array = true}},
              .outputs = {{.name = "out", .array = true, .same_as = "in"}}})
      .get();
}

/// Numbers of an image.
class Meter : public Idle {
 public:
  explicit Meter(const NoParams&) {}
  void infer(Inference& inference) const override { inference.set_value_count("value", 5); }
};
inline const quell_pass_desc* meter() {
  return detail::Descriptor::make<Meter, NoParams>(
             {.id = "meter", .inputs = {{"color", kAnyImage}}, .outputs = {{"value", kValue}}})
      .get();
}

/// A pass whose infer is replaced: one that breaks the interface.
inline const quell_pass_desc* with_infer(quell_pass_desc pass, decltype(quell_pass_desc::infer) infer) {
  static std::vector<std::unique_ptr<quell_pass_desc>> kept;
  pass.infer = infer;
  return kept.emplace_back(std::make_unique<quell_pass_desc>(pass)).get();
}

/// Where an input comes from: "node.port", "node.port[1]" or a graph input. `initial` of a delayed one is "" for none, "=0.5", or
/// the name of an endpoint.
struct Wire {
  Wire(const char* source) : from(source) {}  // NOLINT: a wire is mostly just a name
  Wire(std::string source, int frames = 0, std::string first = "")
      : from(std::move(source)), delay(frames), initial(std::move(first)) {}
  std::string from;
  int delay = 0;
  std::string initial;
};
using Wires = std::map<std::string, std::vector<Wire>>;

/// Builds a Graph. In messages, each input, node, output and edge stands on a line of its own that holds its name.
class Builder {
 public:
  Builder& input(const std::string& name, PortType type = QUELL_TYPE_COLOR, bool optional = false) {
    graph_->inputs.push_back({name, type, optional, "", place(name)});
    return *this;
  }
  Builder& node(const std::string& name, const quell_pass_desc* pass, const Wires& wires,
                const std::map<std::string, std::int64_t>& params = {}) {
    graph_->nodes.push_back({name, pass, make_instance(*pass, params), {}, {}, place(name)});
    wires_.push_back(wires);
    return *this;
  }
  Builder& output(const std::string& from) {
    outputs_.push_back(from);
    return *this;
  }
  std::shared_ptr<Graph> build() {
    for (std::size_t n = 0; n < wires_.size(); ++n) connect(graph_->nodes[n], wires_[n]);
    for (const std::string& from : outputs_) graph_->outputs.push_back({"out", endpoint(from), place("output " + from)});
    return graph_;
  }
  Endpoint endpoint(const std::string& name) const;

 private:
  Position place(const std::string& line) {
    source_->text += line + "\n";
    return {source_, source_->text.size() - line.size() - 1};
  }
  static std::shared_ptr<const PassInstance> make_instance(const quell_pass_desc& pass,
                                                           const std::map<std::string, std::int64_t>& params);
  void connect(Node& node, const Wires& wires);
  Edge edge(const Wire& wire, const std::string& line);

  std::shared_ptr<SourceText> source_ = std::make_shared<SourceText>(SourceText{"graph.json", ""});
  std::shared_ptr<Graph> graph_ = std::make_shared<Graph>();
  std::vector<Wires> wires_;
  std::vector<std::string> outputs_;
};

inline Shape image(int width, int height, PortType type = QUELL_TYPE_COLOR) { return {.type = type, .size = {width, height}}; }
inline Shape camera() { return {.type = QUELL_TYPE_CAMERA}; }

/// Bytes of an image, by the rule of the design: rows of whole cache lines with at least one to spare.
inline std::size_t bytes(int width, int height, int planes) {
  const int floats = (width + 15) / 16 * 16 + 16;
  return static_cast<std::size_t>(floats) * static_cast<std::size_t>(height) * static_cast<std::size_t>(planes) * 4;
}

/// Names of the nodes that run.
std::vector<std::string> running(const Plan& plan);
const PlannedNode& planned(const Plan& plan, const std::string& node);
/// The message of the Error that planning throws; a failure when it throws none.
std::string error_of(const std::shared_ptr<const Graph>& graph, const InputShapes& inputs,
                     const std::vector<std::string>& dumps = {}, Fault fault = Fault::usage);

}  // namespace quell::test
