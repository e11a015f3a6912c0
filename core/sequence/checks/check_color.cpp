// Color, albedo and alpha: what radiance and reflectance can be, and NaN and infinity in all inputs.
#include <algorithm>
#include <cmath>

#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/statistics.h"

namespace quell {
namespace {

constexpr double kFewNegative = 0.001;  // filters with negative lobes leave some
constexpr double kFirefly = 100;        // times the mean
constexpr double kClipped = 0.001;      // share of pixels at exactly 1 with none above: cut off there
constexpr float kBrightestAlbedo = 4;   // some renderers exceed 1 at grazing angles, and let lights have any
constexpr double kFewBright = 0.02;     // such lights seen

struct Range {
  std::size_t pixels = 0, negative = 0, above_one = 0, at_one = 0, zero = 0, bright = 0;
  float largest = 0;
  double sum = 0;  ///< of the largest channel of each pixel
  double share(std::size_t n) const { return pixels == 0 ? 0 : static_cast<double>(n) / static_cast<double>(pixels); }
};

/// Pixels by their largest and smallest channel; those that are not finite are left out.
template <class Visit>
void each_pixel(const FloatImage& image, const Visit& visit) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      float low = image.at(x, y), high = low;
      bool finite = std::isfinite(low);
      for (int c = 1; c < image.channels; ++c) {
        const float value = image.at(x, y, c);
        low = std::min(low, value), high = std::max(high, value), finite = finite && std::isfinite(value);
      }
      if (finite) visit(x, y, low, high);
    }
}

Range measure(const FloatImage& image) {
  Range range;
  each_pixel(image, [&](int, int, float low, float high) {
    ++range.pixels, range.negative += low < 0, range.zero += low == 0 && high == 0;
    range.above_one += high > 1, range.bright += high > kBrightestAlbedo, range.at_one += high == 1;
    range.largest = std::max(range.largest, high), range.sum += high;
  });
  return range;
}

bool is_integer_format(const CheckedImage& color) { return color.numbers == Numbers::uint8 || color.numbers == Numbers::uint16; }

void judge_display(Finding& finding, const CheckedImage& color, const Range& range) {
  const bool linear = color.read_as.transfer.value_or(Transfer::linear) == Transfer::linear;
  if (is_integer_format(color) && linear) {
    finding.verdict = Verdict::suspicious;
    finding.text += "; files of integers seldom hold linear light";
    finding.remedy = Remedy{color.name, {}};
    finding.remedy->settings.transfer = Transfer::srgb;
  } else if (range.above_one == 0 && range.share(range.at_one) > kClipped) {
    finding.verdict = Verdict::suspicious;
    finding.text +=
        "; " + percent(range.share(range.at_one)) + " of the pixels are exactly 1 and none is above: made for a display?";
  }
}

Finding check_radiance(const CheckedImage& color) {
  const FloatImage pixels = color.image.floats();
  const Range range = measure(pixels);
  const double mean = range.pixels == 0 ? 0 : range.sum / static_cast<double>(range.pixels);
  std::size_t fireflies = 0;
  each_pixel(pixels, [&](int, int, float, float high) { fireflies += high > kFirefly * mean && mean > 0; });
  Finding finding{Verdict::ok, kColorSubject, "up to " + short_number(range.largest) + ", " + short_number(mean) + " on average"};
  finding.figures = {{"negative_share", range.share(range.negative)}, {"fireflies", static_cast<double>(fireflies)}};
  if (fireflies > 0) finding.text += "; " + std::to_string(fireflies) + " pixels are over 100 times brighter than that";
  if (range.share(range.zero) == 1) {
    finding.verdict = Verdict::suspicious, finding.text = "all black";
  } else if (range.share(range.negative) > kFewNegative) {
    finding.verdict = Verdict::suspicious;
    finding.text += "; " + percent(range.share(range.negative)) + " of the pixels are negative";
  } else {
    judge_display(finding, color, range);
  }
  return finding;
}

Finding check_albedo(const CheckedImage& albedo) {
  const Range range = measure(albedo.image.floats());
  Finding finding{Verdict::ok, kAlbedoSubject, "0 to " + short_number(range.largest)};
  finding.figures = {{"negative_share", range.share(range.negative)}, {"largest", range.largest}};
  if (range.above_one > 0) finding.text += "; " + percent(range.share(range.above_one)) + " of the pixels exceed 1";
  const bool odd =
      range.share(range.negative) > kFewNegative || range.share(range.bright) > kFewBright || range.share(range.zero) == 1;
  if (odd) finding.verdict = Verdict::suspicious;
  if (range.share(range.zero) == 1) finding.text = "all black";
  if (range.negative > 0) finding.text += "; " + percent(range.share(range.negative)) + " of the pixels are negative";
  return finding;
}

Finding check_alpha(const FrameData& frame) {
  const FloatImage alpha = frame.alpha->image.floats();
  const FloatImage color = (frame.color->stored ? frame.color->stored : frame.color->image).floats();
  const bool premultiplied = frame.color->read_as.alpha.value_or(AlphaKind::premultiplied) == AlphaKind::premultiplied;
  std::size_t empty = 0, colored = 0;
  each_pixel(color, [&](int x, int y, float low, float high) {
    if (alpha.at(x, y) != 0) return;
    ++empty, colored += low != 0 || high != 0;
  });
  if (empty == 0)
    return {Verdict::not_tested, kAlphaSubject, "it is nowhere 0, so that nothing tells whether color is premultiplied"};
  const double share = static_cast<double>(colored) / static_cast<double>(empty);
  Finding finding{Verdict::ok, kAlphaSubject, percent(share) + " of the pixels with alpha 0 have a color"};
  finding.figures = {{"colored_share", share}};
  if (!premultiplied || share < 0.5) return finding;
  finding.verdict = Verdict::suspicious;
  finding.text += ": it is straight, or the color holds a background that alpha does not know";
  finding.remedy = Remedy{frame.color->name, {}};
  finding.remedy->settings.alpha = AlphaKind::straight;
  return finding;
}

struct Odd {
  std::size_t nan = 0, infinite = 0;
};

Odd count_odd(const FloatImage& image, int channel) {
  Odd odd;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      odd.nan += std::isnan(image.at(x, y, channel)), odd.infinite += std::isinf(image.at(x, y, channel));
    }
  return odd;
}

/// "color: 3 NaN and 1 infinite in plane 2"; "" when all is finite. Infinite depth says that there is no surface.
std::string describe_odd(const CheckedImage& input, std::size_t& total) {
  const Image& image = input.stored ? input.stored : input.image;
  if (!image || image.type() == QUELL_TYPE_ID) return "";
  std::string text;
  for (int c = 0; c < image.channels(); ++c) {
    Odd odd = count_odd(image.floats(), c);
    if (input.image.type() == QUELL_TYPE_DEPTH) odd.infinite = 0;
    total += odd.nan + odd.infinite;
    if (odd.nan + odd.infinite == 0) continue;
    text += text.empty() ? input.name + ": " : ", ";
    if (odd.nan > 0) text += std::to_string(odd.nan) + " NaN ";
    if (odd.infinite > 0) text += std::string(odd.nan > 0 ? "and " : "") + std::to_string(odd.infinite) + " infinite ";
    text += "in plane " + std::to_string(c + 1);
  }
  return text;
}

}  // namespace

std::vector<Finding> check_color(const FrameData& frame) {
  std::vector<Finding> findings;
  if (frame.color) findings.push_back(check_radiance(*frame.color));
  if (frame.albedo) findings.push_back(check_albedo(*frame.albedo));
  if (frame.color && frame.alpha && frame.color->image.size() == frame.alpha->image.size())
    findings.push_back(check_alpha(frame));
  return findings;
}

std::vector<Finding> check_finite(const FrameData& frame) {
  const auto images = list_images(frame);
  if (images.empty()) return {};
  Finding finding{Verdict::ok, kFiniteSubject,
                  "no NaN or infinity in " + std::to_string(images.size()) + (images.size() == 1 ? " image" : " images")};
  std::string odd;
  std::size_t total = 0;
  for (const CheckedImage* image : images)
    if (const std::string text = describe_odd(*image, total); !text.empty()) odd += (odd.empty() ? "" : "; ") + text;
  finding.figures = {{"count", static_cast<double>(total)}};
  if (odd.empty()) return {finding};
  finding.verdict = Verdict::suspicious;
  finding.text = odd + "; a run replaces them by 0";
  return {finding};
}

}  // namespace quell
