#include "quell/metrics/display.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "quell/text/diagnostic.h"

namespace quell {
namespace {

constexpr std::array kTransforms{
    DisplayInfo{DisplayTransform::reinhard, "reinhard", "(x / (1 + x))^(1/2.2)"},
    DisplayInfo{DisplayTransform::gamma, "gamma", "x^(1/2.2), clamped to 1"},
    DisplayInfo{DisplayTransform::srgb, "srgb", "the curve of sRGB, clamped to 1"},
    DisplayInfo{DisplayTransform::aces, "aces", "Narkowicz's fit of the ACES curve, then the curve of sRGB"},
    DisplayInfo{DisplayTransform::none, "none", "the images hold display values already, which are clamped to 0..1"},
};

double encode_srgb(double light) { return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055; }

}  // namespace

std::span<const DisplayInfo> display_transforms() { return kTransforms; }

const DisplayInfo& info(DisplayTransform transform) { return kTransforms[static_cast<std::size_t>(transform)]; }

DisplayTransform parse_display_transform(std::string_view name, std::string_view option) {
  std::vector<std::string> names;
  for (const DisplayInfo& candidate : kTransforms) {
    if (candidate.name == name) return candidate.transform;
    names.emplace_back(candidate.name);
  }
  throw Error(Fault::usage, std::string(option),
              "there is no display transform '" + printable(name) + "'" + did_you_mean(name, names) + "; transforms are " +
                  list_names(names, "and"));
}

double to_display(DisplayTransform transform, double radiance) {
  const double x = std::max(radiance, 0.0), clamped = std::min(x, 1.0);
  switch (transform) {
    case DisplayTransform::reinhard:
      return std::pow(x / (1 + x), 1 / 2.2);
    case DisplayTransform::gamma:
      return std::pow(clamped, 1 / 2.2);
    case DisplayTransform::srgb:
      return encode_srgb(clamped);
    case DisplayTransform::aces:
      return encode_srgb(std::min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1.0));
    case DisplayTransform::none:
      return clamped;
  }
  return clamped;
}

double to_light(double display) { return display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4); }

}  // namespace quell
