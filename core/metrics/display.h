// From scene-linear radiance to what a display shows, which is what PSNR, SSIM and FLIP are about.
#pragma once

#include <span>
#include <string_view>

namespace quell {

/// Negative values count as 0 before each. All are applied channel by channel.
enum class DisplayTransform {
  reinhard,  ///< (x / (1 + x))^(1/2.2): keeps highlights apart; the default
  gamma,     ///< x^(1/2.2), x clamped to 1
  srgb,      ///< the curve of IEC 61966-2-1, x clamped to 1
  aces,      ///< Narkowicz's fit of the ACES curve (2015), then srgb
  none,      ///< the images hold display values already; clamped to 0..1
};

struct DisplayInfo {
  DisplayTransform transform;
  std::string_view name;     ///< as options have it
  std::string_view summary;  ///< the formula
};
std::span<const DisplayInfo> display_transforms();
const DisplayInfo& info(DisplayTransform transform);
/// Throws Error(usage) with `option` as its place, a suggestion and the list.
DisplayTransform parse_display_transform(std::string_view name, std::string_view option);

/// One finite value, in double: the definition, which the fast version for whole images equals to within 2e-6.
double to_display(DisplayTransform transform, double radiance);

/// The light that an sRGB display makes of a display value of 0..1 (IEC 61966-2-1), 0..1: what FLIP looks at.
double to_light(double display);

}  // namespace quell
