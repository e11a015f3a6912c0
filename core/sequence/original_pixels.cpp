// The pixels of channels that are carried over: copied without a look at what they mean.
#include <algorithm>
#include <cstring>
#include <map>

#include "quell/sequence/image_file_state.h"
#include "quell/sequence/oiio.h"
#include "quell/sequence/original_file.h"

namespace quell {
namespace {

/// Where the values of a row lie, and how far a pixel's is from the next one's.
struct Row {
  const std::byte* from;
  std::size_t from_step;
  std::byte* to;
  std::size_t to_step;
  int count;
};

template <std::size_t bytes>
void copy(const Row& row) {
  for (std::size_t x = 0; x < static_cast<std::size_t>(row.count); ++x)
    std::memcpy(row.to + x * row.to_step, row.from + x * row.from_step, bytes);
}

template <class Value>
void to_float(const Row& row, float largest) {
  for (std::size_t x = 0; x < static_cast<std::size_t>(row.count); ++x) {
    Value value;
    std::memcpy(&value, row.from + x * row.from_step, sizeof value);
    const float result = static_cast<float>(value) / largest;
    std::memcpy(row.to + x * row.to_step, &result, sizeof result);
  }
}

void copy_row(OIIO::TypeDesc type, const Row& row) {
  switch (type.basetype) {
    case OIIO::TypeDesc::HALF:
      return copy<2>(row);
    case OIIO::TypeDesc::DOUBLE:
      return to_float<double>(row, 1);
    case OIIO::TypeDesc::UINT16:
      return to_float<std::uint16_t>(row, 65535);
    case OIIO::TypeDesc::UINT8:
      return to_float<std::uint8_t>(row, 255);
    default:  // float and uint
      return copy<4>(row);
  }
}

}  // namespace

/// A channel on its way.
struct OriginalFile::Copied {
  int index;  // in its part
  OIIO::TypeDesc type;
  std::size_t to, bytes;  // in a pixel of the results
};

void OriginalFile::read(const std::vector<KeptChannel>& channels, const Rectangle& band, std::byte* out,
                        std::size_t pixel_bytes) {
  const ImageFile::State& state = file_.state();
  std::map<int, std::vector<Copied>> parts;
  std::size_t place = 0;
  for (const KeptChannel& kept : channels) {
    const auto channel = static_cast<std::size_t>(kept.channel);
    const std::size_t bytes = kept.half ? 2 : 4;
    const int index = state.index[channel];
    parts[state.channels[channel].part].push_back({index, state.part_of(kept.channel).spec.channelformat(index), place, bytes});
    place += bytes;
  }
  for (const auto& [part, copied] : parts) read_part(part, copied, band, out, pixel_bytes);
}

void OriginalFile::read_part(int part, const std::vector<Copied>& channels, const Rectangle& band, std::byte* out,
                             std::size_t pixel_bytes) {
  ImageFile::State& state = file_.state();
  const ImageFile::State::Part& source = state.parts[static_cast<std::size_t>(part)];
  const OIIO::ImageSpec& spec = source.spec;
  for (const Copied& channel : channels)
    for (std::size_t i = 0; i < static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.height); ++i)
      std::memset(out + i * pixel_bytes + channel.to, 0, channel.bytes);
  const Rectangle covered = intersection(source.data, band);
  if (covered.empty()) return;

  const auto [first, last] =
      std::minmax_element(channels.begin(), channels.end(), [](const Copied& a, const Copied& b) { return a.index < b.index; });
  const int begin = first->index, end = last->index + 1;
  const auto stride = static_cast<std::size_t>(spec.pixel_bytes(begin, end, true));
  const int rows = std::max(spec.tile_height, 1);  // tiles are read whole
  const int top = (covered.y - spec.y) / rows * rows + spec.y;
  const int bottom = std::min((covered.y + covered.height - spec.y + rows - 1) / rows * rows, spec.height) + spec.y;
  std::vector<std::byte> pixels(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(bottom - top) * stride);
  const bool ok = spec.tile_width > 0
                      ? state.file->read_tiles(part, 0, spec.x, spec.x + spec.width, top, bottom, 0, 1, begin, end,
                                               OIIO::TypeUnknown, pixels.data())
                      : state.file->read_scanlines(part, 0, top, bottom, 0, begin, end, OIIO::TypeUnknown, pixels.data());
  const std::string why = state.file->geterror();  // as in BandReader, of TIFF the only sign
  if (!ok || !why.empty()) state.fail("truncated or damaged: " + one_line(why));
  for (const Copied& channel : channels) {
    const auto from = static_cast<std::size_t>(spec.pixel_bytes(begin, channel.index, true));
    for (int y = covered.y; y < covered.y + covered.height; ++y) {
      const std::byte* row = pixels.data() + from +
                             (static_cast<std::size_t>(y - top) * static_cast<std::size_t>(spec.width) +
                              static_cast<std::size_t>(covered.x - spec.x)) *
                                 stride;
      std::byte* to = out + channel.to +
                      (static_cast<std::size_t>(y - band.y) * static_cast<std::size_t>(band.width) +
                       static_cast<std::size_t>(covered.x - band.x)) *
                          pixel_bytes;
      copy_row(channel.type, {row, stride, to, pixel_bytes, covered.width});
    }
  }
}

}  // namespace quell
