// A run over real frames is interrupted at moments spread over its time: what it leaves is whole.
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <random>
#include <thread>

#include "quell/sequence/frame_range.h"
#include "quell/sequence/sequence.h"
#include "tests/apps/sample.h"
#include "tests/core/sequence/test_files.h"

namespace quell::app::testing {
namespace {

using Clock = std::chrono::steady_clock;
using ::testing::HasSubstr;
using ::testing::IsSubsetOf;
using Seconds = std::chrono::duration<double>;

constexpr int kFrames = 24;  // the last of which waits for the signal, so that no run is over before it

class InterruptedAnywhere : public RunnerTest {
 protected:
  /// The sample's eight frames, again and again.
  void make_sequence() {
    const std::filesystem::path sample = QUELL_SOURCE_DIR "/graphs/sample";
    std::filesystem::create_directories(path("long"));
    const auto number = [](int frame) { return "." + std::string(frame < 10 ? "000" : "00") + std::to_string(frame); };
    for (const std::string name : {"color_1spp", "normal", "position", "id", "frame"})
      for (int frame = 1; frame <= kFrames; ++frame) {
        const std::string extension = name == "frame" ? ".json" : ".exr";
        std::filesystem::create_symlink(sample / (name + number((frame - 1) % 8 + 1) + extension),
                                        path("long") / (name + number(frame) + extension));
      }
    write_file("long/sequence.json", R"({
  "quell_sequence": 1,
  "inputs": { "color": "color_1spp.####.exr", "normal": "normal.####.exr", "position": "position.####.exr",
              "id": { "file": "id.####.exr", "background": 0 }, "camera": { "file": "frame.####.json", "format": "json" } }
})");
    write_file("waiting.json", R"({
  "quell": 1,
  "inputs": { "color": "color", "normal": "normal", "position": "position", "id": "id", "camera": "camera" },
  "nodes": {
    "denoise": { "graph": ")" QUELL_SOURCE_DIR R"(/graphs/games202.json",
                 "in": { "color": "color", "normal": "normal", "position": "position", "id": "id", "camera": "camera" } },
    "scale": { "pass": "test_scale", "in": { "color": "denoise.color" } }
  },
  "outputs": { "color": "scale.color" }
})");
  }

  std::vector<std::string> command(const std::string& out, int wait_from) const {
    return {"run",
            text("waiting.json"),
            text("long"),
            "-o",
            text(out),
            "--plugin-path",
            TEST_PLUGINS,
            "--set",
            "denoise.filter.radius=2",
            "--set",
            "scale.wait_from=" + std::to_string(wait_from)};
  }

  /// What the last line says of a group of frames: "1-7" after "frames done: ".
  static std::vector<std::int64_t> frames_after(const std::string& label, const std::string& message) {
    const std::size_t begin = message.rfind(label) + label.size();
    const std::string range = message.substr(begin, message.find_first_of(";\n", begin) - begin);
    return range == "none" ? std::vector<std::int64_t>() : FrameRange::parse(range).frames();
  }

  void expect_whole_files_only(const std::string& message) const {
    for (const std::string& name : list("out")) {  // not byte by byte: `wait_from` is told apart in the graph's hash
      ASSERT_TRUE(std::filesystem::exists(path("whole") / name)) << name;
      const test::ExrRead file = test::load_exr(path("out") / name), whole = test::load_exr(path("whole") / name);
      EXPECT_TRUE(file.channels == whole.channels && file.pixels == whole.pixels) << name;
    }
    for (const std::int64_t frame : frames_after("frames done: ", message)) {
      const std::string number = std::to_string(frame);
      EXPECT_TRUE(std::filesystem::exists(path("out/color." + std::string(4 - number.size(), '0') + number + ".exr"))) << frame;
    }
  }
};

TEST_F(InterruptedAnywhere, LeavesWholeFramesOnly) {
  make_sequence();
  const Outcome whole = Program(command("whole", kFrames + 1)).finish();
  ASSERT_EQ(whole.code, 0) << whole.err;
  const auto written = Sequence::open("", {.in = {"color=" + text("whole/color.####.exr")}, .frames = {}});
  BufferPool pool;
  for (int frame = 1; frame <= kFrames; ++frame) EXPECT_NO_THROW(written->read("color", frame, pool)) << frame;

  std::mt19937 random(2024);
  Seconds span{0}, slowest{0};  // from a run's first words until it waits; from a signal until the end
  for (int moment = 0; moment <= 20; ++moment) {
    std::filesystem::remove_all(path("out"));
    Program program(command("out", kFrames));
    ASSERT_TRUE(program.wait_for_error_text("' reads '"));
    const auto start = Clock::now();
    if (moment == 0) {
      ASSERT_TRUE(program.wait_for_error_text("\nwaiting\n"));
      span = Clock::now() - start;
    } else {
      std::this_thread::sleep_for(span * std::uniform_real_distribution(0.0, 1.0)(random));
    }
    const auto signal = Clock::now();
    program.send(moment % 2 == 0 ? SIGINT : SIGTERM);
    const Outcome outcome = program.finish();
    const Seconds took = Clock::now() - signal;
    slowest = std::max(slowest, took);
    EXPECT_EQ(outcome.code, 75) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("error: interrupted; frames done: "));
    EXPECT_LT(took, Seconds(60));  // far more than two frames take: nothing hangs
    expect_whole_files_only(outcome.err);
  }
  std::cout << "a frame takes " << (span / kFrames).count() << " s; the slowest of 21 runs ended " << slowest.count()
            << " s after its signal\n";
}

}  // namespace
}  // namespace quell::app::testing
