#include "tests/bench/pass_runner.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "quell/graph/plan.h"
#include "tests/bench/in_memory.h"

namespace quell::bench {
namespace {

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return "{" + text + "}";
}

std::string graph_text(const PassSetup& setup) {
  std::vector<std::string> inputs, ports, outputs;
  for (const auto& [port, item] : setup.inputs) {
    inputs.push_back("\"" + port + "\": \"" + std::string(name(shape_of(item).type)) + "\"");
    ports.push_back("\"" + port + "\": \"" + port + "\"");
  }
  for (const std::string& port : setup.outputs) outputs.push_back("\"" + port + "\": \"node." + port + "\"");
  return R"({"quell": 1, "inputs": )" + joined(inputs) + R"(, "nodes": {"node": {"pass": ")" + setup.pass + R"(", "in": )" +
         joined(ports) + R"(, "params": )" + setup.params + R"(}}, "outputs": )" + joined(outputs) + "}";
}

}  // namespace

PassRunner::PassRunner(PassSetup setup, int threads) : setup_(std::move(setup)), executor_(make_executor(threads)) {
  InputShapes shapes;
  for (const auto& [port, item] : setup_.inputs) shapes[port] = shape_of(item);
  services_.executor = executor_.get();
  plan_ = std::make_unique<PlanState>(make_plan(make_graph(graph_text(setup_)), shapes), 1, pool_);
  lane_ = std::make_unique<Lane>(*plan_, services_, pool_, nullptr);
  run();
}

double PassRunner::run() {
  outputs_.clear();
  std::vector<Item> items;
  for (const GraphInput& input : plan_->plan.graph->inputs) items.push_back(setup_.inputs.at(input.name));
  const auto start = std::chrono::steady_clock::now();
  outputs_ = compute_frame(*lane_, *plan_, 1, std::move(items));
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

const Image& PassRunner::output(std::string_view port) const {
  return *std::ranges::find(outputs_, port, &std::pair<std::string, Item>::first)->second.image();
}

}  // namespace quell::bench
