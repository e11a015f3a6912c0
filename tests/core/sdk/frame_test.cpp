#include "quell/sdk/frame.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/core/sdk/fake_host.h"

namespace quell::test {
namespace {

const std::vector<PortInfo> kInputs = {{.name = "color", .types = kColor},
                                       {.name = "id", .types = kId},
                                       {.name = "extra", .types = kAnyFloatImage, .optional = true, .array = true},
                                       {.name = "camera", .types = kCamera, .optional = true},
                                       {.name = "exposure", .types = kValue, .optional = true}};
const std::vector<PortInfo> kOutputs = {{.name = "color", .types = kColor}, {.name = "stats", .types = kValue}};

/// A frame of 3 x 2 pixels in which everything is there but the second of the two `extra` items.
struct FrameOfEverything : testing::Test {
  std::array<float, 3 * 2 * 3> pixels{};  // no padding, unlike the host's: views must go by the strides alone
  std::array<std::uint32_t, 6> id_pixels{10, 11, 12, 13, 14, 15};
  std::array<float, 18> out_pixels{};
  std::array<double, 2> numbers{1.5, 2.5};
  std::array<double, 3> stats_numbers{};
  quell_image color{sizeof(quell_image), QUELL_TYPE_COLOR, QUELL_FORMAT_F32, 3, 3, 2, 3, 6, pixels.data()};
  quell_image id{sizeof(quell_image), QUELL_TYPE_ID, QUELL_FORMAT_U32, 1, 3, 2, 3, 6, id_pixels.data()};
  quell_image out{sizeof(quell_image), QUELL_TYPE_COLOR, QUELL_FORMAT_F32, 3, 3, 2, 3, 6, out_pixels.data()};
  quell_camera camera{};
  quell_values exposure{sizeof(quell_values), 2, numbers.data()};
  quell_values stats{sizeof(quell_values), 3, stats_numbers.data()};
  quell_item color_item{sizeof(quell_item), QUELL_TYPE_COLOR, &color, nullptr, nullptr};
  quell_item id_item{sizeof(quell_item), QUELL_TYPE_ID, &id, nullptr, nullptr};
  std::array<quell_item, 2> extra{color_item, {sizeof(quell_item), QUELL_TYPE_COLOR, nullptr, nullptr, nullptr}};
  quell_item camera_item{sizeof(quell_item), QUELL_TYPE_CAMERA, nullptr, &camera, nullptr};
  quell_item exposure_item{sizeof(quell_item), QUELL_TYPE_VALUE, nullptr, nullptr, &exposure};
  quell_item out_item{sizeof(quell_item), QUELL_TYPE_COLOR, &out, nullptr, nullptr};
  quell_item stats_item{sizeof(quell_item), QUELL_TYPE_VALUE, nullptr, nullptr, &stats};
  std::array<quell_port, 5> inputs{{{sizeof(quell_port), 1, &color_item},
                                    {sizeof(quell_port), 1, &id_item},
                                    {sizeof(quell_port), 2, extra.data()},
                                    {sizeof(quell_port), 1, &camera_item},
                                    {sizeof(quell_port), 1, &exposure_item}}};
  std::array<quell_port, 2> outputs{{{sizeof(quell_port), 1, &out_item}, {sizeof(quell_port), 1, &stats_item}}};
  int scratch = 0;
  std::array<int, 2> slot_blocks{};
  std::array<void*, 2> slots{&slot_blocks[0], &slot_blocks[1]};
  quell_exec exec{sizeof(quell_exec), 5, 2, 2, -7, inputs.data(), outputs.data(), &scratch, slots.data()};
  FakeHost host;
  Frame frame{kInputs, kOutputs, host.raw, exec};

  FrameOfEverything() {
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i);
  }
};

TEST_F(FrameOfEverything, FindsPixelsByTheStrides) {
  const FloatImage image = frame.image("color");
  ASSERT_TRUE(image);
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(image.at(0, 0), 0);
  EXPECT_EQ(image.at(2, 1), 5);
  EXPECT_EQ(image.at(1, 1, 2), 16);  // 2 planes of 6, 1 row of 3, 1 pixel
  EXPECT_EQ(image.row(1, 1), pixels.data() + 9);
  EXPECT_TRUE(image.contains(2, 1));
  EXPECT_FALSE(image.contains(3, 0));
  EXPECT_FALSE(image.contains(0, -1));
}

TEST_F(FrameOfEverything, HandsOutIdsCamerasAndValues) {
  EXPECT_EQ(frame.ids("id").at(2, 1), 15u);
  EXPECT_EQ(frame.camera("camera"), &camera);
  EXPECT_EQ(frame.values("exposure").size(), 2u);
  EXPECT_EQ(frame.values("exposure")[1], 2.5);
  EXPECT_EQ(frame.number(), -7);
}

TEST_F(FrameOfEverything, WritesToItsOutputs) {
  frame.output("color").at(0, 1, 1) = 4;
  EXPECT_EQ(out_pixels[9], 4);
  frame.output_values("stats")[2] = 8;
  EXPECT_EQ(stats_numbers[2], 8);
}

TEST_F(FrameOfEverything, RefusesToWriteValuesToAnImage) { EXPECT_THROW(frame.output_values("color"), std::logic_error); }

TEST_F(FrameOfEverything, CountsTheItemsOfAnArrayAndSaysWhichAreThere) {
  EXPECT_EQ(frame.count("extra"), 2u);
  EXPECT_TRUE(frame.has("extra", 0));
  EXPECT_FALSE(frame.has("extra", 1));
  EXPECT_FALSE(frame.has("extra", 2));
  EXPECT_TRUE(frame.image("extra", 0));
  EXPECT_FALSE(frame.image("extra", 1));
  EXPECT_FALSE(frame.image("extra", 2));
}

TEST_F(FrameOfEverything, TreatsWhatIsUnconnectedAsAbsent) {
  for (quell_port& port : inputs) port = {sizeof(quell_port), 0, nullptr};
  EXPECT_FALSE(frame.has("color"));
  EXPECT_FALSE(frame.image("color"));
  EXPECT_FALSE(frame.ids("id"));
  EXPECT_EQ(frame.camera("camera"), nullptr);
  EXPECT_TRUE(frame.values("exposure").empty());
  EXPECT_EQ(frame.count("extra"), 0u);
}

TEST_F(FrameOfEverything, RefusesPortsThatThePassDoesNotDeclare) {
  try {
    frame.image("colour");
    FAIL() << "nothing was thrown";
  } catch (const std::logic_error& error) {
    EXPECT_STREQ(error.what(), "the pass asks for a port 'colour' that it does not declare");
  }
  EXPECT_THROW(frame.output("extra"), std::logic_error);  // an input's name
}

TEST_F(FrameOfEverything, RefusesToReadIdsAsFloat) {
  EXPECT_THROW(frame.image("id"), std::logic_error);
  EXPECT_THROW(frame.ids("color"), std::logic_error);
}

TEST_F(FrameOfEverything, PassesOnScratchLogAndCancellation) {
  EXPECT_EQ(frame.scratch(), &scratch);
  EXPECT_EQ(frame.slot_scratch(1), &slot_blocks[1]);
  frame.log(QUELL_LOG_WARNING, "dark");
  EXPECT_EQ(host.logged, std::vector<std::string>{"2:dark"});
  EXPECT_FALSE(frame.cancelled());
  host.cancel_at = 0;
  EXPECT_TRUE(frame.cancelled());
}

/// Ports of a host that is newer than the plugin are longer than the plugin knows.
TEST_F(FrameOfEverything, StepsByTheSizeThatTheHostWrote) {
  struct LongerPort {
    quell_port known;
    double news;
  };
  std::array<LongerPort, 5> longer{};
  for (std::size_t i = 0; i < 5; ++i) longer[i].known = {sizeof(LongerPort), inputs[i].count, inputs[i].items};
  exec.inputs = &longer[0].known;
  EXPECT_EQ(frame.ids("id").at(0, 0), 10u);
  EXPECT_EQ(frame.values("exposure")[0], 1.5);
}

}  // namespace
}  // namespace quell::test
