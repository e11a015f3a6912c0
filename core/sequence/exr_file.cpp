#include "quell/sequence/exr_file.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>

#include "quell/sequence/oiio.h"
#include "quell/text/error.h"

namespace quell {

struct ExrFile::Input {
  std::unique_ptr<OIIO::ImageInput> file;
  OIIO::ImageSpec spec;
};

void ExrFile::fail(const std::string& what) const { throw Error(Fault::input, path_.string(), what); }

ExrFile::ExrFile(const std::filesystem::path& path) : path_(path), input_(std::make_unique<Input>()) {
  prepare_oiio();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) fail(std::filesystem::exists(path, error) ? "not a file" : "no such file");
  if (std::filesystem::file_size(path, error) == 0) fail("the file is empty");
  input_->file = OIIO::ImageInput::create("openexr");
  if (!input_->file) fail("OpenImageIO was built without OpenEXR: " + OIIO::geterror());
  OIIO::ImageSpec& spec = input_->spec;
  if (!input_->file->valid_file(path.string())) fail("not an OpenEXR file; only OpenEXR is read");
  if (!input_->file->open(path.string(), spec)) fail("cannot be read: " + one_line(input_->file->geterror()));
  if (spec.deep) fail("a deep image; only flat ones are read");
  const auto sane = [](int width, int height) {
    return width >= 1 && height >= 1 && width <= Image::kMaxSize && height <= Image::kMaxSize;
  };
  if (!sane(spec.width, spec.height) || !sane(spec.full_width, spec.full_height))
    fail("the header claims " + std::to_string(spec.full_width) + " x " + std::to_string(spec.full_height) +
         " pixels (data: " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + "); 1 to " +
         std::to_string(Image::kMaxSize) + " a side are possible");
  size_ = {spec.full_width, spec.full_height};
  const std::int64_t x = std::int64_t{spec.x} - spec.full_x, y = std::int64_t{spec.y} - spec.full_y;
  const auto [x0, x1] = std::pair{std::max<std::int64_t>(x, 0), std::min<std::int64_t>(x + spec.width, size_.width)};
  const auto [y0, y1] = std::pair{std::max<std::int64_t>(y, 0), std::min<std::int64_t>(y + spec.height, size_.height)};
  if (x0 < x1 && y0 < y1) {
    covered_ = {static_cast<int>(x0), static_cast<int>(y0), static_cast<int>(x1 - x0), static_cast<int>(y1 - y0)};
    data_ = {static_cast<int>(x), static_cast<int>(y), spec.width, spec.height};
  }
  cropped_ = covered_.width < spec.width || covered_.height < spec.height;
  channels_ = spec.channelnames;
}

ExrFile::~ExrFile() = default;

bool ExrFile::is_uint(int channel) const { return input_->spec.channelformat(channel) == OIIO::TypeUInt32; }

/// Reads the covered rows in bands, channels [first, first + count) interleaved, and hands each row's covered part to
/// store(y, pointer to the first covered pixel).
template <class Value, class Store>
void ExrFile::read_rows(int first, int count, const Store& store) {
  if (covered_.width == 0) return;
  const OIIO::ImageSpec& spec = input_->spec;
  const OIIO::TypeDesc format = std::is_same_v<Value, float> ? OIIO::TypeFloat : OIIO::TypeUInt32;
  // 64 rows are at least two blocks of every compression but DWAB; tiles are read a row of tiles at a time.
  const int band = spec.tile_height > 0 ? spec.tile_height : 64;
  std::vector<Value> rows(static_cast<std::size_t>(std::min(band, data_.height)) * static_cast<std::size_t>(data_.width) *
                          static_cast<std::size_t>(count));
  const int top = covered_.y - data_.y;  // rows of the data window above the image
  for (int begin = top / band * band; begin < top + covered_.height; begin += band) {
    const int end = std::min(begin + band, data_.height);
    const bool ok = spec.tile_width > 0 ? input_->file->read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + begin,
                                                                   spec.y + end, 0, 1, first, first + count, format, rows.data())
                                        : input_->file->read_scanlines(0, 0, spec.y + begin, spec.y + end, 0, first,
                                                                       first + count, format, rows.data());
    if (!ok) fail("truncated or damaged: " + one_line(input_->file->geterror()));
    for (int row = begin; row < end; ++row) {
      const int y = row + data_.y;
      if (y < covered_.y || y >= covered_.y + covered_.height) continue;
      const std::ptrdiff_t skip = std::ptrdiff_t{row - begin} * data_.width + (covered_.x - data_.x);
      store(y, rows.data() + skip * count);
    }
  }
}

void ExrFile::read(const std::vector<int>& selected, FloatOutput out) {
  for (int c = 0; c < out.channels; ++c)
    for (int y = 0; y < out.height; ++y) std::fill_n(out.row(y, c), out.width, 0.0F);
  std::vector<int> planes;  // of half or float channels: one reading of the channels they span
  int first = static_cast<int>(channels_.size()), last = 0;
  for (int plane = 0; plane < static_cast<int>(selected.size()); ++plane) {
    const int channel = selected[static_cast<std::size_t>(plane)];
    if (!is_uint(channel)) {
      planes.push_back(plane);
      first = std::min(first, channel), last = std::max(last, channel);
      continue;
    }
    read_rows<std::uint32_t>(channel, 1, [&](int y, const std::uint32_t* row) {  // as float it would be scaled to 0..1
      for (int x = 0; x < covered_.width; ++x) out.at(covered_.x + x, y, plane) = static_cast<float>(row[x]);
    });
  }
  if (planes.empty()) return;
  const int count = last - first + 1;
  read_rows<float>(first, count, [&](int y, const float* row) {
    for (const int plane : planes) {
      const float* from = row + (selected[static_cast<std::size_t>(plane)] - first);
      float* to = out.row(y, plane) + covered_.x;
      for (int x = 0; x < covered_.width; ++x) to[x] = from[std::ptrdiff_t{x} * count];
    }
  });
}

void ExrFile::read(int channel, IdOutput out) {
  for (int y = 0; y < out.height; ++y) std::fill_n(out.row(y), out.width, 0U);
  read_rows<std::uint32_t>(channel, 1,
                           [&](int y, const std::uint32_t* row) { std::copy_n(row, covered_.width, out.row(y) + covered_.x); });
}

}  // namespace quell
