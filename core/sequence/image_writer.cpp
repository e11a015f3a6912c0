#include "quell/sequence/image_writer.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "quell/sequence/oiio.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr float kLargestHalf = 65504.0F;
constexpr int kBand = 64;  // rows handed over at a time, so that the interleaved copy stays small

/// A file that OpenImageIO writes to, and that knows whether all of it arrived: OpenImageIO itself does not look when its PNG
/// writer writes, nor at what a file still holds when it is closed, so that on a full disk half a picture would pass for whole.
class CheckedFile final : public OIIO::Filesystem::IOFile {
 public:
  explicit CheckedFile(const std::filesystem::path& file) : IOFile(std::fopen(file.c_str(), "wb"), Write) {
    note(m_file != nullptr);
  }
  ~CheckedFile() override { finish(); }

  std::size_t write(const void* data, std::size_t size) override {
    const std::size_t written = IOFile::write(data, size);
    note(written == size);
    return written;
  }
  bool seek(std::int64_t offset) override {  // writes what was held back
    const bool ok = IOFile::seek(offset);
    note(ok);
    return ok;
  }
  void close() override {}  // finish() does, and looks

  /// Writes what is left and closes the file.
  void finish() {
    if (m_file) note(std::fclose(m_file) == 0);
    m_file = nullptr;
  }
  /// The errno of the first failure; 0 for none.
  int error() const { return error_; }

 private:
  void note(bool ok) {
    if (!ok && error_ == 0) error_ = errno;
  }
  int error_ = 0;
};

/// Opens the file with OpenImageIO's writer of a format, has rows written in bands, and closes it.
/// fill(y, out) interleaves row y.
template <class Value, class Fill>
void write_rows(const char* format, const std::filesystem::path& file, OIIO::ImageSpec spec, OIIO::TypeDesc type,
                const Fill& fill) {
  prepare_oiio();
  CheckedFile checked(file);
  const auto output = OIIO::ImageOutput::create(format);
  if (!output)
    throw Error(Fault::frame, file.string(), "OpenImageIO cannot write " + std::string(format) + ": " + OIIO::geterror());
  const auto check = [&](bool ok) {
    if (ok && checked.error() == 0) return;
    const std::string why = one_line(output->geterror());  // asked for in any case: what is not asked for is printed
    throw Error(Fault::frame, file.string(), "cannot be written: " + (checked.error() ? std::strerror(checked.error()) : why));
  };
  OIIO::Filesystem::IOProxy* const proxy = &checked;  // as an attribute, for the EXR writer forgets set_ioproxy()
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  check(output->open(file.string(), spec));
  const std::size_t row = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels);
  std::vector<Value> band(row * static_cast<std::size_t>(std::min(kBand, spec.height)));
  for (int begin = 0; begin < spec.height; begin += kBand) {
    const int end = std::min(begin + kBand, spec.height);
    for (int y = begin; y < end; ++y) fill(y, band.data() + row * static_cast<std::size_t>(y - begin));
    check(output->write_scanlines(begin, end, 0, type, band.data()));
  }
  check(output->close());
  checked.finish();
  check(true);
}

/// Clamps to the range of half; false when nothing was to be clamped. NaN stays.
bool clamp_to_half(float& value) {
  const float clamped = value > kLargestHalf ? kLargestHalf : value < -kLargestHalf ? -kLargestHalf : value;
  const bool changed = value > kLargestHalf || value < -kLargestHalf;
  value = clamped;
  return changed;
}

}  // namespace

std::vector<std::string> channel_names(PortType type) {
  switch (type) {
    case QUELL_TYPE_COLOR:
    case QUELL_TYPE_ALBEDO:
      return {"R", "G", "B"};
    case QUELL_TYPE_NORMAL:
    case QUELL_TYPE_POSITION:
      return {"X", "Y", "Z"};
    case QUELL_TYPE_MOTION:
    case QUELL_TYPE_MOMENTS:
      return {"X", "Y"};
    case QUELL_TYPE_DEPTH:
      return {"Z"};
    case QUELL_TYPE_ALPHA:
      return {"A"};
    default:
      return {"Y"};
  }
}

std::uint64_t write_exr(const Image& image, const std::filesystem::path& file, bool half, const std::string& compression) {
  const bool ids = image.type() == QUELL_TYPE_ID;
  OIIO::ImageSpec spec(image.width(), image.height(), image.channels(),
                       ids    ? OIIO::TypeUInt32
                       : half ? OIIO::TypeHalf
                              : OIIO::TypeFloat);
  spec.channelnames = channel_names(image.type());
  spec.attribute("compression", compression);
  spec.attribute("DateTime", "");  // else the time of writing, and no two runs would give the same bytes
  if (ids) {
    const IdImage from = image.ids();
    write_rows<std::uint32_t>("openexr", file, spec, OIIO::TypeUInt32,
                              [&](int y, std::uint32_t* out) { std::copy_n(from.row(y), from.width, out); });
    return 0;
  }
  std::uint64_t clamped = 0;
  const FloatImage from = image.floats();
  write_rows<float>("openexr", file, spec, OIIO::TypeFloat, [&](int y, float* out) {
    for (int x = 0; x < from.width; ++x) {
      bool changed = false;
      for (int c = 0; c < from.channels; ++c, ++out) {
        *out = from.row(y, c)[x];
        if (half && clamp_to_half(*out)) changed = true;
      }
      clamped += changed ? 1 : 0;
    }
  });
  return clamped;
}

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

void write_png(const Image& image, const std::filesystem::path& file) {
  OIIO::ImageSpec spec(image.width(), image.height(), image.channels(), OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  const FloatImage from = image.floats();
  write_rows<std::uint8_t>("png", file, spec, OIIO::TypeUInt8, [&](int y, std::uint8_t* out) {
    for (int x = 0; x < from.width; ++x)
      for (int c = 0; c < from.channels; ++c) *out++ = to_srgb8(from.row(y, c)[x]);
  });
}

}  // namespace quell
