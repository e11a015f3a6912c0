#include "quell/runtime/node_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>

#include "quell/sdk/pass.h"
#include "quell/text/error.h"

namespace quell {
namespace {

using testing::Each;
using testing::ElementsAre;

// What the pass under test does; one test runs at a time.
std::function<void(const Frame&)> behavior;

struct NoParams {};

class Scripted final : public Pass {
 public:
  explicit Scripted(const NoParams&) {}
  void run(const Frame& frame) const override { behavior(frame); }
};

const PassInfo kInfo{
    .id = "scripted",
    .summary = "what the test says",
    .source = "test",
    .inputs = {{.name = "color", .types = kColor, .doc = "read"},
               {.name = "values", .types = kValue, .doc = "read", .optional = true}},
    .outputs = {{.name = "color", .types = kColor, .doc = "written"}, {.name = "values", .types = kValue, .doc = "written"}}};

constexpr Size kSize{40, 64};

class NodeRunnerTest : public testing::Test {
 protected:
  BufferPool pool;
  std::unique_ptr<Executor> executor = make_executor(2);
  HostServices services{.executor = executor.get()};
  PassInstance pass{*detail::Descriptor::make<Scripted, NoParams>(kInfo).get(), {}};
  NodeLayout layout{.outputs = {{{QUELL_TYPE_COLOR, kSize}}, {{QUELL_TYPE_VALUE, {}, 4}}}, .in_place_of = {0, -1}};
  PortItems inputs, outputs;

  void give_inputs() { inputs = {{Image(QUELL_TYPE_COLOR, kSize, pool)}, {Values{1, 2}}}; }
  void run() {
    give_inputs();
    NodeRunner("node", pass, layout, services, pool).run(7, inputs, outputs);
  }
  // Nothing is left behind, whatever happened.
  void expect_nothing_held() const {
    for (const PortItems* ports : {&inputs, &outputs})
      for (const std::vector<Item>& items : *ports) EXPECT_THAT(items, Each(testing::ResultOf(&is_there, false)));
    EXPECT_EQ(pool.usage().in_use, 0U);
  }
  static bool is_there(const Item& item) { return static_cast<bool>(item); }
};

TEST_F(NodeRunnerTest, HandsValuesInAndOut) {
  behavior = [](const Frame& frame) {
    const std::span<const double> in = frame.values("values");
    const std::span<double> out = frame.output_values("values");
    out[0] = in[0] + in[1];
  };
  run();
  EXPECT_THAT(*outputs[1][0].values(), ElementsAre(3, 0, 0, 0));
}

TEST_F(NodeRunnerTest, LetsAPassYieldFewerValuesThanItAskedFor) {
  quell_pass_desc short_desc = pass.desc();
  short_desc.process = [](const void*, const quell_host*, const quell_exec* exec) -> quell_status {
    QUELL_AT(quell_port, exec->outputs, 1)->items->values->data[0] = 5;
    QUELL_AT(quell_port, exec->outputs, 1)->items->values->count = 2;
    return QUELL_OK;
  };
  const PassInstance short_pass(short_desc, {});
  give_inputs();
  NodeRunner("node", short_pass, layout, services, pool).run(7, inputs, outputs);
  EXPECT_THAT(*outputs[1][0].values(), ElementsAre(5, 0));
}

TEST_F(NodeRunnerTest, WritesOverAnInputThatNobodyElseHolds) {
  behavior = [](const Frame&) {};
  give_inputs();
  const void* pixels = inputs[0][0].image()->buffer().data();
  NodeRunner runner("node", pass, layout, services, pool);
  runner.run(7, inputs, outputs);
  EXPECT_EQ(outputs[0][0].image()->buffer().data(), pixels);

  inputs[0][0] = outputs[0][0];
  const Item also_held = inputs[0][0];
  runner.run(8, inputs, outputs);
  EXPECT_NE(outputs[0][0].image()->buffer().data(), pixels);
}

TEST_F(NodeRunnerTest, LetsItemsGoAndKeepsTables) {
  behavior = [](const Frame&) {};
  run();
  ASSERT_EQ(inputs.size(), 2U);
  ASSERT_EQ(inputs[1].size(), 1U);
  EXPECT_FALSE(inputs[0][0]);
  EXPECT_FALSE(inputs[1][0]);
  for (std::vector<Item>& items : outputs) std::ranges::fill(items, Item());
  EXPECT_EQ(pool.usage().in_use, 0U);
}

TEST_F(NodeRunnerTest, LeavesNothingBehindWhenThePassFails) {
  behavior = [](const Frame& frame) {
    if (frame.number() == 7) throw std::runtime_error("no luck");
  };
  try {
    run();
    FAIL() << "nothing was thrown";
  } catch (const Error& error) { EXPECT_STREQ(error.what(), "node: no luck"); }
  expect_nothing_held();
}

// Only x86 and ARM can; elsewhere what is tiny is merely slow.
#if defined(__SSE2__) || defined(__aarch64__)
TEST_F(NodeRunnerTest, CountsWhatIsTinyAsNothingInLoopsAlone) {
  volatile float small = 1e-30F;
  std::atomic<int> tiny = 0, bands = 0;
  behavior = [&](const Frame& frame) {
    frame.parallel_rows(
        kSize.height, [&](int, int) { ++bands, tiny += small * 1e-10F != 0 ? 1 : 0; }, 1);
  };
  run();
  EXPECT_EQ(bands, kSize.height);
  EXPECT_EQ(tiny, 0);
  EXPECT_NE(small * 1e-10F, 0);
}
#endif

TEST_F(NodeRunnerTest, TakesALoopThatWasCutShortForCancelledWhateverThePassMakesOfIt) {
  std::atomic<int> bands = 0;
  services.cancelled = [&] { return bands >= 2; };
  behavior = [&](const Frame& frame) {
    try {
      frame.parallel_rows(
          kSize.height, [&](int, int) { ++bands; }, 1);
    } catch (const Cancelled&) {  // deaf
    }
  };
  EXPECT_THROW(run(), Cancelled);
  EXPECT_LT(bands, kSize.height);
  expect_nothing_held();
}

TEST_F(NodeRunnerTest, TakesAFailureAfterCancellationForCancelled) {
  services.cancelled = [] { return true; };
  behavior = [&](const Frame& frame) {
    if (frame.cancelled()) throw std::runtime_error("stopped half way");
  };
  EXPECT_THROW(run(), Cancelled);
}

TEST_F(NodeRunnerTest, YieldsAResultWhenThePassLearnedOfNoCancellation) {
  std::atomic<int> asked = 0;
  services.cancelled = [&] { return ++asked > 0; };
  behavior = [](const Frame&) {};
  run();
  EXPECT_TRUE(outputs[0][0]);
  EXPECT_EQ(asked, 0);
}

TEST_F(NodeRunnerTest, ForgetsACancellationWithTheNextFrame) {
  bool cancel = true;
  services.cancelled = [&] { return cancel; };
  behavior = [](const Frame& frame) { frame.parallel_rows(8, [](int, int) {}); };
  NodeRunner runner("node", pass, layout, services, pool);
  give_inputs();
  EXPECT_THROW(runner.run(7, inputs, outputs), Cancelled);
  cancel = false;
  give_inputs();
  runner.run(8, inputs, outputs);
  EXPECT_TRUE(outputs[0][0]);
}

// Sanitizers take a request that large for a mistake of the program.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(NodeRunnerTest, PassesOnThatMemoryRanOut) {
  behavior = [](const Frame&) { FAIL() << "the pass was run without scratch"; };
  layout.scratch_bytes = std::size_t{1} << 60;
  EXPECT_THROW(run(), std::bad_alloc);
  expect_nothing_held();
}
#endif

}  // namespace
}  // namespace quell
