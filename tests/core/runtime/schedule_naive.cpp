#include "tests/core/runtime/schedule_naive.h"

#include <algorithm>
#include <optional>

#include "tests/core/runtime/passes/ring.h"

namespace quell::test {
namespace {

using Maybe = std::optional<Picture>;

// What one node makes of one frame.
struct Result {
  bool ok = false;
  bool is_culprit = false;        // failed itself, rather than lacking what it needs
  std::vector<Maybe> items = {};  // of its output
};

std::int64_t at(const Picture& picture, int x, int y, int c) {
  const int plane = std::min(c, info(picture.type).channels - 1);
  return static_cast<std::int64_t>(
      picture.numbers[static_cast<std::size_t>((plane * picture.size.height + y) * picture.size.width + x)]);
}

template <class Pixel>
Picture paint(PortType type, Size size, const Pixel& pixel) {
  Picture picture{type, size, {}};
  for (int c = 0; c < info(type).channels; ++c)
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) picture.numbers.push_back(static_cast<double>(pixel(x, y, c) % ring::kModulus));
  return picture;
}

// The passes, pixel by pixel.
class Passes {
 public:
  Passes(const TestNode& node, Picture main, Maybe other, std::vector<Maybe> list, std::int64_t frame)
      : node_(node), main_(std::move(main)), other_(std::move(other)), list_(std::move(list)), frame_(frame) {}

  Picture run() const {
    const auto same = [&](const auto& pixel) { return paint(main_.type, main_.size, pixel); };
    const Size size = main_.size;
    switch (node_.kind) {
      case Kind::stir:
        return same([&](int x, int y, int c) { return stir(x, y, c); });
      case Kind::soften:
        return same([&](int x, int y, int c) { return soften(x, y, c); });
      case Kind::shelter:
        return same([&](int x, int y, int c) { return node_.salt + 2 * at(main_, x, size.height - 1 - y, c); });
      case Kind::falter:
        return same([&](int x, int y, int c) { return node_.salt + at(main_, x, y, c); });
      case Kind::apply:
        return same([&](int x, int y, int c) { return apply(at(main_, x, y, c)); });
      case Kind::tally:
        return tally();
      case Kind::pulse: {
        const bool is_named = std::ranges::find(node_.fails, frame_) != node_.fails.end();
        return {QUELL_TYPE_VALUE, {}, {is_named ? 1.0 : 0.0, 17}};
      }
      case Kind::reduce:
        return paint(QUELL_TYPE_SCALAR, size, [&](int x, int y, int) { return reduce(x, y); });
      case Kind::shrink:
        return paint(main_.type, {(size.width + 1) / 2, (size.height + 1) / 2},
                     [&](int x, int y, int c) { return node_.salt + at(main_, 2 * x, 2 * y, c); });
      default:
        return {};
    }
  }
  Picture part(std::size_t i, PortType type) const {
    return paint(type, main_.size, [&](int x, int y, int c) {
      const std::int64_t own = list_[i] ? 2 * at(*list_[i], x, y, c) : 29;
      return node_.salt + static_cast<std::int64_t>(i) + own + 3 * at(main_, x, y, c);
    });
  }

 private:
  std::int64_t stir(int x, int y, int c) const {
    std::int64_t sum = node_.salt + 3 * at(main_, x, y, c) + (other_ ? 5 * at(*other_, x, y, c) : 7);
    for (int i = 0; i < static_cast<int>(list_.size()); ++i) {
      const Maybe& more = list_[static_cast<std::size_t>(i)];
      sum += more ? (11 + 2 * i) * at(*more, x, y, c) : 13 + i;
    }
    return sum;
  }
  std::int64_t soften(int x, int y, int c) const {
    const int r = node_.radius;
    std::int64_t sum = node_.salt;
    for (int v = std::max(0, y - r); v <= std::min(main_.size.height - 1, y + r); ++v)
      for (int u = std::max(0, x - r); u <= std::min(main_.size.width - 1, x + r); ++u)
        sum += (3 + u - x + r + 5 * (v - y + r)) * at(main_, u, v, c);
    return sum;
  }
  std::int64_t reduce(int x, int y) const {
    std::int64_t sum = node_.salt;
    for (int c = 0; c < info(main_.type).channels; ++c) sum += (c + 1) * at(main_, x, y, c);
    return sum;
  }
  std::int64_t apply(std::int64_t pixel) const {
    if (!other_) return node_.salt + pixel;
    return node_.salt + pixel * static_cast<std::int64_t>(other_->numbers[0]) + static_cast<std::int64_t>(other_->numbers[1]);
  }
  Picture tally() const {
    const std::int64_t before = other_ ? 3 * static_cast<std::int64_t>(other_->numbers[0]) : 31;
    const std::int64_t sum = node_.salt + before + at(main_, 0, 0, 0);
    return {QUELL_TYPE_VALUE,
            {},
            {static_cast<double>(sum % ring::kModulus), static_cast<double>((frame_ + ring::kModulus) % ring::kModulus)}};
  }

  const TestNode& node_;
  Picture main_;
  Maybe other_;
  std::vector<Maybe> list_;
  std::int64_t frame_;
};

class Naive {
 public:
  Naive(const TestGraph& graph, const Scene& scene) : graph_(graph), scene_(scene) {
    for (const Place& place : graph.outputs) need(place);
    for (const Place& place : graph.dumps) need(place);
    // History starts anew with every change of size; frames that cannot be read change nothing.
    int age = 0;
    Size size = scene.size;
    for (const std::int64_t frame : scene.frames) {
      if (!is_readable(frame)) continue;
      if (scene.size_of(frame) != size) ++age, size = scene.size_of(frame);
      ages_[frame] = age;
    }
  }

  Outcome run(const std::vector<std::string>& order) {
    Outcome outcome;
    for (const std::int64_t frame : scene_.frames) {
      FrameReport& report = outcome.reports.emplace_back();
      report.frame = frame;
      report.ok = is_readable(frame) && !scene_.unwritable.contains(frame);
      if (!is_readable(frame)) continue;
      count_replaced(report);
      report.node = culprit(frame, order);
      report.ok &= report.node.empty();
      if (!report.ok) continue;
      for (std::size_t i = 0; i < graph_.outputs.size(); ++i)
        outcome.pictures[{"out" + std::to_string(i), frame}] = *find(graph_.outputs[i], frame);
      for (const Place& dump : graph_.dumps)
        outcome.pictures[{(dump.node < 0 ? "input." : "") + graph_.name(dump), frame}] = *find(dump, frame);
    }
    return outcome;
  }

 private:
  // Marks what is computed and read at all.
  void need(const Place& place) {
    if (!graph_.present(place) || !needed_.insert({place.node, place.node < 0 ? place.port : 0}).second || place.node < 0) return;
    for (const Wire& wire : wires(graph_.node(place))) {
      need(wire.from);
      if (wire.delay != 0 && wire.start == Wire::Start::place) need(wire.place);
    }
    for (const Place& reset : heeded(place.node)) need(reset);
  }
  // What resets the node's history, when it reads any.
  std::vector<Place> heeded(int index) const {
    const std::vector<Wire> all = wires(graph_.nodes[static_cast<std::size_t>(index)]);
    if (std::ranges::none_of(all, [&](const Wire& wire) { return wire.delay > 0 && graph_.present(wire.from); })) return {};
    std::vector<Place> places = graph_.resets_of(index);
    std::erase_if(places, [&](const Place& place) { return !graph_.present(place); });
    return places;
  }
  bool is_cut(std::int64_t a, std::int64_t b) const {
    return std::ranges::any_of(scene_.cuts, [&](std::int64_t cut) { return std::min(a, b) < cut && cut <= std::max(a, b); });
  }
  // Whether one of the frames after `earlier`, up to `later`, resets the history of the node.
  bool is_reset(int index, std::int64_t earlier, std::int64_t later) {
    for (const auto& [frame, age] : ages_)
      for (const Place& reset : heeded(index))
        if (earlier < frame && frame <= later)
          if (const Maybe flag = find(reset, frame); flag && flag->numbers[0] != 0) return true;
    return false;
  }
  bool is_needed(int node, int port = 0) const { return needed_.contains({node, port}); }

  bool is_readable(std::int64_t frame) const {
    for (int i = 0; i < static_cast<int>(graph_.inputs.size()); ++i)
      if (is_needed(-1, i) && scene_.unreadable.contains({graph_.inputs[static_cast<std::size_t>(i)].name, frame})) return false;
    return true;
  }

  void count_replaced(FrameReport& report) const {
    for (int i = 0; i < static_cast<int>(graph_.inputs.size()); ++i) {
      const TestInput& input = graph_.inputs[static_cast<std::size_t>(i)];
      if (is_needed(-1, i) && scene_.dirty.contains(report.frame)) report.replaced.push_back({input.name, input.type, 1});
    }
  }

  std::string culprit(std::int64_t frame, const std::vector<std::string>& order) {
    for (const std::string& name : order)
      for (int node = 0; node < static_cast<int>(graph_.nodes.size()); ++node)
        if (graph_.name(node) == name && is_needed(node) && result(node, frame).is_culprit) return name;
    return {};
  }

  Picture input(int port, std::int64_t frame) const {
    const bool dirty = scene_.dirty.contains(frame);
    return paint(graph_.inputs[static_cast<std::size_t>(port)].type, scene_.size_of(frame), [&](int x, int y, int c) {
      return dirty && Scene::is_dirty_pixel(x, y, c) ? 0 : pattern(port, frame, x, y, c);
    });
  }

  // What stands there in a frame that was read.
  Maybe find(const Place& place, std::int64_t frame) {
    if (!graph_.present(place)) return {};
    if (place.node < 0) return input(place.port, frame);
    const Result& of_node = result(place.node, frame);
    return of_node.ok ? of_node.items[static_cast<std::size_t>(place.item)] : Maybe();
  }

  Maybe fetch(int index, const Wire& wire, std::int64_t frame, Size size) {
    if (wire.delay == 0) return find(wire.from, frame);
    const std::int64_t other = frame - wire.delay;
    Maybe found;
    const bool is_same_age = ages_.contains(other) && ages_.at(other) == ages_.at(frame) && !is_cut(other, frame);
    if (wire.delay > 0 && is_same_age && !is_reset(index, other, frame)) found = find(wire.from, other);
    if (wire.delay < 0 && !is_cut(frame, other)) found = look_ahead(wire.from, other, scene_.size_of(frame));
    if (found || wire.start == Wire::Start::none) return found;
    if (wire.start == Wire::Start::place) return find(wire.place, frame);
    const PortType type = graph_.type(wire.from);
    const auto constant = static_cast<double>(wire.constant);
    if (type == QUELL_TYPE_VALUE) return Picture{type, {}, {constant, 17}};
    return paint(type, size, [&](int, int, int) { return std::int64_t{wire.constant}; });
  }

  Maybe look_ahead(const Place& place, std::int64_t frame, Size size) const {
    const TestInput& from = graph_.inputs[static_cast<std::size_t>(place.port)];
    const bool is_there = std::ranges::find(scene_.frames, frame) != scene_.frames.end();
    if (!is_there || from.absent || scene_.unreadable.contains({from.name, frame}) || scene_.size_of(frame) != size) return {};
    return input(place.port, frame);
  }

  bool has_what_it_needs(int index, std::int64_t frame) {
    const TestNode& node = graph_.nodes[static_cast<std::size_t>(index)];
    for (const Place& reset : heeded(index))
      if (!result(reset.node, frame).ok) return false;
    for (const Wire& wire : wires(node)) {
      const Place* needed = wire.delay == 0 ? &wire.from : wire.start == Wire::Start::place ? &wire.place : nullptr;
      if (needed && needed->node >= 0 && graph_.present(*needed) && !result(needed->node, frame).ok) return false;
    }
    return true;
  }

  const Result& result(int index, std::int64_t frame) {
    const auto known = results_.find({index, frame});
    if (known != results_.end()) return known->second;
    Result made = compute(index, frame);
    return results_[{index, frame}] = std::move(made);
  }

  Result compute(int index, std::int64_t frame) {
    const TestNode& node = graph_.nodes[static_cast<std::size_t>(index)];
    if (!has_what_it_needs(index, frame)) return {};
    if (node.kind == Kind::falter && std::ranges::find(node.fails, frame) != node.fails.end()) return {false, true};
    Picture main = *fetch(index, node.main[0], frame, level_size(graph_.level(node.main[0].from), frame));
    const Size size = main.size;
    Maybe other = node.other.empty() ? Maybe() : fetch(index, node.other[0], frame, size);
    std::vector<Maybe> list;
    for (const Wire& wire : node.list) list.push_back(fetch(index, wire, frame, size));
    const Passes passes(node, std::move(main), std::move(other), std::move(list), frame);
    Result made{true};
    if (node.kind != Kind::parts) made.items = {passes.run()};
    for (int i = 0; node.kind == Kind::parts && i < static_cast<int>(node.list.size()); ++i) {
      const Place item{index, 0, i};
      made.items.push_back(graph_.present(item) ? Maybe(passes.part(static_cast<std::size_t>(i), graph_.type(item))) : Maybe());
    }
    return made;
  }

  Size level_size(int level, std::int64_t frame) const {
    Size size = scene_.size_of(frame);
    for (; level > 0; --level) size = {(size.width + 1) / 2, (size.height + 1) / 2};
    return size;
  }

  const TestGraph& graph_;
  const Scene& scene_;
  std::set<std::pair<int, int>> needed_;  // nodes, and -1 with an input
  std::map<std::int64_t, int> ages_;      // of frames that can be read; history reaches back within one
  std::map<std::pair<int, std::int64_t>, Result> results_;
};

}  // namespace

Outcome compute_naively(const TestGraph& graph, const Scene& scene, const std::vector<std::string>& order) {
  return Naive(graph, scene).run(order);
}

Outcome without_words(Outcome outcome) {
  for (FrameReport& report : outcome.reports) report.error.clear();
  return outcome;
}

}  // namespace quell::test
