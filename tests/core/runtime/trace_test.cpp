#include "quell/runtime/trace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <latch>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include "quell/text/json.h"

namespace quell {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Clock = Trace::Clock;
using std::chrono::microseconds;
using std::chrono::nanoseconds;

Json parse(const std::string& text) {
  Diagnostics errors;
  std::optional<Json> json = parse_json(std::make_shared<SourceText>(SourceText{"trace.json", text}), errors);
  EXPECT_THAT(errors.render(), IsEmpty());
  return json.value_or(Json{});
}

struct Slice {
  std::string lane, kind, name;
  std::int64_t frame = 0;
  double start = 0, end = 0;
};

std::map<std::int64_t, std::string> lane_names(const Json& events) {
  std::map<std::int64_t, std::string> names;
  for (const Json& event : events.elements)
    if (event.find("name")->string == "thread_name") names[event.find("tid")->integer] = event.find("args")->find("name")->string;
  return names;
}

std::vector<Slice> slices(const Json& events) {
  std::map<std::int64_t, std::string> names = lane_names(events);
  std::vector<Slice> found;
  for (const Json& event : events.elements) {
    if (event.find("ph")->string != "X") continue;
    const double start = event.find("ts")->number, duration = event.find("dur")->number;
    EXPECT_GE(start, 0);
    EXPECT_GE(duration, 0);
    found.push_back({names.at(event.find("tid")->integer), event.find("cat")->string, event.find("name")->string,
                     event.find("args")->find("frame")->integer, start, start + duration});
  }
  return found;
}

class Traced : public ::testing::Test {
 protected:
  std::ostringstream out_;
  Trace trace_{out_};
  Clock::time_point now_ = Clock::now();

  Json finish() {
    trace_.finish();
    return parse(out_.str());
  }
};

TEST_F(Traced, IsAListOfEventsThatIsWholeBehindEachOfThem) {
  EXPECT_EQ(parse(out_.str() + "]").elements.size(), 1U);
  trace_.slice(Trace::Kind::read, "color", 3, now_, now_ + microseconds(20));
  EXPECT_EQ(parse(out_.str() + "]").elements.size(), 3U) << "with the lane's name";
  trace_.memory({.in_use = 1, .idle = 0, .peak = 1, .allocated = 1});
  EXPECT_EQ(parse(out_.str() + "]").elements.size(), 4U);
  EXPECT_EQ(finish().elements.size(), 4U);
}

TEST_F(Traced, TellsKindNameFrameAndTimesInMicroseconds) {
  trace_.slice(Trace::Kind::node, "filter", -7, now_, now_ + nanoseconds(12'345));
  const auto all = slices(finish());
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].kind, "node");
  EXPECT_EQ(all[0].name, "filter");
  EXPECT_EQ(all[0].frame, -7);
  EXPECT_NEAR(all[0].end - all[0].start, 12.345, 1e-6);
}

TEST_F(Traced, EscapesNames) {
  const std::string name = "a \"quoted\" \\ name\nwith ä";
  trace_.slice(Trace::Kind::write, name, 1, now_, now_);
  EXPECT_EQ(slices(finish()).at(0).name, name);
}

TEST_F(Traced, KeepsWhatLiesInsideAnotherSliceInside) {
  // A loop's part within a node, both at times whose microseconds are not whole.
  for (int i = 0; i < 1000; ++i) {
    const auto start = now_ + nanoseconds(i * 1'000'003);
    trace_.slice(Trace::Kind::help, "inner", i, start, start + nanoseconds(333));
    trace_.slice(Trace::Kind::node, "outer", i, start, start + nanoseconds(334));
  }
  const auto all = slices(finish());
  ASSERT_EQ(all.size(), 2000U);
  for (std::size_t i = 0; i < all.size(); i += 2) {
    EXPECT_EQ(all[i].start, all[i + 1].start);
    EXPECT_LT(all[i].end, all[i + 1].end) << i;
  }
}

TEST_F(Traced, HasNothingBeforeItsStartAndNoTimeThatRunsBackwards) {
  trace_.slice(Trace::Kind::node, "early", 1, now_ - std::chrono::hours(1), now_);
  trace_.slice(Trace::Kind::node, "earlier", 1, now_ - std::chrono::hours(2), now_ - std::chrono::hours(1));
  EXPECT_EQ(slices(finish()).size(), 2U);  // which looks at both
}

TEST_F(Traced, CallsAThreadThatDoesAllThingsTheSession) {
  for (const auto kind : {Trace::Kind::read, Trace::Kind::node, Trace::Kind::write}) trace_.slice(kind, "x", 1, now_, now_);
  const Json events = finish();
  EXPECT_EQ(lane_names(events).size(), 1U);
  for (const Slice& slice : slices(events)) EXPECT_EQ(slice.lane, "session");
}

TEST_F(Traced, TakesEventsFromSeveralThreadsAtOnce) {
  using enum Trace::Kind;
  constexpr int kThreads = 4, kEvents = 500;
  constexpr std::array kKinds{node, help, read, write};
  std::latch all_there(kThreads);
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t)
      threads.emplace_back([&, t] {
        all_there.arrive_and_wait();  // so that no two have the same number one after the other
        for (int i = 0; i < kEvents; ++i) {
          trace_.slice(kKinds[static_cast<std::size_t>(t)], "thread " + std::to_string(t), i, now_, Clock::now());
          trace_.memory({.in_use = static_cast<std::size_t>(i), .idle = 0, .peak = 0, .allocated = 0});
        }
      });
  }
  std::map<std::string, std::set<std::string>> lanes;
  std::map<std::string, int> counts;
  for (const Slice& slice : slices(finish())) {
    lanes[slice.name].insert(slice.lane);
    ++counts[slice.name];
  }
  std::set<std::string> names;
  for (const auto& [thread, lane] : lanes) {
    EXPECT_EQ(counts[thread], kEvents) << thread;
    ASSERT_EQ(lane.size(), 1U) << thread;
    names.insert(*lane.begin());
  }
  EXPECT_THAT(names, ElementsAre("compute 1", "compute 2", "files 1", "files 2")) << "by what each thread does";
}

TEST_F(Traced, CountsMemoryInMebibytesWhenItChanges) {
  trace_.memory({.in_use = 3 << 20, .idle = 1 << 19, .peak = 0, .allocated = 0});
  trace_.memory({.in_use = 3 << 20, .idle = 1 << 19, .peak = 0, .allocated = 7});
  trace_.memory({.in_use = 0, .idle = 7 << 19, .peak = 0, .allocated = 7});
  std::vector<double> in_use, idle, times;
  for (const Json& event : finish().elements) {
    if (event.find("ph")->string != "C") continue;
    times.push_back(event.find("ts")->number);
    in_use.push_back(event.find("args")->find("in use")->number);
    idle.push_back(event.find("args")->find("idle")->number);
  }
  EXPECT_THAT(in_use, ElementsAre(3, 0));
  EXPECT_THAT(idle, ElementsAre(0.5, 3.5));
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

TEST_F(Traced, TakesNothingMoreWhenFinished) {
  trace_.finish();
  const std::string text = out_.str();
  trace_.slice(Trace::Kind::node, "late", 1, now_, now_);
  trace_.memory({.in_use = 1, .idle = 0, .peak = 0, .allocated = 0});
  trace_.finish();
  EXPECT_EQ(out_.str(), text);
}

}  // namespace
}  // namespace quell
