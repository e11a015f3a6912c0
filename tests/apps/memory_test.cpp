// --memory as a promise about the whole process.
#include <gmock/gmock.h>

#include <chrono>
#include <regex>
#include <thread>

#include "quell/sequence/file_sink.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
constexpr Size kSize{1280, 720};
constexpr long kKiB = 1024, kMiB = 1024 * kKiB;

class Memory : public RunnerTest {
 protected:
  // What svgf reads; values that differ from pixel to pixel do not compress away.
  void make_large_shot(int frames) {
    BufferPool pool;
    FileSink files({.folder = path("shot"), .type = PixelType::single});
    std::uint32_t state = 1;
    for (int frame = 1; frame <= frames; ++frame)
      for (const PortType type : {QUELL_TYPE_COLOR, QUELL_TYPE_ALBEDO, QUELL_TYPE_NORMAL, QUELL_TYPE_DEPTH, QUELL_TYPE_MOTION}) {
        Image image(type, kSize, pool);
        const FloatOutput out = image.writable_floats();
        for (int c = 0; c < out.channels; ++c)
          for (int y = 0; y < out.height; ++y)
            for (int x = 0; x < out.width; ++x)
              out.at(x, y, c) = static_cast<float>((state = state * 1664525 + 1013904223) >> 20) / 4096;
        files.write(name(type), frame, image);
      }
  }
  Outcome svgf(const std::string& memory) const {
    return run({"run", "svgf", text("shot"), "-o", text("out"), "--memory", memory, "--threads", "2"});
  }
};

TEST_F(Memory, StaysBelowThePromise) {
  make_large_shot(5);
  const Outcome small = svgf("50M");
  EXPECT_EQ(small.code, 33);
  EXPECT_TRUE(list("out").empty());
  std::smatch needed;
  ASSERT_TRUE(std::regex_search(small.err, needed, std::regex("at least ([0-9]+) MiB are needed"))) << small.err;
  const long smallest = std::stol(needed[1]);
  for (const long factor : {1L, 2L, 4L}) {
    const Outcome outcome = svgf(std::to_string(smallest * factor) + "M");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_LE(outcome.peak_resident, smallest * factor * kMiB) << "at " << factor << " times " << smallest << " MiB";
    RecordProperty("resident_MiB_" + std::to_string(factor), std::to_string(outcome.peak_resident / kMiB));
  }
  EXPECT_EQ(svgf(std::to_string(smallest - 16) + "M").code, 33);
}

TEST_F(Memory, StaysTheSameHoweverLongTheSequenceIs) {
  constexpr std::size_t kFrames = 1200, kWarm = 100;
  make_shot(kFrames);
  write_file("loop.json", R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"blend": {"pass": "temporal_blend",
              "in": {"color": "color", "history": {"from": "blend.color", "delay": 1, "initial": "none"}}}},
    "outputs": {"color": "blend.color"}})");
  Program program({"run", text("loop.json"), text("shot"), "-o", text("out"), "-q"});
  long warm = 0, later = 0, seen = 0;
  for (std::size_t done = 0; done < kFrames; done = list("out").size()) {
    const long resident = program.resident();
    if (resident == 0) break;  // it is over
    long& largest = done <= kWarm ? warm : later;
    largest = std::max(largest, resident);
    seen += done > kWarm ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(program.finish().code, 0);
  EXPECT_GT(seen, 5) << "the run was too short to be looked at";
  EXPECT_LE(later, warm + 4 * kMiB);
  RecordProperty("resident_KiB_after_100_frames", std::to_string(warm / kKiB));
  RecordProperty("resident_KiB_later", std::to_string(later / kKiB));
}

}  // namespace
}  // namespace quell::app::testing
