// The constants of FLIP: its filters for a distance of the observer, its color spaces, and how color differences are mapped.
// Section and equation numbers are those of Andersson et al., HPG 2020.
#pragma once

#include <array>
#include <vector>

namespace quell {

/// A filter that is even or odd: the weights from its center to one of its ends.
using HalfFilter = std::vector<float>;

/// The separable filters, in pixels. Weights are made in double, then rounded once.
struct FlipFilters {
  /// Throws Error(usage) when pixels_per_degree is not within 1..1000.
  explicit FlipFilters(double pixels_per_degree);

  /// Contrast sensitivity (section 4.1.1): achromatic and red-green. Each sums to 1, and ends where all that follows weighs less
  /// than 1e-8.
  HalfFilter luma, red_green;
  /// Blue-yellow is a sum of two Gaussians: blue_yellow[0](x) blue_yellow[0](y) + blue_yellow[1](x) blue_yellow[1](y) sums to 1.
  std::array<HalfFilter, 2> blue_yellow;
  /// Features (section 4.2.1), one radius: a Gaussian that sums to 1; its first derivative (odd: the value at -x is minus that at
  /// x), and its second, the positive weights of which sum to 1 and the negative ones to -1.
  HalfFilter smooth, edge, point;
  /// The largest radius of all.
  int radius = 0;
};

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// Linear sRGB to XYZ, each divided by that of white (D65: x = 0.31271, y = 0.32902).
extern const Matrix3 kRgbToXyz;
/// Linear sRGB to what the filters of contrast sensitivity work on: Y, X - Y and Y - Z of white-relative XYZ. The paper's YCxCz
/// is 116 Y - 16, 500 (X - Y), 200 (Y - Z), which filters that sum to 1 leave so.
extern const Matrix3 kRgbToOpponent, kOpponentToRgb;

/// The color difference HyAB^0.7 (section 4.1.3) at which the mapping to 0..1 has its knee, and the largest: of green and blue.
struct FlipRange {
  double knee, largest;
};
FlipRange flip_range();

inline constexpr double kFlipColorPower = 0.7;     // q_c
inline constexpr double kFlipKnee = 0.4;           // p_c, of the largest difference
inline constexpr double kFlipKneeError = 0.95;     // p_t, the error there
inline constexpr double kFlipFeatureWidth = .082;  // w, degrees; q_f is 1/2, a square root

/// Rounding of the paper's program that we add on purpose, as a share of the luma. On a flat area exact edges are 0. The program
/// filters in float and finds edges there of up to 2.7e-7 of the luma (6e-8 in the mean), which differ from luma to luma like
/// noise; features enter by a square root, so that its figures of flat areas show it: .196255 for grays of .5 and .6, where exact
/// edges give .196215. No one share gives what the program does. Those of 1e-7 to 2.4e-7 bring all published figures to within
/// 1e-5; this one is fitted, to lie between. Where there are edges, it is nothing beside them.
inline constexpr float kFlipEdgeRounding = 1.44e-7F;

/// The tone curve of HDR-FLIP, (k0 x^2 + k1 x) / (k2 x^2 + k3 x + k4) clamped to 1: Narkowicz' fit of ACES (2015) at 0.6 x, as
/// the paper's program has it.
inline constexpr std::array<double, 5> kFlipCurve{0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14};
inline constexpr double kFlipBright = 0.85;  // t: what exposures bring the brightest pixel, and the median, to

}  // namespace quell
