#include <algorithm>

#include "quell/sequence/checked_output.h"
#include "quell/sequence/image_writer.h"

namespace quell {
namespace {

constexpr float kLargestHalf = 65504.0F;
constexpr std::size_t kBandBytes = std::size_t{32} << 20;  // of rows handed over at a time
constexpr int kBandRows = 64;                              // at most

int band_rows(std::size_t row_bytes) {
  int rows = kBandRows;
  while (rows > 1 && row_bytes * static_cast<std::size_t>(rows) > kBandBytes) rows /= 2;
  return rows;
}

/// Clamps to the range of half; false when nothing was to be clamped. NaN stays.
bool clamp_to_half(float& value) {
  const float clamped = value > kLargestHalf ? kLargestHalf : value < -kLargestHalf ? -kLargestHalf : value;
  const bool changed = value > kLargestHalf || value < -kLargestHalf;
  value = clamped;
  return changed;
}

OIIO::TypeDesc numbers_of(const WrittenLayer& layer) {
  if (layer.image.type() == QUELL_TYPE_ID) return OIIO::TypeUInt32;
  return layer.half ? OIIO::TypeHalf : OIIO::TypeFloat;
}

/// Interleaves the rows of layers and of kept channels as an EXR file wants them.
class ExrRows {
 public:
  ExrRows(const FileContent& content, const Placement& placement) : content_(content), placement_(placement) {
    for (const WrittenLayer& layer : content.layers)
      for (std::string& name : channel_names(layer.image.type(), layer.name)) add(std::move(name), numbers_of(layer));
    images_bytes_ = pixel_bytes_;
    if (content.original && content.keep_channels) kept_ = content.original->choose(names_);
    for (const KeptChannel& kept : kept_)
      add(kept.name, kept.half ? OIIO::TypeHalf : kept.uint ? OIIO::TypeUInt32 : OIIO::TypeFloat);
    const auto width = static_cast<std::size_t>(placement.data.width);
    floats_.resize(width), halves_.resize(width * 2), is_clamped_.resize(width);
  }

  OIIO::ImageSpec spec() const {
    const auto& [display, image, data, aspect] = placement_;
    OIIO::ImageSpec spec(data.width, data.height, static_cast<int>(names_.size()), OIIO::TypeFloat);
    spec.x = data.x, spec.y = data.y;
    spec.full_x = display.x, spec.full_y = display.y, spec.full_width = display.width, spec.full_height = display.height;
    spec.channelnames = names_, spec.channelformats = formats_;
    spec.attribute("PixelAspectRatio", aspect);
    return spec;
  }
  std::size_t row_bytes() const { return pixel_bytes_ * static_cast<std::size_t>(placement_.data.width); }
  std::uint64_t clamped() const { return clamped_; }

  /// Rows [begin, end) in the file's coordinates.
  void fill(int begin, int end, std::byte* out) {
    const Rectangle band{placement_.data.x, begin, placement_.data.width, end - begin};
    for (int y = begin; y < end; ++y) {
      std::byte* to = out + row_bytes() * static_cast<std::size_t>(y - begin);
      for (const WrittenLayer& layer : content_.layers) to = fill_row(layer, y - placement_.image.y, to);
    }
    if (!kept_.empty()) content_.original->read(kept_, band, out + images_bytes_, pixel_bytes_);
  }

 private:
  void add(std::string name, OIIO::TypeDesc format) {
    names_.push_back(std::move(name));
    formats_.push_back(format);
    pixel_bytes_ += format.size();
  }

  /// The layer's channels of one row of the image; `to` is the place in the row's first pixel. Returns that of what follows.
  std::byte* fill_row(const WrittenLayer& layer, int y, std::byte* to) {
    const int left = placement_.data.x - placement_.image.x;
    std::fill(is_clamped_.begin(), is_clamped_.end(), 0);
    for (int c = 0; c < layer.image.channels(); ++c) {
      if (layer.image.type() == QUELL_TYPE_ID)
        to = put<4>(reinterpret_cast<const std::byte*>(layer.image.ids().row(y, c) + left), to);
      else if (!layer.half)
        to = put<4>(reinterpret_cast<const std::byte*>(layer.image.floats().row(y, c) + left), to);
      else
        to = put<2>(to_halves(layer.image.floats().row(y, c) + left), to);
    }
    clamped_ += static_cast<std::uint64_t>(std::count(is_clamped_.begin(), is_clamped_.end(), 1));
    return to;
  }

  const std::byte* to_halves(const float* row) {
    for (std::size_t x = 0; x < floats_.size(); ++x) {
      floats_[x] = row[x];
      if (clamp_to_half(floats_[x])) is_clamped_[x] = 1;
    }
    OIIO::convert_pixel_values(OIIO::TypeFloat, floats_.data(), OIIO::TypeHalf, halves_.data(), static_cast<int>(floats_.size()));
    return halves_.data();
  }

  template <std::size_t bytes>
  std::byte* put(const std::byte* row, std::byte* to) const {
    for (std::size_t x = 0; x < floats_.size(); ++x) std::copy_n(row + x * bytes, bytes, to + x * pixel_bytes_);
    return to + bytes;
  }

  const FileContent& content_;
  const Placement& placement_;
  std::vector<std::string> names_;
  std::vector<OIIO::TypeDesc> formats_;
  std::vector<KeptChannel> kept_;
  std::size_t images_bytes_ = 0, pixel_bytes_ = 0;
  std::vector<float> floats_;
  std::vector<std::byte> halves_;
  std::vector<char> is_clamped_;
  std::uint64_t clamped_ = 0;
};

}  // namespace

std::uint64_t write_exr(const FileContent& content, const FileSinkOptions& options, const std::filesystem::path& file) {
  const Placement placement = place(content);
  ExrRows rows(content, placement);
  OIIO::ImageSpec spec = rows.spec();
  spec.attribute("DateTime", "");  // else the time of writing, and no two runs would give the same bytes
  add_attributes(spec, content, options);
  spec.attribute("compression", options.compression);
  CheckedOutput output("openexr", file, spec);
  const int height = band_rows(rows.row_bytes()), bottom = spec.y + spec.height;
  std::vector<std::byte> band(rows.row_bytes() * static_cast<std::size_t>(std::min(height, spec.height)));
  for (int begin = spec.y; begin < bottom; begin += height) {
    const int end = std::min(begin + height, bottom);
    rows.fill(begin, end, band.data());
    output.write_rows(begin, end, OIIO::TypeUnknown, band.data());
  }
  output.close();
  return rows.clamped();
}

}  // namespace quell
