#include "quell/runtime/fused_runner.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <mutex>
#include <utility>

#include "quell/runtime/rows_host.h"
#include "quell/sdk/types.h"

namespace quell {
namespace {

using Clock = std::chrono::steady_clock;

std::size_t at(int index) { return static_cast<std::size_t>(index); }
std::size_t whole_lines(std::size_t bytes) { return (bytes + 63) / 64 * 64; }  // so that two threads never share one

// Where a fused node reads what another one yields.
struct Reader {
  std::size_t member, port, item;
  int radius;
};

// What a fused node yields.
struct Value {
  std::size_t member, port, item;
  Shape shape;
  std::vector<Reader> readers;
  bool whole = true;    // the image is there
  int window_rows = 0;  // 0: it is written to the image at once
};

struct Member {
  std::string name;
  const PassInstance* pass = nullptr;
  int position = 0, ahead = 0;
  std::vector<int> in_place_of;
  std::vector<std::size_t> items;  // of each output
  std::vector<std::size_t> values;
  std::vector<std::size_t> needs;  // members
};

// Rows [first, made) of a value. Those before the first one are forgotten.
struct Window {
  std::byte* data = nullptr;
  int first = 0, made = 0;
};

// What a thread needs for itself.
struct Worker {
  struct Node {
    std::vector<RawPort> raw_inputs, raw_outputs;
    std::vector<quell_port> inputs, outputs;
    quell_exec exec{};
    int made = 0;          // rows before this one are computed
    bool is_dead = false;  // it is lost, or has failed in this band
    double seconds = 0;
  };
  RowsHost host;
  std::vector<Node> nodes;
  std::vector<Window> windows;  // of each value
  std::int64_t serial = -1;     // of the run that its tables are for
};

// Of a node: that of the topmost band where it failed.
struct Failure {
  std::int64_t band = -1;
  std::string reason;
};

}  // namespace

struct FusedRunner::State {
  const PlannedTurn& turn;
  const HostServices& services;
  BufferPool& pool;
  Host host;
  int height = 0;
  std::size_t scratch_bytes = 0, window_bytes = 0;  // of a thread
  std::vector<Member> members;
  std::vector<Value> values;
  std::vector<std::unique_ptr<Worker>> workers;  // by slot
  std::vector<void*> slot_pointers;

  // Of the run at hand.
  std::int64_t serial = 0, frame = 0;
  Tables* tables = nullptr;
  std::byte* window_memory = nullptr;
  std::mutex mutex;
  std::vector<Failure> failures;  // of each member

  State(std::string name, const Plan& plan, const PlannedTurn& planned, const HostServices& host_services, BufferPool& buffers)
      : turn(planned), services(host_services), pool(buffers), host(host_services, std::move(name)) {
    for (std::size_t member = 0; member < turn.nodes.size(); ++member) add_member(plan, member);
    for (std::size_t member = 0; member < members.size(); ++member) link(plan, member);
    window_bytes = whole_lines(turn.window_bytes);
    slot_pointers.resize(services.executor->slots());
    for (std::size_t slot = 0; slot < slot_pointers.size(); ++slot) workers.push_back(make_worker());
  }

  void add_member(const Plan& plan, std::size_t index) {
    const PlannedNode& planned = plan.nodes[at(turn.nodes[index])];
    Member& member = members.emplace_back();
    member.name = plan.graph->nodes[at(planned.node)].name;
    member.pass = plan.graph->nodes[at(planned.node)].instance.get();
    member.position = turn.nodes[index], member.ahead = turn.ahead[index];
    member.in_place_of = planned.in_place_of;
    scratch_bytes = std::max(scratch_bytes, whole_lines(planned.slot_scratch_bytes));
    for (const std::vector<Shape>& port : planned.outputs) member.items.push_back(port.size());
    for (std::size_t port = 0; port < planned.outputs.size(); ++port)
      for (std::size_t item = 0; item < planned.outputs[port].size(); ++item) {
        const Shape& shape = planned.outputs[port][item];
        if (!shape.present) continue;
        height = shape.size.height;
        const Endpoint endpoint{planned.node, static_cast<int>(port), static_cast<int>(item)};
        const auto window = std::ranges::find(turn.windows, endpoint, &PlannedWindow::of);
        member.values.push_back(values.size());
        values.push_back(
            {index, port, item, shape, {}, !plan.is_inner(endpoint), window == turn.windows.end() ? 0 : window->rows});
      }
  }

  // Finds what of the other nodes a node reads.
  void link(const Plan& plan, std::size_t index) {
    const PlannedNode& planned = plan.nodes[at(turn.nodes[index])];
    const Node& node = plan.graph->nodes[at(planned.node)];
    for (std::size_t port = 0; port < node.inputs.size(); ++port)
      for (std::size_t item = 0; item < node.inputs[port].size(); ++item) {
        const Edge& edge = node.inputs[port][item];
        for (Value& value : values)
          if (edge.delay == 0 && plan.nodes[at(members[value.member].position)].node == edge.from.node &&
              value.port == at(edge.from.port) && value.item == at(edge.from.item)) {
            value.readers.push_back({index, port, item, planned.radius[port]});
            members[index].needs.push_back(value.member);
          }
      }
  }

  std::unique_ptr<Worker> make_worker() const {
    auto worker = std::make_unique<Worker>();
    worker->nodes.resize(members.size());
    worker->windows.resize(values.size());
    for (std::size_t member = 0; member < members.size(); ++member) {
      Worker::Node& node = worker->nodes[member];
      node.raw_inputs.resize(members[member].pass->desc().input_count);
      node.raw_outputs.resize(members[member].pass->desc().output_count);
      node.inputs.resize(node.raw_inputs.size()), node.outputs.resize(node.raw_outputs.size());
    }
    return worker;
  }

  // ---- once a frame ----

  void compute(std::int64_t number, Tables& given) {
    const auto start = Clock::now();
    ++serial, frame = number, tables = &given;
    failures.assign(members.size(), {});
    forget_seconds();
    place_outputs();
    Buffer windows, scratch;
    if (window_bytes > 0) windows = pool.acquire(window_bytes * workers.size());
    if (scratch_bytes > 0) scratch = pool.acquire(scratch_bytes * workers.size());
    window_memory = windows ? static_cast<std::byte*>(windows.data()) : nullptr;
    for (std::size_t slot = 0; scratch && slot < slot_pointers.size(); ++slot)
      slot_pointers[slot] = static_cast<std::byte*>(scratch.data()) + slot * scratch_bytes;

    host.begin(frame);
    host.run_chunks((height + turn.band - 1) / turn.band, [&](std::int64_t band, std::uint32_t slot) {
      if (!host.ask_cancelled()) run_band(band, slot);
    });
    if (host.was_cancelled()) throw Cancelled();
    tell_outcomes();
    tell_seconds(std::chrono::duration<double>(Clock::now() - start).count());
  }

  Outcome& outcome(std::size_t member) const { return tables->outcomes[at(members[member].position)]; }
  bool is_lost(std::size_t member) const { return outcome(member) == Outcome::lost; }
  PortItems& inputs(std::size_t member) const { return tables->inputs[at(members[member].position)]; }
  PortItems& outputs(std::size_t member) const { return tables->outputs[at(members[member].position)]; }

  void place_outputs() const {
    for (std::size_t member = 0; member < members.size(); ++member) {
      PortItems& ports = outputs(member);
      ports.resize(members[member].items.size());
      for (std::size_t port = 0; port < ports.size(); ++port) ports[port].resize(members[member].items[port]);
    }
    for (const Value& value : values) {
      const Image* replaced = item_in_place_of(inputs(value.member), members[value.member].in_place_of[value.port], value.item);
      if (value.whole && !is_lost(value.member)) item_of(value) = place_item(value.shape, replaced, pool);
    }
  }

  void tell_outcomes() const {
    for (std::size_t member = 0; member < members.size(); ++member) {
      if (is_lost(member)) continue;
      const auto is_gone = [&](std::size_t needed) { return outcome(needed) != Outcome::done; };
      outcome(member) = Outcome::done;
      if (failures[member].band >= 0) {
        outcome(member) = Outcome::failed;
        const std::string& reason = failures[member].reason;
        tables->errors[at(members[member].position)] =
            members[member].name + ": " + (reason.empty() ? "the pass failed without giving a reason" : reason);
      } else if (std::ranges::any_of(members[member].needs, is_gone)) {
        outcome(member) = Outcome::lost;
      }
      if (outcome(member) != Outcome::done)
        for (std::vector<Item>& port : outputs(member)) std::ranges::fill(port, Item());
    }
  }

  // A run that was cancelled has not told its own.
  void forget_seconds() const {
    for (const std::unique_ptr<Worker>& worker : workers)
      for (Worker::Node& node : worker->nodes) node.seconds = 0;
  }

  void tell_seconds(double all) const {
    double sum = 0;
    for (const std::unique_ptr<Worker>& worker : workers)
      for (const Worker::Node& node : worker->nodes) sum += node.seconds;
    for (std::size_t member = 0; member < members.size(); ++member) {
      double own = 0;
      for (const std::unique_ptr<Worker>& worker : workers) own += worker->nodes[member].seconds;
      tables->seconds[at(members[member].position)] = sum > 0 ? all * own / sum : 0;
    }
  }

  // ---- once a frame and thread ----

  Worker& worker_for(std::uint32_t slot) {
    Worker& worker = *workers[slot];
    if (worker.serial == serial) return worker;
    worker.serial = serial;
    worker.host.begin(host.raw(), slot);
    std::byte* memory = window_memory + slot * window_bytes;
    for (std::size_t value = 0; value < values.size(); ++value) {
      worker.windows[value].data = memory;
      if (values[value].window_rows > 0) memory += bytes_of_window(values[value]);
    }
    for (std::size_t member = 0; member < members.size(); ++member) set_ports(worker, member);
    for (std::size_t value = 0; value < values.size(); ++value)
      if (values[value].window_rows == 0 && !is_lost(values[value].member))
        show(worker, value, item_of(values[value]).image()->raw());
    for (std::size_t member = 0; member < members.size(); ++member) set_exec(worker.nodes[member]);
    return worker;
  }

  Item& item_of(const Value& value) const { return outputs(value.member)[value.port][value.item]; }

  static std::size_t bytes_of_window(const Value& value) {
    return Image::bytes_needed(value.shape.type, {value.shape.size.width, value.window_rows});
  }

  void set_ports(Worker& worker, std::size_t member) const {
    Worker::Node& node = worker.nodes[member];
    for (std::size_t port = 0; port < node.raw_inputs.size(); ++port) node.raw_inputs[port].set(inputs(member)[port]);
    for (std::size_t port = 0; port < node.raw_outputs.size(); ++port) node.raw_outputs[port].set(outputs(member)[port]);
    for (std::size_t port = 0; port < node.inputs.size(); ++port) node.inputs[port] = node.raw_inputs[port].raw();
    for (std::size_t port = 0; port < node.outputs.size(); ++port) node.outputs[port] = node.raw_outputs[port].raw();
  }

  void set_exec(Worker::Node& node) const {
    node.exec = {};
    node.exec.struct_size = sizeof(node.exec);
    node.exec.input_count = static_cast<std::uint32_t>(node.inputs.size());
    node.exec.output_count = static_cast<std::uint32_t>(node.outputs.size());
    node.exec.slot_count = static_cast<std::uint32_t>(slot_pointers.size());
    node.exec.frame = frame;
    node.exec.inputs = node.inputs.data(), node.exec.outputs = node.outputs.data();
    node.exec.slot_scratch = slot_pointers.data();
  }

  // Lets who writes and who reads a value find it there.
  void show(Worker& worker, std::size_t index, const quell_image& image) const {
    const Value& value = values[index];
    worker.nodes[value.member].raw_outputs[value.port].set_image(value.item, image);
    for (const Reader& reader : value.readers) worker.nodes[reader.member].raw_inputs[reader.port].set_image(reader.item, image);
  }

  // ---- once a band ----

  void run_band(std::int64_t band, std::uint32_t slot) {
    Worker& worker = worker_for(slot);
    const int begin = static_cast<int>(band) * turn.band, end = std::min(begin + turn.band, height);
    for (std::size_t member = 0; member < members.size(); ++member) {
      worker.nodes[member].made = std::max(begin - members[member].ahead, 0);
      worker.nodes[member].is_dead = is_lost(member);
    }
    for (std::size_t value = 0; value < values.size(); ++value)
      worker.windows[value].first = worker.windows[value].made = worker.nodes[values[value].member].made;
    for (int row = begin; row < end; row += turn.rows)
      for (std::size_t member = 0; member < members.size(); ++member) {
        Worker::Node& node = worker.nodes[member];
        const auto is_dead = [&](std::size_t needed) { return worker.nodes[needed].is_dead; };
        node.is_dead = node.is_dead || std::ranges::any_of(members[member].needs, is_dead);
        if (node.is_dead) continue;
        const int to = std::min(std::min(row + turn.rows, end) + members[member].ahead, height);
        if (!run_rows(worker, member, to, begin, end)) fail(worker, member, band);
      }
  }

  // Computes a node's rows up to `to`. False when it fails.
  bool run_rows(Worker& worker, std::size_t member, int to, int band_begin, int band_end) {
    Worker::Node& node = worker.nodes[member];
    const int from = node.made;
    if (from >= to) return true;
    for (const std::size_t value : members[member].values)
      if (values[value].window_rows > 0) move_window(worker, value);
    const auto start = Clock::now();
    worker.host.set_rows(from, to, height);
    const quell_status status = members[member].pass->process(worker.host.raw(), node.exec);
    node.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    if (status != QUELL_OK || worker.host.has_own_error()) return false;
    node.made = to;
    for (const std::size_t value : members[member].values) {
      worker.windows[value].made = to;
      if (values[value].window_rows > 0 && values[value].whole)
        copy_rows(worker.windows[value], values[value], std::max(from, band_begin), std::min(to, band_end));
    }
    return true;
  }

  void fail(Worker& worker, std::size_t member, std::int64_t band) {
    worker.nodes[member].is_dead = true;
    std::string reason = worker.host.take_error();
    const std::scoped_lock lock(mutex);
    if (Failure& known = failures[member]; known.band < 0 || band < known.band) known = {band, std::move(reason)};
  }

  // Rows that nobody needs any more make room for those that come next.
  void move_window(Worker& worker, std::size_t index) const {
    const Value& value = values[index];
    Window& window = worker.windows[index];
    int first = window.made;
    for (const Reader& reader : value.readers)
      if (const Worker::Node& node = worker.nodes[reader.member]; !node.is_dead)
        first = std::min(first, node.made - reader.radius);
    first = std::max(first, window.first);
    const auto row = static_cast<std::size_t>(Image::row_stride(value.shape.size.width)) * sizeof(float);
    const std::size_t plane = row * at(value.window_rows);
    for (int c = 0; c < info(value.shape.type).channels && first < window.made && first > window.first; ++c)
      std::memmove(window.data + at(c) * plane, window.data + at(c) * plane + at(first - window.first) * row,
                   at(window.made - first) * row);
    window.first = first;
    show(worker, index, image_of(window, value));
  }

  // Coordinates are those of the whole image.
  static quell_image image_of(const Window& window, const Value& value) {
    const std::ptrdiff_t row = Image::row_stride(value.shape.size.width);
    const auto& about = info(value.shape.type);
    return {sizeof(quell_image),
            static_cast<std::uint32_t>(value.shape.type),
            static_cast<std::uint32_t>(about.format),
            static_cast<std::uint32_t>(about.channels),
            value.shape.size.width,
            value.shape.size.height,
            row,
            row * value.window_rows,
            reinterpret_cast<float*>(window.data) - window.first * row};
  }

  void copy_rows(const Window& window, const Value& value, int begin, int end) const {
    const quell_image from = image_of(window, value), to = item_of(value).image()->raw();
    for (std::uint32_t c = 0; c < from.channels; ++c)
      for (int y = begin; y < end; ++y)
        std::memcpy(static_cast<float*>(to.data) + c * to.plane_stride + y * to.row_stride,
                    static_cast<const float*>(from.data) + c * from.plane_stride + y * from.row_stride,
                    at(from.width) * sizeof(float));
  }
};

FusedRunner::FusedRunner(std::string name, const Plan& plan, const PlannedTurn& turn, const HostServices& services,
                         BufferPool& pool)
    : state_(std::make_unique<State>(std::move(name), plan, turn, services, pool)) {}
FusedRunner::~FusedRunner() = default;
FusedRunner::FusedRunner(FusedRunner&&) noexcept = default;

void FusedRunner::run(std::int64_t frame, Tables& tables) { state_->compute(frame, tables); }

}  // namespace quell
