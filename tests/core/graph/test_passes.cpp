#include "tests/core/graph/test_passes.h"

#include "quell/sdk/pass.h"

namespace quell::test {
namespace {

class Idle : public Pass {
 public:
  void run(const Frame&) const override {}
};

// A pass without parameters. Its descriptor belongs to its type, so that each needs a type of its own.
struct NoParams {};
template <int number>
class Plain : public Idle {
 public:
  explicit Plain(const NoParams&) {}
};
template <int number>
const quell_pass_desc* plain(const PassInfo& info) {
  return detail::Descriptor::make<Plain<number>, NoParams>(info).get();
}

enum class Mode { nearest, bilinear, bicubic };

// Version 3 gave 'strength' the name 'sigma' and made 'nearest' the default mode; version 4 raised the default of sigma.
struct FilterParams {
  int radius = 8;
  double sigma = 0.8;
  Mode mode = Mode::nearest;
  bool clamp = true;
  std::string label;
  std::filesystem::path lut;
  std::vector<double> kernel{1};
  std::vector<double> matrix = std::vector<double>(16, 0.0);
  std::vector<std::string> names;
  std::int64_t seed = 0;
  float gain = 1;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{0, 64}, "px", "Taps reach this far.");
    field("sigma", sigma, Range<double>{0, 100}, "", "Tolerated difference.");
    field("mode", mode, Choices{{"nearest", ""}, {"bilinear", ""}, {"bicubic", ""}}, "How to sample.");
    field("clamp", clamp, "Stay within the window.");
    field("label", label, "For people.");
    field("lut", lut, "A file.");
    field("kernel", kernel, Range<double>{-1, 1}, Length{1, 9}, "", "Weights.");
    field("matrix", matrix, Range<double>{}, Length{16, 16}, "", "A matrix.");
    field("names", names, Length{}, "Some names.");
    field("seed", seed, Range<std::int64_t>{}, "", "Any integer.");
    field("gain", gain, Range<float>{0}, "", "Not negative.");
  }
};
class Filter : public Idle {
 public:
  explicit Filter(const FilterParams&) {}
};
const PassInfo kFilter{.id = "filter",
                       .version = 4,
                       .oldest_version = 2,
                       .inputs = {{"color", kColor | kAlbedo},
                                  {"normal", kNormal},
                                  {.name = "position", .types = kPosition, .optional = true},
                                  {.name = "id", .types = kId, .optional = true}},
                       .outputs = {{.name = "color", .same_as = "color"}, {"weight", kScalar}},
                       .changes = {{.version = 3, .param = "strength", .renamed_to = "sigma"},
                                   {.version = 3, .param = "mode", .former_default = "bilinear"},
                                   {.version = 4, .param = "sigma", .former_default = 0.5}}};

struct BlendParams {
  double alpha = 0.2, gain = 1;
  void describe(auto&& field) {
    field("alpha", alpha, Range<double>{0, 1}, "", "Weight of the new frame.");
    field("gain", gain, Range<double>{0, 8}, "", "Factor.");
  }
};
class Blend : public Idle {
 public:
  explicit Blend(const BlendParams& params) {
    if (params.alpha == 0 && params.gain == 0) throw std::invalid_argument("alpha and gain cannot both be 0");
  }
};
const PassInfo kBlend{.id = "blend",
                      .inputs = {{"color", kAnyFloatImage},
                                 {.name = "history", .types = kAnyFloatImage, .optional = true},
                                 {.name = "valid", .types = kMask, .optional = true}},
                      .outputs = {{.name = "color", .same_as = "color"}}};

const PassInfo kReproject{.id = "reproject",
                          .inputs = {{"history", kAnyImage}, {"motion", kMotion}, {.name = "id", .types = kId, .optional = true}},
                          .outputs = {{.name = "color", .same_as = "history"}, {"valid", kMask}}};
const PassInfo kBackProject{
    .id = "back_project",
    .inputs = {{"position", kPosition}, {"camera", kCamera}, {.name = "previous_camera", .types = kCamera, .optional = true}},
    .outputs = {{"motion", kMotion}}};
const PassInfo kMerge{.id = "merge",
                      .inputs = {{.name = "colors", .types = kColor | kAlbedo, .array = true},
                                 {.name = "extra", .types = kAnyImage, .optional = true, .array = true}},
                      .outputs = {{.name = "parts", .array = true, .same_as = "colors"}, {"sum", kColor}}};
const PassInfo kSplit{.id = "split",
                      .inputs = {{.name = "items", .types = kAnyFloatImage, .optional = true, .array = true}},
                      .outputs = {{.name = "parts", .array = true, .same_as = "items"}}};
const PassInfo kCopy{.id = "copy", .inputs = {{"image", kAnyImage}}, .outputs = {{.name = "image", .same_as = "image"}}};
// Like copy, of several images.
const PassInfo kCopies{.id = "copies",
                       .inputs = {{.name = "image", .types = kAnyImage, .array = true}},
                       .outputs = {{.name = "image", .array = true, .same_as = "image"}}};
const PassInfo kMeter{.id = "meter",
                      .inputs = {{"color", kAnyFloatImage}, {.name = "previous", .types = kValue, .optional = true}},
                      .outputs = {{"value", kValue}}};
const PassInfo kSelect{.id = "select",
                       .inputs = {{"camera", kCamera}, {"id", kId}, {"value", kValue}},
                       .outputs = {{"mask", kMask}, {.name = "id", .same_as = "id"}}};

// Like filter in some ways: a parameter of less range, one of another type.
struct SmoothParams {
  int radius = 2, sigma = 1;
  bool clamp = false;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{0, 10}, "px", "Taps reach this far.");
    field("sigma", sigma, Range<int>{0, 100}, "", "Tolerated difference.");
    field("clamp", clamp, "Stay within the window.");
  }
};
class Smooth : public Idle {
 public:
  explicit Smooth(const SmoothParams&) {}
};
const PassInfo kSmooth{.id = "smooth",
                       .inputs = {{"color", kColor}, {.name = "guide", .types = kNormal, .optional = true}},
                       .outputs = {{.name = "image", .same_as = "color"}}};

Registry make_registry() {
  const std::vector<const quell_pass_desc*> all{detail::Descriptor::make<Filter, FilterParams>(kFilter).get(),
                                                detail::Descriptor::make<Blend, BlendParams>(kBlend).get(),
                                                plain<0>(kReproject),
                                                plain<1>(kBackProject),
                                                plain<2>(kMerge),
                                                plain<3>(kCopy),
                                                plain<4>(kMeter),
                                                plain<5>(kSelect),
                                                plain<6>(kSplit),
                                                plain<7>(kCopies),
                                                detail::Descriptor::make<Smooth, SmoothParams>(kSmooth).get()};
  Registry registry;
  registry.add(all.data(), static_cast<std::uint32_t>(all.size()));
  return registry;
}

}  // namespace

const Registry& passes() {
  static const Registry registry = make_registry();
  return registry;
}

}  // namespace quell::test
