// Passes that break one rule each, to see that the conformance checks notice. `offence` chooses the rule.
#include <atomic>

#include "quell/sdk/pass.h"

namespace {
using namespace quell;

enum class Offence { none, radius, array, pixels, chunks, rows, strides, in_place, memory, optional, threads };

struct Params {
  Offence offence = Offence::none;
  void describe(auto&& field) {
    field("offence", offence,
          Choices{{"none", "keeps the rules"},
                  {"radius", "reads farther than it says"},
                  {"array", "reads farther than it says, in an item of an array"},
                  {"pixels", "leaves a pixel unwritten"},
                  {"chunks", "depends on the bands"},
                  {"rows", "depends on the bands although it works row by row"},
                  {"strides", "takes rows for dense"},
                  {"in_place", "reads a neighbor although it works in place"},
                  {"memory", "remembers the last frame"},
                  {"optional", "fails without its optional input"},
                  {"threads", "adds in the order in which bands happen to end"}},
          "The rule that is broken.");
  }
};

const PassInfo kInfo{.id = "offender",
                     .summary = "breaks a rule",
                     .source = "made up",
                     .inputs = {{.name = "color", .types = kColor, .doc = "copied"},
                                {.name = "history", .types = kColor, .doc = "unread", .optional = true},
                                {.name = "extra", .types = kColor, .doc = "unread", .optional = true, .array = true}},
                     .outputs = {{.name = "color", .types = kColor, .doc = "nearly a copy"}}};

class Offender final : public Pass {
 public:
  explicit Offender(const Params& params) : offence_(params.offence) {}
  void infer(Inference& about) const override {
    if (offence_ == Offence::in_place) about.set_in_place("color", "color");
    if (offence_ == Offence::chunks || offence_ == Offence::strides || offence_ == Offence::threads) about.set_unbounded("color");
    if (offence_ == Offence::rows) about.set_unbounded("color"), about.set_by_rows();
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    const FloatImage read = offence_ == Offence::array && frame.has("extra") ? frame.image("extra") : color;
    const FloatOutput out = frame.output("color");
    if (offence_ == Offence::optional && !frame.has("history")) throw std::runtime_error("no history");
    const float last = last_.exchange(color.at(0, 0));
    std::atomic<float> order = 1.0F;
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int c = 0; c < out.channels; ++c)
          for (int x = 0; x < written_width(out, y, c); ++x) out.at(x, y, c) = value(read, x, y, c, y0);
      if (offence_ == Offence::threads) order = order * 1.1F + static_cast<float>(y0);
    });
    if (offence_ == Offence::memory) out.at(0, 0) += last;
    if (offence_ == Offence::threads) out.at(0, 0) = order;
  }

 private:
  int written_width(const FloatOutput& out, int y, int c) const {
    return offence_ == Offence::pixels && y == out.height - 1 && c == 2 ? out.width - 1 : out.width;
  }
  float value(const FloatImage& color, int x, int y, int c, int first_row) const {
    if ((offence_ == Offence::radius || offence_ == Offence::array) && x > 0) return color.at(x - 1, y, c);
    if (offence_ == Offence::in_place && x > 0) return color.at(x, y, c) + color.at(x - 1, y, c);
    if (offence_ == Offence::chunks || offence_ == Offence::rows) return color.at(x, first_row, c);
    if (offence_ == Offence::strides) return color.data[c * color.plane_stride + y * ((color.width + 15) / 16 + 1) * 16 + x];
    return color.at(x, y, c);
  }
  Offence offence_;
  mutable std::atomic<float> last_ = 0.0F;
};

struct NoParams {};
const PassInfo kUndocumented{.id = "undocumented",
                             .summary = "",
                             .inputs = {{.name = "color", .types = kColor}},
                             .outputs = {{.name = "color", .types = kColor, .doc = "nothing"}}};
class Undocumented final : public Pass {
 public:
  explicit Undocumented(const NoParams&) {}
  void run(const Frame&) const override {}
};
const PassInfo kForgetful{.id = "forgetful",
                          .summary = "leaves an id unwritten",
                          .source = "made up",
                          .inputs = {{.name = "id", .types = kId, .doc = "copied"}},
                          .outputs = {{.name = "id", .types = kId, .doc = "a copy but for the last pixel"}}};
class Forgetful final : public Pass {
 public:
  explicit Forgetful(const NoParams&) {}
  void run(const Frame& frame) const override {
    const IdImage ids = frame.ids("id");
    const IdOutput out = frame.output_ids("id");
    for (int i = 0; i + 1 < out.width * out.height; ++i)
      out.at(i % out.width, i / out.width) = ids.at(i % out.width, i / out.width);
  }
};
const bool forgetful_is_registered = detail::register_pass<Forgetful, NoParams>(kForgetful);
const bool undocumented_is_registered = detail::register_pass<Undocumented, NoParams>(kUndocumented);

}  // namespace

QUELL_REGISTER_PASS(kInfo, Offender, Params)
