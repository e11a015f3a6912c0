#include "quell/testing/pass_test.h"

#include <algorithm>
#include <utility>

#include "quell/graph/plan.h"
#include "quell/plugin/registry.h"
#include "quell/runtime/single_frame.h"
#include "quell/simd/isa.h"
#include "quell/testing/pass_graph.h"
#include "quell/text/diagnostic.h"
#include "quell/text/json.h"

namespace quell {

using namespace harness;

namespace {

const Image& image_in(const Item& item, quell_format format, std::string_view port) {
  if (!item.image() || info(item.image()->type()).format != format)
    throw Error(
        Fault::usage, std::string(port),
        format == QUELL_FORMAT_U32 ? "the output carries no image of ids" : "the output carries no image of float planes");
  return *item.image();
}

}  // namespace

const quell_pass_desc& find_pass(const quell_pass_desc* const* passes, std::uint32_t count, std::string_view id) {
  std::vector<std::string> ids;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (passes[i]->id == id) return *passes[i];
    ids.emplace_back(passes[i]->id);
  }
  throw Error(Fault::usage, "",
              "no pass '" + std::string(id) + "' is linked into this program; it has " + list_names(ids, "and"));
}

struct PassTest::State {
  PassGraph graph;
  Registry registry;
  int thread_count = 1, rows_at_a_time = 0;
  bool move_inputs = false;
  std::int64_t next_frame = 0;

  BufferPool pool;
  std::unique_ptr<Executor> executor;
  HostServices services;
  std::string planned_for;
  std::unique_ptr<PlanState> running;
  std::unique_ptr<Lane> lane;
  std::vector<std::pair<std::string, Item>> outputs;

  explicit State(const quell_pass_desc& pass) : graph{pass} {
    pin_isa_from_environment();
    const quell_pass_desc* passes[] = {&pass};
    registry.add(passes, 1);
    pool.fill(kNanByte);
  }

  std::string shape_text() const {
    std::string text;
    for (const auto& [port, items] : graph.inputs)
      for (const Item& item : items) {
        const Shape shape = shape_of(item);
        text += std::to_string(shape.size.width) + "x" + std::to_string(shape.size.height) + "," +
                std::to_string(shape.value_count) + ";";
      }
    return text;
  }

  // The pass alone makes a graph of one node, so that everything a graph's user meets is met here too.
  const Plan& prepare() {
    const std::string text = graph.text();
    const std::string key = text + shape_text();
    if (running && key == planned_for) return running->plan;
    const auto source = std::make_shared<const SourceText>(SourceText{graph.desc.id, text});
    InputShapes shapes;
    for (const auto& [port, items] : graph.inputs)
      for (std::size_t i = 0; i < items.size(); ++i) shapes[item_name(port, i)] = shape_of(items[i]);
    Plan plan = make_plan(parse_graph(source, registry), shapes);
    if (rows_at_a_time > 0 && !plan.nodes.empty() && plan.nodes.front().by_rows) fuse_alone(plan);
    lane.reset();
    executor = make_executor(thread_count);
    services.executor = executor.get();
    running = std::make_unique<PlanState>(std::move(plan), 1, pool);
    lane = std::make_unique<Lane>(*running, services, pool, nullptr);
    planned_for = key;
    return running->plan;
  }

  // With windows as if others read each output around a pixel.
  void fuse_alone(Plan& plan) const {
    PlannedTurn& turn = plan.turns.front();
    turn.ahead = {0};
    turn.rows = turn.band = rows_at_a_time;
    const PlannedNode& node = plan.nodes.front();
    for (std::size_t port = 0; port < node.outputs.size(); ++port)
      for (std::size_t item = 0; item < node.outputs[port].size(); ++item) {
        const Shape& shape = node.outputs[port][item];
        if (!shape.present) continue;
        turn.windows.push_back({{node.node, static_cast<int>(port), static_cast<int>(item)}, turn.rows, true});
        turn.window_bytes += Image::bytes_needed(shape.type, {shape.size.width, turn.rows});
      }
  }

  const PlannedNode& planned() {
    const auto& nodes = prepare().nodes;
    if (nodes.empty()) throw Error(Fault::usage, graph.desc.id, "the pass does not run on these inputs");
    return nodes.front();
  }
};

PassTest::PassTest(const quell_pass_desc& pass) : state_(std::make_unique<State>(pass)) {}
PassTest::~PassTest() = default;
PassTest::PassTest(PassTest&&) noexcept = default;

PassTest& PassTest::set(std::string_view param, double value) { return set_json(param, json_number(value)); }
PassTest& PassTest::set(std::string_view param, std::string_view text) { return set_json(param, quote_json(text)); }
PassTest& PassTest::set(std::string_view param, const std::vector<double>& values) {
  std::string list;
  for (const double value : values) list += (list.empty() ? "" : ", ") + json_number(value);
  return set_json(param, "[" + list + "]");
}
PassTest& PassTest::set_json(std::string_view param, std::string json) {
  state_->graph.params[std::string(param)] = std::move(json);
  return *this;
}

PassTest& PassTest::input(std::string_view port, Item item) {
  if (!item) throw Error(Fault::usage, std::string(port), "there is nothing in the item; disconnect() makes a port absent");
  const bool array = state_->graph.is_array(port);
  std::vector<Item>& items = state_->graph.inputs[std::string(port)];
  if (!array) items.clear();
  items.push_back(std::move(item));
  return *this;
}

PassTest& PassTest::disconnect(std::string_view port) {
  state_->graph.input_index(port);
  if (const auto found = state_->graph.inputs.find(port); found != state_->graph.inputs.end()) state_->graph.inputs.erase(found);
  if (const auto found = state_->graph.feedback.find(port); found != state_->graph.feedback.end())
    state_->graph.feedback.erase(found);
  return *this;
}

PassTest& PassTest::feed_back(std::string_view output, std::string_view input) {
  state_->graph.output_index(output);
  disconnect(input);
  state_->graph.feedback[std::string(input)] = output;
  return *this;
}

PassTest& PassTest::threads(int count) {
  state_->thread_count = count;
  state_->running.reset();
  return *this;
}
PassTest& PassTest::grain(int rows) {
  state_->services.force_grain = rows;
  return *this;
}
PassTest& PassTest::rows_at_a_time(int rows) {
  state_->rows_at_a_time = rows;
  state_->running.reset();
  return *this;
}
PassTest& PassTest::fresh_memory(unsigned char byte) {
  state_->pool.fill(byte);
  return *this;
}
PassTest& PassTest::in_place() {
  state_->move_inputs = true;
  return *this;
}

PassTest& PassTest::next_frame(std::int64_t number) {
  state_->next_frame = number;
  return *this;
}

void PassTest::run() {
  State& s = *state_;
  const Plan& plan = s.prepare();
  s.outputs.clear();
  std::vector<Item> items;
  for (const GraphInput& input : plan.graph->inputs) {
    const std::size_t split = input.name.rfind('_');
    Item& item = s.graph.inputs.find(input.name.substr(0, split))->second[std::stoul(input.name.substr(split + 1))];
    items.push_back(s.move_inputs ? std::move(item) : item);
  }
  if (s.move_inputs) s.graph.inputs.clear();
  s.outputs = compute_frame(*s.lane, *s.running, s.next_frame++, std::move(items));
}

const Item& PassTest::output_item(std::string_view port, int item) const {
  state_->graph.output_index(port);
  const std::string name = item_name(port, static_cast<std::size_t>(item));
  const auto found = std::ranges::find(state_->outputs, name, &std::pair<std::string, Item>::first);
  if (found == state_->outputs.end())
    throw Error(Fault::usage, state_->graph.desc.id, "no output '" + name + "'; was the pass run?");
  return found->second;
}
FloatImage PassTest::output(std::string_view port, int item) const {
  return image_in(output_item(port, item), QUELL_FORMAT_F32, port).floats();
}
IdImage PassTest::output_ids(std::string_view port, int item) const {
  return image_in(output_item(port, item), QUELL_FORMAT_U32, port).ids();
}
Values PassTest::output_values(std::string_view port) const {
  const Values* values = output_item(port).values();
  if (!values) throw Error(Fault::usage, std::string(port), "the output carries no values");
  return *values;
}

int PassTest::radius(std::string_view input) { return state_->planned().radius[state_->graph.input_index(input)]; }
std::string PassTest::in_place_of(std::string_view output) {
  const int input = state_->planned().in_place_of[state_->graph.output_index(output)];
  return input < 0 ? "" : QUELL_AT(quell_port_desc, state_->graph.desc.inputs, input)->name;
}
const quell_pass_desc& PassTest::desc() const { return state_->graph.desc; }

}  // namespace quell
