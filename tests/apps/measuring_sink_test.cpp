// Frames that are measured while they are written: in any order, from any thread, and some of them fail.
#include <algorithm>
#include <cmath>
#include <thread>

#include "measuring_sink.h"
#include "quell/text/error.h"
#include "tests/apps/compare_fixture.h"

namespace quell::app::testing {
namespace {

using Figures = std::vector<MeasuredOutput>;

/// Takes all but one output of one frame.
class FailingSink final : public FrameSink {
 public:
  void write(std::string_view output, std::int64_t frame, const Item&) override {
    if (frame == bad_frame && output == bad_output) throw Error(Fault::frame, "", "the drive is full");
  }
  std::int64_t bad_frame = 0;
  std::string bad_output = "second";
};

class MeasuringSinkTest : public CompareTest {
 protected:
  static constexpr int kFrames = 6;

  MeasuringSinkTest() {
    for (int frame = 1; frame <= kFrames; ++frame) {
      std::vector<double> values;
      for (int i = 0; i < kWidth * kHeight; ++i) values.push_back(std::abs(std::sin(i * 0.7 + frame)));
      make_image("shot/reference.000" + std::to_string(frame) + ".exr", values);
      make_motion("shot/motion.000" + std::to_string(frame) + ".exr");
    }
  }

  MeasuringOptions options(std::vector<std::int64_t> frames = {1, 2, 3, 4, 5, 6}) const {
    MeasuringOptions options{ImageSeries::open(text("shot/reference.####.exr"), SeriesRole::reference), {}, {}, {}, {}};
    options.outputs = {"color", "second"};
    options.frames = std::move(frames);
    options.compare.metrics = {Metric::mse, Metric::tpsnr, Metric::warped, Metric::ssim};
    return options;
  }

  /// Both outputs of a frame, as a run writes them.
  void write(MeasuringSink& sink, std::int64_t frame) {
    for (const char* output : {"color", "second"}) {
      Image image(QUELL_TYPE_COLOR, {kWidth, kHeight}, pool_);
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < kHeight; ++y)
          for (int x = 0; x < kWidth; ++x)
            image.writable_floats().at(x, y, c) = static_cast<float>(x * frame % 7) / 7 + (output[0] == 'c' ? 0.125F : 0.0F);
      try {
        sink.write(output, frame, image);
      } catch (const Error&) { return; }
    }
  }
  /// As a run tells them.
  static std::vector<Figures> take_all(MeasuringSink& sink, std::int64_t bad_frame = 0) {
    std::vector<Figures> all;
    for (std::int64_t frame = 1; frame <= kFrames; ++frame) {
      if (frame == bad_frame)
        sink.forget(frame), all.emplace_back();
      else
        all.push_back(sink.take(frame));
    }
    return all;
  }
  static void expect_equal(const std::vector<Figures>& a, const std::vector<Figures>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t frame = 0; frame < a.size(); ++frame) {
      ASSERT_EQ(a[frame].size(), b[frame].size());
      for (std::size_t output = 0; output < a[frame].size(); ++output)
        for (std::size_t i = 0; i < a[frame][output].scores.size(); ++i) {
          EXPECT_EQ(a[frame][output].scores[i].sum, b[frame][output].scores[i].sum) << frame << " " << output << " " << i;
          EXPECT_EQ(a[frame][output].scores[i].count, b[frame][output].scores[i].count) << frame << " " << output << " " << i;
        }
    }
  }

  FailingSink target_;
  BufferPool pool_;
};

TEST_F(MeasuringSinkTest, FiguresAreTheSameInWhateverOrderFramesAreWritten) {
  MeasuringSink ascending(target_, options());
  for (int frame = 1; frame <= kFrames; ++frame) write(ascending, frame);
  const std::vector<Figures> want = take_all(ascending);
  for (int frame = 0; frame < kFrames; ++frame) {
    ASSERT_EQ(want[static_cast<std::size_t>(frame)].size(), 2U);
    EXPECT_EQ(want[static_cast<std::size_t>(frame)][0].scores[1].count > 0, frame > 0);
  }
  MeasuringSink descending(target_, options());
  for (int frame = kFrames; frame >= 1; --frame) write(descending, frame);
  expect_equal(take_all(descending), want);
  for (int round = 0; round < 20; ++round) {
    MeasuringSink threaded(target_, options());
    {
      std::vector<std::jthread> threads;
      for (int frame = 1; frame <= kFrames; ++frame) threads.emplace_back([&, frame] { write(threaded, frame); });
    }
    expect_equal(take_all(threaded), want);
  }
}

// Its first output was measured before the second failed.
TEST_F(MeasuringSinkTest, AFrameThatFailsIsNotTheOneBeforeAnother) {
  target_.bad_frame = 3;
  for (const bool in_order : {true, false}) {
    MeasuringSink sink(target_, options());
    for (int i = 1; i <= kFrames; ++i) write(sink, in_order ? i : kFrames + 1 - i);
    const std::vector<Figures> figures = take_all(sink, 3);
    for (const std::size_t metric : {1U, 2U}) {
      EXPECT_GT(figures[1][0].scores[metric].count, 0U);
      EXPECT_EQ(figures[3][0].scores[metric].count, 0U) << in_order;
      EXPECT_GT(figures[4][0].scores[metric].count, 0U);
    }
    EXPECT_GT(figures[3][0].scores[3].count, 0U);
    EXPECT_EQ(sink.measured_frames(), (std::vector<std::int64_t>{1, 2, 4, 5, 6}));
    EXPECT_EQ(sink.totals()[0].scores[1].count, 3U * figures[1][0].scores[1].count);
  }
}

TEST_F(MeasuringSinkTest, WithoutMotionOthersThanWarpedAreMeasured) {
  std::filesystem::remove(path("shot/motion.0004.exr"));
  MeasuringOptions chosen = options();
  chosen.motion = ImageSeries::open(text("shot/motion.####.exr"), SeriesRole::motion);
  write_file("shot/motion.0003.exr", "no image");
  MeasuringSink sink(target_, std::move(chosen));
  for (int frame = 1; frame <= kFrames; ++frame) write(sink, frame);
  const std::vector<Figures> figures = take_all(sink);
  for (const std::size_t frame : {1U, 2U, 3U, 4U, 5U}) {
    EXPECT_GT(figures[frame][0].scores[1].count, 0U) << frame;
    EXPECT_EQ(figures[frame][0].scores[2].count > 0, frame != 2 && frame != 3) << frame;
  }
}

TEST_F(MeasuringSinkTest, StartsAnewWhenAllFramesAreWrittenAgain) {
  MeasuringSink sink(target_, options());
  for (int frame = 1; frame <= kFrames; ++frame) write(sink, frame);
  const std::vector<Figures> want = take_all(sink);
  const std::uint64_t count = sink.totals()[0].scores[0].count;
  sink.restart();
  EXPECT_TRUE(sink.totals().empty());
  write(sink, 2);
  sink.restart();  // nobody took that
  for (int frame = 1; frame <= kFrames; ++frame) write(sink, frame);
  expect_equal(take_all(sink), want);
  EXPECT_EQ(sink.totals()[0].scores[0].count, count);
  EXPECT_EQ(sink.measured_frames().size(), 6U);
}

TEST_F(MeasuringSinkTest, ASingleFileIsTheReferenceOfARunOfOneFrameAlone) {
  MeasuringOptions one = options({5});
  one.reference = ImageSeries::open(text("shot/reference.0002.exr"), SeriesRole::reference);
  MeasuringOptions two = one;
  two.frames = {2, 5};
  MeasuringSink alone(target_, std::move(one)), among(target_, std::move(two));
  for (MeasuringSink* sink : {&alone, &among}) write(*sink, 5);
  EXPECT_EQ(alone.take(5).size(), 2U);
  EXPECT_EQ(among.take(5).size(), 0U);
}

}  // namespace
}  // namespace quell::app::testing
