// For tests of failures: adds, and fails on some frames in one of the ways in which a pass can.
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

enum class How { start, chunk, memory, foreign };

struct Params {
  int salt = 0;
  std::vector<int> frames;
  How how = How::chunk;
  bool in_place = false;
  void describe(auto&& field) {
    field("salt", salt, Range<int>{0, 1000}, "", "Added.");
    field("frames", frames, Range<int>{}, Length{}, "frame", "Those that fail.");
    field("how", how,
          Choices{{"start", "before anything is computed"},
                  {"chunk", "in one chunk of a parallel loop"},
                  {"memory", "std::bad_alloc"},
                  {"foreign", "with what is no std::exception"}},
          "What happens.");
    field("in_place", in_place, "Writes over color.");
  }
};

const PassInfo kInfo{.id = "falter",
                     .summary = "color + salt, but not in every frame",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "added"}},
                     .outputs = {{.name = "color", .doc = "the sum", .same_as = "color"}}};

class Falter final : public Pass {
 public:
  explicit Falter(const Params& params) : params_(params) {}
  void infer(Inference& about) const override {
    if (params_.in_place) about.set_in_place("color", "color");
    about.set_by_rows();
  }
  void run(const Frame& frame) const override {
    const bool fails = std::ranges::find(params_.frames, frame.number()) != params_.frames.end();
    if (fails && params_.how == How::start) throw std::runtime_error(told(frame));
    const FloatImage color = frame.image("color");
    ring::fill(frame, frame.output("color"), [&](int x, int y, int c) {
      if (fails && y == 0) fail(frame);
      return params_.salt + ring::at(color, x, y, c);
    });
  }

 private:
  static std::string told(const Frame& frame) { return "told to fail on frame " + std::to_string(frame.number()); }
  void fail(const Frame& frame) const {
    if (params_.how == How::memory) throw std::bad_alloc();
    if (params_.how == How::foreign) throw 7;
    throw std::runtime_error(told(frame));
  }
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Falter, Params)
