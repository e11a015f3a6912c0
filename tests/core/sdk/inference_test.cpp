#include <gtest/gtest.h>

#include <array>

#include "quell/sdk/frame.h"

namespace quell::test {
namespace {

const std::vector<PortInfo> kInputs = {{.name = "color", .types = kColor | kAlbedo},
                                       {.name = "extra", .types = kDepth, .optional = true, .array = true},
                                       {.name = "id", .types = kId, .optional = true}};
const std::vector<PortInfo> kOutputs = {{.name = "half", .same_as = "color"}, {.name = "stats", .types = kValue}};

struct InferenceOfEverything : testing::Test {
  quell_shape color{sizeof(quell_shape), QUELL_TYPE_ALBEDO, 6, 4, 0, 1};
  std::array<quell_shape, 2> extra{
      {{sizeof(quell_shape), QUELL_TYPE_DEPTH, 6, 4, 0, 1}, {sizeof(quell_shape), QUELL_TYPE_DEPTH, 12, 8, 0, 0}}};
  quell_shape half{sizeof(quell_shape), QUELL_TYPE_ALBEDO, 6, 4, 0, 1}, stats{sizeof(quell_shape), QUELL_TYPE_VALUE, 0, 0, 0, 1};
  std::array<quell_port_shape, 3> inputs{{{sizeof(quell_port_shape), 1, &color},
                                          {sizeof(quell_port_shape), 2, extra.data()},
                                          {sizeof(quell_port_shape), 0, nullptr}}};
  std::array<quell_port_shape, 2> outputs{{{sizeof(quell_port_shape), 1, &half}, {sizeof(quell_port_shape), 1, &stats}}};
  std::array<std::int32_t, 3> radius{};
  std::array<std::int32_t, 2> in_place{-1, -1};
  quell_inference raw{sizeof(quell_inference), 3, 2, inputs.data(), outputs.data(), radius.data(), in_place.data(), 0, 0};
  Inference inference{kInputs, kOutputs, raw};
};

TEST_F(InferenceOfEverything, TellsTheInputs) {
  EXPECT_EQ(inference.type("color"), QUELL_TYPE_ALBEDO);
  EXPECT_EQ(inference.size("extra", 1), (Size{12, 8}));
  EXPECT_EQ(inference.count("extra"), 2u);
  EXPECT_TRUE(inference.present("extra", 0));
  EXPECT_FALSE(inference.present("extra", 1));
  EXPECT_FALSE(inference.present("extra", 2));
  EXPECT_FALSE(inference.present("id"));
}

TEST_F(InferenceOfEverything, TakesTheAnswers) {
  inference.set_size("half", {3, 2});
  inference.set_value_count("stats", 7);
  inference.set_radius("color", 5);
  inference.set_unbounded("id");
  inference.set_in_place("stats", "extra");
  inference.set_scratch(100);
  inference.set_slot_scratch(200);
  EXPECT_EQ(half.width, 3);
  EXPECT_EQ(half.height, 2);
  EXPECT_EQ(stats.value_count, 7u);
  EXPECT_EQ(radius, (std::array<std::int32_t, 3>{5, 0, QUELL_RADIUS_UNBOUNDED}));
  EXPECT_EQ(in_place, (std::array<std::int32_t, 2>{-1, 1}));
  EXPECT_EQ(raw.scratch_bytes, 100u);
  EXPECT_EQ(raw.slot_scratch_bytes, 200u);
}

TEST_F(InferenceOfEverything, RefusesItemsAndPortsThatAreNotThere) {
  EXPECT_THROW(inference.size("id"), std::logic_error);
  EXPECT_THROW(inference.size("extra", 2), std::logic_error);
  EXPECT_THROW(inference.set_radius("half", 1), std::logic_error);
  EXPECT_THROW(inference.set_size("color", {1, 1}), std::logic_error);
}

}  // namespace
}  // namespace quell::test
