// Non-local means: a mean over a window, weighted by how alike the patches around two pixels are, noise taken off, and features.
// Source:  Buades et al., "A Non-Local Algorithm for Image Denoising", CVPR 2005; Rousselle, Knaus & Zwicker, "Adaptive Rendering
//          with Non-Local Means Filtering", SIGGRAPH Asia 2012, for noise of varying variance; Rousselle, Manzi & Zwicker,
//          "Robust Denoising using Feature and Color Information", Pacific Graphics 2013, for features.
// Departs: patches at the border have the pixels that both have; one filter, not a choice among three; no dual buffers.
// Cost:    (2 radius + 1)^2 taps of some 50 operations, and 12 for each plane of a feature.
#include <algorithm>
#include <stdexcept>
#include <string>

#include "passes/spatial/nlm_kernel.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;

enum class Cancellation { conservative, symmetric };

struct Params {
  int radius = 7, patch_radius = 3;
  double k = 0.45, alpha = 1;
  Cancellation cancellation = Cancellation::conservative;
  double k_feature = 0.6, tau = 1e-3;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{0, nlm::kMaxRadius}, "px", "The window is 2 radius + 1 pixels wide and high.");
    field("patch_radius", patch_radius, Range<int>{0, nlm::kMaxPatchRadius}, "px",
          "The patches that are compared are 2 patch_radius + 1 pixels wide and high.");
    field("k", k, Range<double>{1e-3, 1e3}, "1", "Tolerated difference of patches, in standard deviations; more smooths more.");
    field("alpha", alpha, Range<double>{0, 10}, "1",
          "How much of the differences that noise alone makes is taken off; 1: all that is expected, 0: none.");
    field("cancellation", cancellation,
          Choices{{"conservative", "V + min(V, V'), as published: noise of brighter neighbors does not pass for likeness"},
                  {"symmetric",
                   "V + V': what is expected of two pixels of equal mean; without features p and q weigh the same for each"
                   " other"}},
          "Of which variances alpha is a factor.");
    field("k_feature", k_feature, Range<double>{1e-3, 1e3}, "1",
          "Tolerated difference of a feature, in what its gradient or its noise explains.");
    field("tau", tau, Range<double>{1e-12, 1e6}, "feature^2", "Least squared difference that the gradient or the noise explain.");
  }
};

const PassInfo kInfo{
    .id = "nlm",
    .summary = "Mean over a window, weighted by how alike patches and features are beyond their noise",
    .doc =
        "The weight of tap q for pixel p is exp(-max(0, D, F)). D is the mean over the pixels n of a patch, and over channels, of"
        " ((u - u')^2 - alpha (V + min(V, V'))) / (1e-10 + k^2 (V + V')), with the values u = u(p + n), u' = u(q + n) and their"
        " variances V, V'. The variance is that of luminance, which is then compared; or an image of colors that has that of each"
        " channel, and channels are compared. F is the largest, over features, of (|f - f'|^2 - (W + min(W, W'))) / (k_feature^2"
        " max(tau, W, |grad f|^2)), with a feature's values f and f' at p and q, all its planes together, its variance W at p and"
        " W' at q, 0 where none is given, and the gradient of central differences at p, or of one-sided ones where a neighbor is"
        " missing: outside the image, or, of a depth, without surface (1e10). Taps outside the image are left out, and so are"
        " pixels of a patch that have no counterpart there. Variances below 0 count as 0.\n\n"
        "The variance decides all: it is that of the color as it comes in, after what was accumulated. Features should be of"
        " about the range 0 to 1 and free of noise, or have a variance: albedo and normals serve well. Of a feature that slopes,"
        " such as depth, k_feature pixels are tolerated.",
    .source =
        "Rousselle et al., Adaptive Rendering with Non-Local Means Filtering, SIGGRAPH Asia 2012, the distance for nonuniform"
        " variance with its k = 0.45, patches of 7 x 7; Rousselle et al., Robust Denoising using Feature and Color Information,"
        " Pacific Graphics 2013, the feature distance and the smaller of two weights. Departs: luminance is compared where its"
        " variance alone is known; a feature's planes make one distance.",
    .inputs = {{"color", kColor, "what is filtered"},
               {"variance", kVariance | kColor, "of the color: of its luminance, or of each channel"},
               {.name = "feature",
                .types = kColor | kAlbedo | kNormal | kPosition | kDepth | kScalar,
                .doc = "what must be alike as well: albedo, normals, ...; at most 8",
                .optional = true,
                .array = true},
               {.name = "feature_variance",
                .types = kVariance | kScalar,
                .doc = "variance of each feature, summed over its planes: none, or one for each feature in the same order",
                .optional = true,
                .array = true}},
    .outputs = {{"color", kColor, "filtered radiance"}},
};

class Nlm final : public Pass {
 public:
  explicit Nlm(const Params& p)
      : settings_{.radius = p.radius,
                  .patch_radius = p.patch_radius,
                  .k_squared = static_cast<float>(p.k * p.k),
                  .alpha = static_cast<float>(p.alpha),
                  .symmetric = p.cancellation == Cancellation::symmetric,
                  .k_feature_squared = static_cast<float>(p.k_feature * p.k_feature),
                  .tau = static_cast<float>(p.tau)} {}

  void infer(Inference& inference) const override {
    check_counts(inference.count("feature"), inference.count("feature_variance"));
    const int reach = settings_.radius + settings_.patch_radius;
    inference.set_radius("color", reach), inference.set_radius("variance", reach);
    inference.set_radius("feature", std::max(settings_.radius, 1));  // 1 for the gradient
    inference.set_radius("feature_variance", settings_.radius);
    inference.set_slot_scratch(nlm::scratch_bytes(settings_, inference.count("feature")));
  }

  void run(const Frame& frame) const override {
    nlm::Images in{frame.image("color"), frame.image("variance"), {}, 0};
    for (std::size_t i = 0; i < frame.count("feature"); ++i)
      if (const FloatImage feature = frame.image("feature", i))  // one that is absent in this frame is left out
        in.features[static_cast<std::size_t>(in.feature_count++)] = {feature, frame.image("feature_variance", i),
                                                                     frame.type("feature", i) == QUELL_TYPE_DEPTH};
    const FloatOutput out = frame.output("color");
    frame.parallel_rows(
        out.height,
        [&](int y0, int y1, std::uint32_t slot) {
          nlm::filter_rows(in, settings_, out, y0, y1, static_cast<float*>(frame.slot_scratch(slot)));
        },
        kRowsPerChunk);
  }

 private:
  static void check_counts(std::size_t features, std::size_t variances) {
    if (features > nlm::kMaxFeatures)
      throw std::invalid_argument("there are " + std::to_string(features) + " features; at most " +
                                  std::to_string(nlm::kMaxFeatures) + " are compared");
    if (variances != 0 && variances != features)
      throw std::invalid_argument("there are " + std::to_string(features) + " features and " + std::to_string(variances) +
                                  " variances of features; give each feature one, or none");
  }

  static constexpr int kRowsPerChunk = 16;  // the height of a tile
  nlm::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Nlm, Params)
