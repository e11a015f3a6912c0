#include "node_times.h"

#include <gmock/gmock.h>

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Plan plan_of(const std::vector<std::string>& names) {
  auto graph = std::make_shared<Graph>();
  Plan plan;
  for (const std::string& name : names) {
    plan.nodes.emplace_back().node = static_cast<int>(graph->nodes.size());
    graph->nodes.emplace_back().name = name;
  }
  plan.graph = graph;
  return plan;
}

FrameReport report(std::vector<double> node_seconds, double read_seconds = 0, double write_seconds = 0) {
  FrameReport result;
  result.node_seconds = std::move(node_seconds);
  result.read_seconds = read_seconds;
  result.write_seconds = write_seconds;
  return result;
}

TEST(TimeTable, AddsUpFramesAndPutsTheCostliestFirst) {
  EXPECT_EQ(time_table(plan_of({"cheap", "costly_one"}), {report({0.25, 0.5}, 0.5, 0.0625), report({0.25, 1.0}, 0.25, 0)}, 100),
            "time of all frames added up:\n"
            "                        total   a frame  share\n"
            "  costly_one            1.5 s    750 ms    75%\n"
            "  cheap                0.50 s    250 ms    25%\n"
            "  reading files        0.75 s    375 ms\n"
            "  writing files        0.06 s   62.5 ms");
}

TEST(TimeTable, SaysWhereThingsOverlapped) {
  EXPECT_THAT(time_table(plan_of({"a", "b"}), {report({2, 1}, 1)}, 3),
              HasSubstr("time of all frames added up, 4.0 s of work in 3.0 s:\n"));
}

TEST(TimeTable, TakesTheMeanOverTheFramesInWhichANodeRan) {
  EXPECT_THAT(time_table(plan_of({"a"}), {report({0.002}), report({0}), report({})}, 1), HasSubstr("  2.00 ms "));
}

TEST(TimeTable, LeavesOutWhatDidNotRun) {
  const std::string table = time_table(plan_of({"kept", "ran"}), {report({0, 1}), report({0, 1})}, 2);
  EXPECT_THAT(table, HasSubstr("\n  ran "));
  EXPECT_THAT(table, Not(HasSubstr("kept")));
}

TEST(TimeTable, IsEmptyWhenNothingRan) {
  EXPECT_EQ(time_table(plan_of({"a"}), {}, 1), "");
  EXPECT_EQ(time_table(plan_of({"a"}), {report({0}, 1)}, 1), "");
}

TEST(TimeTable, LeavesOutTheCheapestOfMany) {
  std::vector<std::string> names;
  std::vector<double> seconds;
  for (int i = 0; i < 23; ++i) {
    names.push_back("node" + std::to_string(i));
    seconds.push_back(i + 1);
  }
  const std::string table = time_table(plan_of(names), {report(seconds, 1)}, 1000);
  EXPECT_THAT(table, HasSubstr("  node3    "));
  EXPECT_THAT(table, Not(HasSubstr("  node2    ")));
  EXPECT_THAT(table, HasSubstr("\n  and 3 more\n  reading files"));
}

}  // namespace
}  // namespace quell::app::testing
