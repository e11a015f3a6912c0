#include <algorithm>
#include <cmath>
#include <optional>

#include "quell/sequence/checked_output.h"
#include "quell/sequence/image_writer.h"

namespace quell {
namespace {

constexpr int kBandRows = 64;                // of alpha, read at a time
constexpr std::size_t kLongestKeyword = 79;  // of a PNG's texts, in bytes

/// Rows of a picture's alpha, a band at a time.
class AlphaRows {
 public:
  AlphaRows(const FileContent& content, const Placement& placement) : original_(content.original), window_(placement.image) {
    if (original_ && content.keep_channels && content.layers.front().image.channels() == 3) channel_ = original_->alpha();
    values_.resize(channel_ ? static_cast<std::size_t>(window_.width) * kBandRows : 0);
  }
  bool any() const { return channel_.has_value(); }
  const float* row(int y) {
    if (y % kBandRows == 0) {
      const int height = std::min(kBandRows, window_.height - y);
      const FloatOutput out{window_.width, height, 1, window_.width, 0, values_.data()};
      original_->file().read({*channel_}, {window_.x, window_.y + y, window_.width, height}, out);
    }
    return values_.data() + static_cast<std::ptrdiff_t>(y % kBandRows) * window_.width;
  }

 private:
  OriginalFile* original_;
  Rectangle window_;
  std::optional<int> channel_;
  std::vector<float> values_;
};

std::uint8_t to_8(float value) {
  return static_cast<std::uint8_t>(std::lround(255 * (value > 0 ? std::min(value, 1.0F) : 0.0F)));
}

void fill_png_row(const FloatImage& from, int y, const float* alpha, std::uint8_t* out) {
  for (int x = 0; x < from.width; ++x) {
    const float a = alpha ? alpha[x] : 1.0F;
    for (int c = 0; c < from.channels; ++c) *out++ = to_srgb8(a > 0 ? from.row(y, c)[x] / a : from.row(y, c)[x]);
    if (alpha) *out++ = to_8(a);
  }
}

/// Those that PNG can hold.
void add_texts(OIIO::ImageSpec& spec, const FileContent& content, const FileSinkOptions& options) {
  OIIO::ImageSpec all;
  add_attributes(all, content, options);
  for (const OIIO::ParamValue& value : all.extra_attribs)
    if (value.name().size() <= kLongestKeyword) spec.extra_attribs.add_or_replace(value);
  if (content.frame) spec.attribute("quell:frame", std::to_string(*content.frame));
}

}  // namespace

bool png_can_hold(PortType type) {
  const PortTypeInfo& about = info(type);
  return type == QUELL_TYPE_COLOR || type == QUELL_TYPE_ALBEDO || (about.channels == 1 && about.format == QUELL_FORMAT_F32);
}

std::uint8_t to_srgb8(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  const double value = linear;
  const double encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

void write_png(const FileContent& content, const FileSinkOptions& options, const std::filesystem::path& file) {
  const Image& image = content.layers.front().image;
  const Placement placement = place(content);
  AlphaRows alpha(content, placement);
  OIIO::ImageSpec spec(image.width(), image.height(), image.channels() + (alpha.any() ? 1 : 0), OIIO::TypeUInt8);
  spec.attribute("PixelAspectRatio", placement.pixel_aspect);
  add_texts(spec, content, options);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);  // as it is handed over
  CheckedOutput output("png", file, spec);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(spec.nchannels));
  for (int y = 0; y < image.height(); ++y) {
    fill_png_row(image.floats(), y, alpha.any() ? alpha.row(y) : nullptr, row.data());
    output.write_rows(y, y + 1, OIIO::TypeUInt8, row.data());
  }
  output.close();
}

}  // namespace quell
