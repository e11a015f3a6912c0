// For tests of memory: uses everything that a pass can be given, and allocates nothing itself.
#include <algorithm>

#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {};

const PassInfo kInfo{
    .id = "toil",
    .summary = "color + history, with a detour through scratch memory, and values that count on",
    .source = "test",
    .inputs = {{.name = "color", .types = kColor, .doc = "read"},
               {.name = "history", .types = kColor, .doc = "added", .optional = true},
               {.name = "counts", .types = kValue, .doc = "one is added to each", .optional = true},
               {.name = "former", .types = kValue, .doc = "added to each", .optional = true}},
    .outputs = {{.name = "color", .types = kColor, .doc = "the sum"}, {.name = "counts", .types = kValue, .doc = "the sums"}}};

class Toil final : public Pass {
 public:
  explicit Toil(const Params&) {}
  void infer(Inference& about) const override {
    const auto row_bytes = static_cast<std::size_t>(about.size("color").width) * sizeof(float);
    about.set_in_place("color", "color");
    about.set_value_count("counts", 3);
    about.set_scratch(row_bytes * static_cast<std::size_t>(about.size("color").height));
    about.set_slot_scratch(row_bytes);
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), history = frame.image("history");
    const FloatOutput out = frame.output("color");
    auto* plane = static_cast<float*>(frame.scratch());
    frame.parallel_rows(out.height, [&](int y0, int y1, std::uint32_t slot) {
      auto* row = static_cast<float*>(frame.slot_scratch(slot));
      for (int c = 0; c < 3; ++c)
        for (int y = y0; y < y1; ++y) {
          std::copy_n(color.row(y, c), out.width, row);
          for (int x = 0; x < out.width && history; ++x) row[x] += history.at(x, y, c);
          std::copy_n(row, out.width, plane + static_cast<std::ptrdiff_t>(y) * out.width);
          std::copy_n(plane + static_cast<std::ptrdiff_t>(y) * out.width, out.width, out.row(y, c));
        }
    });
    add_counts(frame.values("counts"), frame.values("former"), frame.output_values("counts"));
  }

 private:
  static void add_counts(std::span<const double> counts, std::span<const double> former, std::span<double> sums) {
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] = (i < counts.size() ? counts[i] + 1 : 1) + (i < former.size() ? former[i] : 0);
  }
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Toil, Params)
