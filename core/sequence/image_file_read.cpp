// The pixels of ImageFile: bands of rows, or of tiles, from OpenImageIO's interleaved buffers into planes.
#include <algorithm>
#include <cassert>

#include "quell/sequence/image_file_state.h"
#include "quell/sequence/oiio.h"
#include "quell/text/error.h"

namespace quell {
namespace {

// Rows read at a time: at least two blocks of every compression but DWAB.
constexpr int kBand = 64;
constexpr std::size_t kMaxBandBytes = std::size_t{64} << 20;
// Channels between two wanted ones that are read along rather than decoding the file twice.
constexpr int kMaxGap = 8;

template <class Value>
constexpr OIIO::TypeDesc kType = std::is_same_v<Value, float>           ? OIIO::TypeFloat
                                 : std::is_same_v<Value, std::uint32_t> ? OIIO::TypeUInt32
                                 : std::is_same_v<Value, std::uint16_t> ? OIIO::TypeUInt16
                                                                        : OIIO::TypeUInt8;

float to_float(float value) { return value; }
float to_float(std::uint32_t value) { return static_cast<float>(value); }
float to_float(std::uint16_t value) { return static_cast<float>(value) / 65535.0F; }
float to_float(std::uint8_t value) { return static_cast<float>(value) / 255.0F; }

/// Neighboring channels of a part that are read together.
struct Span {
  int part, first, count;
};

/// A band as it comes from the file: rows [y, y + height) and columns [x, x + width), in the file's coordinates.
template <class Value>
class BandReader {
 public:
  BandReader(ImageFile::State& file, const Span& span) : file_(file), span_(span) {}

  /// Hands each row's wanted part to store(x, y, pixels, pointer to the first, step from a pixel to the next), in the file's
  /// coordinates.
  template <class Store>
  void read(const Rectangle& wanted, const Store& store) {
    const OIIO::ImageSpec& spec = this->spec();
    const auto down = [](int value, int step) { return value / step * step; };
    const bool tiled = spec.tile_width > 0;
    // Tiles are read whole, so the columns begin and end at their borders; scan lines are whole anyway.
    const int left = tiled ? down(wanted.x - spec.x, spec.tile_width) : 0;
    const int right =
        tiled ? std::min(down(wanted.x - spec.x + wanted.width - 1, spec.tile_width) + spec.tile_width, spec.width) : spec.width;
    const int rows = tiled ? spec.tile_height : band_height(right - left);
    const int top = wanted.y - spec.y, bottom = top + wanted.height;
    for (int begin = down(top, rows); begin < bottom; begin += rows) {
      const Rectangle band{spec.x + left, spec.y + begin, right - left, std::min(begin + rows, spec.height) - begin};
      fetch(band, tiled);
      const int first = std::max(band.y, wanted.y), last = std::min(band.y + band.height, wanted.y + wanted.height);
      for (int y = first; y < last; ++y) {
        const std::ptrdiff_t skip = std::ptrdiff_t{y - band.y} * band.width + (wanted.x - band.x);
        store(wanted.x, y, wanted.width, pixels_.data() + skip * span_.count, span_.count);
      }
    }
  }

 private:
  const OIIO::ImageSpec& spec() const { return file_.parts[static_cast<std::size_t>(span_.part)].spec; }

  int band_height(int width) const {
    const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(span_.count) * sizeof(Value);
    int height = kBand;
    while (height > 1 && row * static_cast<std::size_t>(height) > kMaxBandBytes) height /= 2;
    return height;
  }

  void fetch(const Rectangle& band, bool tiled) {
    pixels_.resize(static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.height) *
                   static_cast<std::size_t>(span_.count));
    const int last = span_.first + span_.count, y_end = band.y + band.height;
    OIIO::ImageInput& input = *file_.file;
    const bool ok = tiled
                        ? input.read_tiles(span_.part, 0, band.x, band.x + band.width, band.y, y_end, 0, 1, span_.first, last,
                                           kType<Value>, pixels_.data())
                        : input.read_scanlines(span_.part, 0, band.y, y_end, 0, span_.first, last, kType<Value>, pixels_.data());
    // Asked for in any case: what is not asked for is printed, and the TIFF reader says that all is well even where a file ends
    // early.
    const std::string why = input.geterror();
    if (!ok || !why.empty()) file_.fail("truncated or damaged: " + one_line(why));
  }

  ImageFile::State& file_;
  Span span_;
  std::vector<Value> pixels_;
};

/// A plane of the output and the channel of its part that goes there.
struct Plane {
  int plane, part, index;
  Numbers numbers;
};

template <class Value>
void read_planes(ImageFile::State& file, const std::vector<Plane>& planes, const Rectangle& window, FloatOutput out) {
  const int part = planes.front().part, first = planes.front().index;
  const Rectangle covered = intersection(file.parts[static_cast<std::size_t>(part)].data, window);
  if (covered.empty()) return;
  BandReader<Value> reader(file, {part, first, planes.back().index - first + 1});
  reader.read(covered, [&](int x0, int y, int count, const Value* row, int step) {
    for (const Plane& plane : planes) {
      const Value* from = row + (plane.index - first);
      float* to = out.row(y - window.y, plane.plane) + (x0 - window.x);
      for (int x = 0; x < count; ++x) to[x] = to_float(from[std::ptrdiff_t{x} * step]);
    }
  });
}

void read_span(ImageFile::State& file, const std::vector<Plane>& planes, const Rectangle& window, FloatOutput out) {
  switch (planes.front().numbers) {
    case Numbers::uint32:  // as float, OpenImageIO would scale it to 0 to 1
      return read_planes<std::uint32_t>(file, planes, window, out);
    case Numbers::uint16:
      return read_planes<std::uint16_t>(file, planes, window, out);
    case Numbers::uint8:
      return read_planes<std::uint8_t>(file, planes, window, out);
    default:
      return read_planes<float>(file, planes, window, out);
  }
}

bool is_near(const Plane& a, const Plane& b) {
  const bool alike = a.numbers == b.numbers || (!is_integer(a.numbers) && !is_integer(b.numbers));
  return a.part == b.part && alike && b.index - a.index <= kMaxGap + 1;
}

template <class Value>
void read_integers(ImageFile::State& file, const Span& span, const Rectangle& covered, const Rectangle& window, IdOutput out) {
  BandReader<Value>(file, span).read(covered, [&](int x0, int y, int count, const Value* row, int) {
    std::copy_n(row, count, out.row(y - window.y) + (x0 - window.x));
  });
}

}  // namespace

void ImageFile::read(const std::vector<int>& selected, const Rectangle& window, FloatOutput out) {
  for (int c = 0; c < out.channels; ++c)
    for (int y = 0; y < out.height; ++y) std::fill_n(out.row(y, c), out.width, 0.0F);
  std::vector<Plane> planes;
  for (std::size_t i = 0; i < selected.size(); ++i) {
    const auto channel = static_cast<std::size_t>(selected[i]);
    const FileChannel& about = state_->channels[channel];
    planes.push_back({static_cast<int>(i), about.part, state_->index[channel], about.numbers});
  }
  std::sort(planes.begin(), planes.end(),
            [](const Plane& a, const Plane& b) { return std::pair(a.part, a.index) < std::pair(b.part, b.index); });
  for (auto begin = planes.begin(); begin != planes.end();) {
    auto end = std::next(begin);
    while (end != planes.end() && is_near(*std::prev(end), *end)) ++end;
    read_span(*state_, {begin, end}, window, out);
    begin = end;
  }
}

void ImageFile::read(int channel, const Rectangle& window, IdOutput out) {
  for (int y = 0; y < out.height; ++y) std::fill_n(out.row(y), out.width, 0U);
  const FileChannel& about = state_->channels[static_cast<std::size_t>(channel)];
  assert(is_integer(about.numbers));
  const Rectangle covered = intersection(data_window(channel), window);
  if (covered.empty()) return;
  const Span span{about.part, state_->index[static_cast<std::size_t>(channel)], 1};
  if (about.numbers == Numbers::uint8) return read_integers<std::uint8_t>(*state_, span, covered, window, out);
  if (about.numbers == Numbers::uint16) return read_integers<std::uint16_t>(*state_, span, covered, window, out);
  read_integers<std::uint32_t>(*state_, span, covered, window, out);
}

}  // namespace quell
