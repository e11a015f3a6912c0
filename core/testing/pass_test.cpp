#include "quell/testing/pass_test.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "quell/graph/plan.h"
#include "quell/plugin/registry.h"
#include "quell/runtime/frame_run.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

BufferPool& image_pool() {
  static BufferPool pool;
  return pool;
}

std::string json_string(std::string_view text) {
  std::string json = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') json += '\\';
    json += c;
  }
  return json + '"';
}

std::string number(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value).ptr;  // shortest text that reads back as the same double
  return {text, end};
}

template <class List, class ToText>
std::string join(const List& list, const char* separator, const ToText& to_text) {
  std::string text;
  for (const auto& element : list) text += (text.empty() ? "" : separator) + to_text(element);
  return text;
}

std::string input_name(std::string_view port, std::size_t item) { return std::string(port) + "_" + std::to_string(item); }

std::uint32_t find_port(const quell_port_desc* ports, std::uint32_t count, std::string_view name, const char* pass) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < count; ++i) {
    names.emplace_back(QUELL_AT(quell_port_desc, ports, i)->name);
    if (names.back() == name) return i;
  }
  throw Error(
      Fault::usage, pass,
      "the pass has no port '" + std::string(name) + "'" + did_you_mean(name, names) + "; it has " + list_names(names, "and"));
}

}  // namespace

Image test_image(PortType type, Size size, const std::function<float(int, int, int)>& value, int spare_lines) {
  Image image(type, size, image_pool(), spare_lines);
  const FloatOutput pixels = image.writable_floats();
  for (int c = 0; c < pixels.channels; ++c)
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) pixels.at(x, y, c) = value(x, y, c);
  return image;
}

Image test_ids(Size size, const std::function<std::uint32_t(int, int)>& value, int spare_lines) {
  Image image(QUELL_TYPE_ID, size, image_pool(), spare_lines);
  const IdOutput pixels = image.writable_ids();
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) pixels.at(x, y) = value(x, y);
  return image;
}

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
  const quell_pass_desc& desc;
  Registry registry;
  std::map<std::string, std::string, std::less<>> params;        // as JSON
  std::map<std::string, std::vector<Item>, std::less<>> inputs;  // by port
  std::map<std::string, std::string, std::less<>> feedback;      // input port -> output port
  int thread_count = 1;
  bool move_inputs = false;
  std::int64_t next_frame = 0;

  BufferPool pool;
  std::unique_ptr<Executor> executor;
  HostServices services;
  std::string planned_for;
  std::unique_ptr<FrameRun> frame_run;
  FrameResult result;

  explicit State(const quell_pass_desc& pass) : desc(pass) {
    const quell_pass_desc* passes[] = {&pass};
    registry.add(passes, 1);
    pool.poison(true);
  }

  std::uint32_t input_index(std::string_view name) const { return find_port(desc.inputs, desc.input_count, name, desc.id); }
  std::uint32_t output_index(std::string_view name) const { return find_port(desc.outputs, desc.output_count, name, desc.id); }
  bool is_array(std::string_view input) const {
    return (QUELL_AT(quell_port_desc, desc.inputs, input_index(input))->flags & QUELL_PORT_ARRAY) != 0;
  }

  // How many items an output has: an array has as many as the input it follows.
  std::size_t item_count(const quell_port_desc& output) const {
    if (!(output.flags & QUELL_PORT_ARRAY)) return 1;
    const auto followed = inputs.find(QUELL_AT(quell_port_desc, desc.inputs, output.same_as)->name);
    return followed == inputs.end() ? 0 : followed->second.size();
  }

  std::string input_list() const {
    std::vector<std::string> lines;
    for (const auto& [port, items] : inputs)
      for (std::size_t i = 0; i < items.size(); ++i)
        lines.push_back(json_string(input_name(port, i)) + ": " + json_string(name(items[i].type())));
    return join(lines, ", ", [](const auto& line) { return line; });
  }
  std::string connection_list() const {
    std::vector<std::string> lines;
    for (const auto& [port, items] : inputs) {
      std::vector<std::string> names;
      for (std::size_t i = 0; i < items.size(); ++i) names.push_back(json_string(input_name(port, i)));
      const std::string list = join(names, ", ", [](const auto& text) { return text; });
      const bool array = is_array(port);
      if (!items.empty()) lines.push_back(json_string(port) + ": " + (array ? "[" + list + "]" : list));
    }
    for (const auto& [to, from] : feedback)
      lines.push_back(json_string(to) + R"(: {"from": "pass.)" + from + R"(", "delay": 1, "initial": "none"})");
    return join(lines, ", ", [](const auto& line) { return line; });
  }
  std::string output_list() const {
    std::vector<std::string> lines;
    for (std::uint32_t o = 0; o < desc.output_count; ++o) {
      const quell_port_desc& port = *QUELL_AT(quell_port_desc, desc.outputs, o);
      const bool array = (port.flags & QUELL_PORT_ARRAY) != 0;
      for (std::size_t i = 0; i < item_count(port); ++i)
        lines.push_back(json_string(input_name(port.name, i)) + R"(: "pass.)" + port.name +
                        (array ? "[" + std::to_string(i) + "]" : "") + '"');
    }
    return join(lines, ", ", [](const auto& line) { return line; });
  }
  std::string graph_text() const {
    const std::string settings =
        join(params, ", ", [](const auto& param) { return json_string(param.first) + ": " + param.second; });
    return R"({"quell": 1, "inputs": {)" + input_list() + R"(}, "nodes": {"pass": {"pass": )" + json_string(desc.id) +
           R"(, "in": {)" + connection_list() + R"(}, "params": {)" + settings + R"(}}}, "outputs": {)" + output_list() + "}}";
  }

  std::string shape_text() const {
    std::string text;
    for (const auto& [port, items] : inputs)
      for (const Item& item : items) {
        const Shape shape = shape_of(item);
        text += std::to_string(shape.size.width) + "x" + std::to_string(shape.size.height) + "," +
                std::to_string(shape.value_count) + ";";
      }
    return text;
  }

  // The pass alone makes a graph of one node, so that everything a graph's user meets is met here too.
  FrameRun& prepare() {
    const std::string text = graph_text();
    const std::string key = text + shape_text();
    if (frame_run && key == planned_for) return *frame_run;
    const auto source = std::make_shared<const SourceText>(SourceText{desc.id, text});
    InputShapes shapes;
    for (const auto& [port, items] : inputs)
      for (std::size_t i = 0; i < items.size(); ++i) shapes[input_name(port, i)] = shape_of(items[i]);
    Plan plan = make_plan(parse_graph(source, registry), shapes);
    frame_run.reset();
    executor = make_executor(thread_count);
    services.executor = executor.get();
    frame_run = std::make_unique<FrameRun>(std::move(plan), services, pool);
    planned_for = key;
    return *frame_run;
  }

  const PlannedNode& planned() {
    const auto& nodes = prepare().plan().nodes;
    if (nodes.empty()) throw Error(Fault::usage, desc.id, "the pass does not run on these inputs");
    return nodes.front();
  }
};

PassTest::PassTest(const quell_pass_desc& pass) : state_(std::make_unique<State>(pass)) {}
PassTest::~PassTest() = default;
PassTest::PassTest(PassTest&&) noexcept = default;

PassTest& PassTest::set(std::string_view param, double value) { return set_json(param, number(value)); }
PassTest& PassTest::set(std::string_view param, std::string_view text) { return set_json(param, json_string(text)); }
PassTest& PassTest::set(std::string_view param, const std::vector<double>& values) {
  return set_json(param, "[" + join(values, ", ", number) + "]");
}
PassTest& PassTest::set_json(std::string_view param, std::string json) {
  state_->params[std::string(param)] = std::move(json);
  return *this;
}

PassTest& PassTest::input(std::string_view port, Item item) {
  const bool array = state_->is_array(port);
  std::vector<Item>& items = state_->inputs[std::string(port)];
  if (!array) items.clear();
  items.push_back(std::move(item));
  return *this;
}

PassTest& PassTest::disconnect(std::string_view port) {
  state_->input_index(port);
  if (const auto found = state_->inputs.find(port); found != state_->inputs.end()) state_->inputs.erase(found);
  if (const auto found = state_->feedback.find(port); found != state_->feedback.end()) state_->feedback.erase(found);
  return *this;
}

PassTest& PassTest::feed_back(std::string_view output, std::string_view input) {
  state_->output_index(output);
  disconnect(input);
  state_->feedback[std::string(input)] = output;
  return *this;
}

PassTest& PassTest::threads(int count) {
  state_->thread_count = count;
  state_->frame_run.reset();
  return *this;
}
PassTest& PassTest::grain(int rows) {
  state_->services.force_grain = rows;
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
  FrameRun& frame_run = s.prepare();
  s.result = {};
  std::vector<Item> items;
  for (const GraphInput& input : frame_run.plan().graph->inputs) {
    const std::size_t split = input.name.rfind('_');
    Item& item = s.inputs.find(input.name.substr(0, split))->second[std::stoul(input.name.substr(split + 1))];
    items.push_back(s.move_inputs ? std::move(item) : item);
  }
  if (s.move_inputs) s.inputs.clear();
  s.result = frame_run.compute(s.next_frame++, std::move(items), {});
}

const Item& PassTest::output_item(std::string_view port, int item) const {
  state_->output_index(port);
  const std::string name = input_name(port, static_cast<std::size_t>(item));
  const auto found = std::ranges::find(state_->result.outputs, name, &std::pair<std::string, Item>::first);
  if (found == state_->result.outputs.end())
    throw Error(Fault::usage, state_->desc.id, "no output '" + name + "'; was the pass run?");
  return found->second;
}
FloatImage PassTest::output(std::string_view port, int item) const { return output_item(port, item).image()->floats(); }
IdImage PassTest::output_ids(std::string_view port, int item) const { return output_item(port, item).image()->ids(); }
Values PassTest::output_values(std::string_view port) const { return *output_item(port).values(); }

int PassTest::radius(std::string_view input) { return state_->planned().radius[state_->input_index(input)]; }
std::string PassTest::in_place_of(std::string_view output) {
  const int input = state_->planned().in_place_of[state_->output_index(output)];
  return input < 0 ? "" : QUELL_AT(quell_port_desc, state_->desc.inputs, input)->name;
}
const quell_pass_desc& PassTest::desc() const { return state_->desc; }

}  // namespace quell
