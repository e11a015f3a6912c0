#include "tests/core/runtime/schedule_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "tests/core/runtime/passes/ring.h"

namespace quell::test {

Size Scene::size_of(std::int64_t frame) const {
  const auto found = odd.find(frame);
  return found == odd.end() ? size : found->second;
}

Scene random_scene(Dice& dice) {
  Scene scene;
  const int count = dice.from(5, 11);
  std::int64_t frame = dice.from(-5, 100);
  for (int i = 0; i < count; ++i, frame += dice.chance(80) ? 1 : dice.from(2, 4)) scene.frames.push_back(frame);
  scene.size = {dice.from(1, 17), dice.chance(20) ? dice.from(40, 90) : dice.from(1, 25)};
  const auto any = [&] { return dice.pick(scene.frames); };
  if (dice.chance(25)) scene.unreadable.emplace(dice.chance(50) ? "a" : "s", any());
  if (dice.chance(15)) scene.unreadable.emplace("b", any());
  if (dice.chance(25)) scene.unwritable.insert(any());
  if (dice.chance(25)) scene.dirty.insert(any());
  for (int changes = dice.chance(30) ? dice.from(1, 3) : 0; changes > 0; --changes)
    scene.odd[any()] = {dice.from(1, 9), dice.from(1, 9)};
  for (int cuts = dice.chance(30) ? dice.from(1, 2) : 0; cuts > 0; --cuts) scene.cuts.push_back(any() + dice.below(2));
  return scene;
}

// As large as can be without a step from pixel to pixel or frame to frame that a mistake could hide behind.
std::int64_t pattern(int input, std::int64_t frame, int x, int y, int c) {
  std::uint64_t state = static_cast<std::uint64_t>(frame) * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(input);
  for (const int part : {x, y, c}) state = (state ^ static_cast<std::uint64_t>(part)) * 0xbf58476d1ce4e5b9u, state ^= state >> 29;
  return static_cast<std::int64_t>(state % static_cast<std::uint64_t>(ring::kModulus));
}

std::optional<Shape> PatternSource::shape(std::string_view input) {
  for (const TestInput& known : inputs_)
    if (known.name == input && !known.absent) return Shape{known.type, scene_.size, 0, true};
  return std::nullopt;
}

Item PatternSource::read(std::string_view input, std::int64_t frame, BufferPool& pool) {
  if (on_read) on_read(input, frame);
  if (scene_.unreadable.contains({std::string(input), frame}))
    throw Error(Fault::input, std::string(input) + "." + std::to_string(frame) + ".exr", "no such file");
  const auto known = std::ranges::find(inputs_, input, &TestInput::name);
  Image image(known->type, scene_.size_of(frame), pool);
  const FloatOutput view = image.writable_floats();
  for (int c = 0; c < view.channels; ++c)
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x)
        view.at(x, y, c) = static_cast<float>(pattern(static_cast<int>(known - inputs_.begin()), frame, x, y, c));
  if (scene_.dirty.contains(frame)) view.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
  return image;
}

bool Picture::operator==(const Picture& other) const {
  return type == other.type && size == other.size && numbers.size() == other.numbers.size() &&
         (numbers.empty() || std::memcmp(numbers.data(), other.numbers.data(), numbers.size() * sizeof(double)) == 0);
}

Picture picture(const Item& item) {
  if (item.values()) return {QUELL_TYPE_VALUE, {}, {item.values()->begin(), item.values()->end()}};
  const Image& image = *item.image();
  Picture copy{image.type(), image.size(), {}};
  for (int c = 0; c < image.channels(); ++c)
    for (int y = 0; y < image.height(); ++y) {
      const float* row = image.floats().row(y, c);
      copy.numbers.insert(copy.numbers.end(), row, row + image.width());
    }
  return copy;
}

void RecordingSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  if (on_write) on_write(output, frame);
  if (unwritable_.contains(frame)) throw Error(Fault::frame, std::string(output) + ".exr", "disk full");
  {
    const std::scoped_lock lock(mutex_);
    const bool is_new = pictures_.emplace(std::pair(std::string(output), frame), picture(item)).second;
    EXPECT_TRUE(is_new) << output << " of frame " << frame << " is handed out twice";
  }
  if (on_written) on_written(output, frame);
}

Pictures RecordingSink::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(pictures_, {});
}

namespace {

std::string describe(const FrameReport& report) {
  std::string text = "frame " + std::to_string(report.frame) + (report.ok ? ": ok" : ": failed") + ", node '" + report.node + "'";
  // Of a frame that cannot be read, how much of it was read is left open.
  if (report.ok || !report.node.empty())
    for (const ReplacedValues& replaced : report.replaced) text += ", " + quell::describe(replaced);
  return text + ", " + report.error;
}

std::vector<std::string> describe(const std::vector<FrameReport>& reports) {
  std::vector<std::string> list;
  for (const FrameReport& report : reports) list.push_back(describe(report));
  return list;
}

std::string first_difference(const Picture& got, const Picture& want) {
  if (got.numbers.size() != want.numbers.size()) return "another size";
  for (std::size_t i = 0; i < got.numbers.size(); ++i)
    if (std::memcmp(&got.numbers[i], &want.numbers[i], sizeof(double)) != 0)
      return "number " + std::to_string(i) + " of " + std::to_string(got.numbers.size()) + " is " +
             std::to_string(got.numbers[i]) + ", not " + std::to_string(want.numbers[i]);
  return "another type";
}

}  // namespace

void expect_same(const Outcome& got, const Outcome& want) {
  EXPECT_EQ(describe(got.reports), describe(want.reports));
  for (const auto& [key, pictured] : want.pictures) {
    const auto found = got.pictures.find(key);
    if (found == got.pictures.end())
      ADD_FAILURE() << key.first << " of frame " << key.second << " is not handed out";
    else if (!(found->second == pictured))
      ADD_FAILURE() << key.first << " of frame " << key.second << ": " << first_difference(found->second, pictured);
  }
  for (const auto& [key, pictured] : got.pictures)
    EXPECT_TRUE(want.pictures.contains(key)) << key.first << " of frame " << key.second << " is handed out";
}

Setting setting(int number) { return {1 << (number % 4), 1 << (number / 4 % 4)}; }

std::string describe(const Setting& setting) {
  return std::to_string(setting.threads) + " threads, " + std::to_string(setting.frames) + " frames in flight";
}

SessionOptions concurrent(const Setting& setting) {
  return {.threads = setting.threads, .schedule = Schedule::concurrent, .frames_in_flight = setting.frames};
}

SessionOptions serial() { return {.threads = 1, .schedule = Schedule::serial}; }

Outcome run(const std::shared_ptr<const Graph>& graph, const std::vector<TestInput>& inputs, const Scene& scene,
            SessionOptions options, bool keeps_busy) {
  PatternSource source(inputs, scene);
  RecordingSink sink(scene.unwritable);
  source.keeps_busy = sink.keeps_busy = keeps_busy;
  options.cuts = scene.cuts;
  Session session(graph, std::move(options));
  session.pool().fill(0xff);
  Outcome outcome;
  outcome.reports = session.run(scene.frames, source, sink);
  outcome.pictures = sink.take();
  return outcome;
}

Outcome run_in_parts(const std::shared_ptr<const Graph>& graph, const std::vector<TestInput>& inputs, const Scene& scene,
                     const SessionOptions& options, const std::set<std::int64_t>& last_frames) {
  PatternSource source(inputs, scene);
  RecordingSink sink(scene.unwritable);
  Outcome outcome;
  std::optional<SavedHistory> saved;
  std::vector<std::int64_t> part;
  for (const std::int64_t frame : scene.frames) {
    part.push_back(frame);
    if (frame != scene.frames.back() && !last_frames.contains(frame)) continue;
    SessionOptions again = options;
    again.cuts = scene.cuts;
    Session session(graph, std::move(again));
    session.pool().fill(0xff);
    if (saved) session.restore(*saved);
    const std::vector<std::int64_t> later(std::ranges::upper_bound(scene.frames, frame), scene.frames.end());
    for (FrameReport& report : session.run(part, source, sink, {.later = later})) outcome.reports.push_back(std::move(report));
    saved = session.save();
    EXPECT_TRUE(saved && saved->frame == frame);
    part.clear();
  }
  outcome.pictures = sink.take();
  return outcome;
}

Outcome run_for_history(const std::shared_ptr<const Graph>& graph, const std::vector<TestInput>& inputs, const Scene& scene,
                        SessionOptions options, const std::vector<std::int64_t>& history_only) {
  PatternSource source(inputs, scene);
  RecordingSink sink(scene.unwritable);
  options.cuts = scene.cuts;
  Session session(graph, std::move(options));
  session.pool().fill(0xff);
  Outcome outcome;
  outcome.reports = session.run(scene.frames, source, sink, {.history_only = history_only});
  outcome.pictures = sink.take();
  return outcome;
}

void expect_same_in_all_settings(const std::shared_ptr<const Graph>& graph, const std::vector<TestInput>& inputs,
                                 const Scene& scene, const std::vector<std::string>& dumps) {
  SessionOptions options = serial();
  options.dumps = dumps;
  const Outcome want = run(graph, inputs, scene, options);
  for (int number = 0; number < kSettings; ++number) {
    SCOPED_TRACE(describe(setting(number)));
    options = concurrent(setting(number));
    options.dumps = dumps;
    expect_same(run(graph, inputs, scene, options, number % 3 == 0), want);
  }
}

}  // namespace quell::test
