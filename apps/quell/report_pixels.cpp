#include "report_pixels.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <new>
#include <stdexcept>

namespace quell::app {
namespace {

constexpr float kLargestHalf = 65504;

std::string to_base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string deflate_to_text(const std::vector<std::uint8_t>& bytes) {
  // Byte planes of noise hardly get smaller with more effort than this.
  constexpr int kEffort = 6;
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> packed(size);
  const int status = compress2(packed.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), kEffort);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status != Z_OK) throw std::logic_error("zlib refuses an image");
  packed.resize(size);
  return to_base64(packed);
}

/// `bits(x, y, channel)` of each value, in planes of bytes.
template <class Bits>
PackedImage pack_bits(const Image& image, std::size_t bytes_per_value, const char* format, const Bits& bits) {
  const std::size_t count = static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()) *
                            static_cast<std::size_t>(image.channels());
  std::vector<std::uint8_t> planes(count * bytes_per_value);
  std::size_t at = 0;
  for (int c = 0; c < image.channels(); ++c)
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x, ++at) {
        const std::uint32_t value = bits(x, y, c);
        for (std::size_t b = 0; b < bytes_per_value; ++b) planes[b * count + at] = static_cast<std::uint8_t>(value >> (8 * b));
      }
  return {image.size(), image.channels(), format, deflate_to_text(planes)};
}

bool fits_half(float value) { return !(std::abs(value) > kLargestHalf) || !std::isfinite(value); }

/// Whether a half float holds it without rounding: 10 bits behind the leading one, or multiples of 2^-24.
bool is_half(float value) {
  if (!std::isfinite(value)) return true;
  if (!fits_half(value)) return false;
  if (std::abs(value) >= 0x1p-14F) return (std::bit_cast<std::uint32_t>(value) & 0x1fff) == 0;
  return std::nearbyint(value * 0x1p24F) == value * 0x1p24F;
}

bool all_of(FloatImage image, bool (*test)(float)) {
  for (int c = 0; c < image.channels; ++c)
    for (int y = 0; y < image.height; ++y)
      if (!std::all_of(image.row(y, c), image.row(y, c) + image.width, test)) return false;
  return true;
}

}  // namespace

std::uint16_t to_half(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000, magnitude = bits & 0x7fffffff;
  if (magnitude > 0x7f800000) return static_cast<std::uint16_t>(sign | 0x7e00);   // NaN
  if (magnitude >= 0x477ff000) return static_cast<std::uint16_t>(sign | 0x7c00);  // 65520 and more round to infinity
  if (magnitude < 0x38800000) {                                                   // below 2^-14: multiples of 2^-24
    const float steps = std::nearbyint(std::bit_cast<float>(magnitude) * 0x1p24F);
    return static_cast<std::uint16_t>(sign | static_cast<std::uint32_t>(steps));
  }
  const std::uint32_t rounded = magnitude + 0xfff + (magnitude >> 13 & 1);
  return static_cast<std::uint16_t>(sign | (rounded - 0x38000000) >> 13);
}

PackedImage pack(const Image& image, Precision precision) {
  if (info(image.type()).format == QUELL_FORMAT_U32) {
    const IdImage ids = image.ids();
    return pack_bits(image, 4, "u32", [&](int x, int y, int c) { return ids.at(x, y, c); });
  }
  const FloatImage values = image.floats();
  if (all_of(values, precision == Precision::exact ? is_half : fits_half))
    return pack_bits(image, 2, "f16", [&](int x, int y, int c) { return std::uint32_t{to_half(values.at(x, y, c))}; });
  return pack_bits(image, 4, "f32", [&](int x, int y, int c) { return std::bit_cast<std::uint32_t>(values.at(x, y, c)); });
}

int PackedImages::add(PackedImage image) {
  const std::size_t hash = std::hash<std::string>()(image.text);
  const std::lock_guard lock(mutex_);
  const auto [begin, end] = by_hash_.equal_range(hash);
  for (auto known = begin; known != end; ++known)
    if (images_[static_cast<std::size_t>(known->second)] == image) return known->second;
  bytes_ += image.text.size();
  images_.push_back(std::move(image));
  const int number = static_cast<int>(images_.size()) - 1;
  by_hash_.emplace(hash, number);
  return number;
}

std::size_t PackedImages::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace quell::app
