#include "quell/sequence/image_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "quell/sequence/image_file_state.h"
#include "quell/sequence/oiio.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr int kMaxChannels = 4096;  // of a part; renderers write hundreds
constexpr int kMaxParts = 4096;     // likewise
constexpr int kFarthest = 1 << 29;  // of a window from the origin, so that sums of coordinates fit an int
constexpr int kMaxTile = 8192;      // a side; larger ones would take gigabytes to read a single pixel
constexpr std::size_t kSignatureSize = 10;

struct Format {
  std::string_view signature;  ///< the first bytes
  std::string_view name;
  const char* reader;  ///< OpenImageIO's name of it
};
using namespace std::string_view_literals;
constexpr Format kFormats[] = {
    {"\x76\x2f\x31\x01"sv, "openexr", "openexr"},
    {"\x89PNG"sv, "png", "png"},
    {"II*\0"sv, "tiff", "tiff"},
    {"MM\0*"sv, "tiff", "tiff"},
    {"II+\0"sv, "tiff", "tiff"},
    {"MM\0+"sv, "tiff", "tiff"},
    {"#?RADIANCE"sv, "hdr", "hdr"},
    {"#?RGBE"sv, "hdr", "hdr"},
    {"PF"sv, "pfm", "pnm"},
    {"Pf"sv, "pfm", "pnm"},
};

const Format* recognize(const std::filesystem::path& path) {
  std::string bytes(kSignatureSize, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  const auto is_it = [&](const Format& format) { return bytes.starts_with(format.signature); };
  const auto* found = std::find_if(std::begin(kFormats), std::end(kFormats), is_it);
  return found == std::end(kFormats) ? nullptr : found;
}

std::optional<Numbers> numbers_of(OIIO::TypeDesc type) {
  switch (type.basetype) {
    case OIIO::TypeDesc::HALF:
      return Numbers::half;
    case OIIO::TypeDesc::FLOAT:
    case OIIO::TypeDesc::DOUBLE:
      return Numbers::single;
    case OIIO::TypeDesc::UINT32:
      return Numbers::uint32;
    case OIIO::TypeDesc::UINT16:
      return Numbers::uint16;
    case OIIO::TypeDesc::UINT8:
      return Numbers::uint8;
    default:
      return std::nullopt;
  }
}

std::string size_text(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

/// How the pixels are stored, and what OpenImageIO made up: nothing that a copy of the picture would have to say again.
bool is_about_storage(std::string_view name) {
  static const std::set<std::string_view> kNames = {"compression", "planarconfig", "name", "PixelAspectRatio", "Orientation"};
  static const std::vector<std::string_view> kPrefixes = {"oiio:", "openexr:", "png:", "tiff:", "pnm:"};
  return kNames.contains(name) ||
         std::any_of(kPrefixes.begin(), kPrefixes.end(), [&](std::string_view prefix) { return name.starts_with(prefix); });
}

void require_upright(const ImageFile::State& state, const OIIO::ImageSpec& spec) {
  if (state.format == "openexr" || spec.get_int_attribute("Orientation", 1) == 1) return;
  state.fail("the picture is stored turned or mirrored (orientation " + std::to_string(spec.get_int_attribute("Orientation")) +
             "); only those that begin with the top left pixel, row by row, are read");
}

void require_sane(const ImageFile::State& state, const OIIO::ImageSpec& spec) {
  const auto in_range = [](int side) { return side >= 1 && side <= Image::kMaxSize; };
  if (!in_range(spec.width) || !in_range(spec.height) || !in_range(spec.full_width) || !in_range(spec.full_height))
    state.fail("the header claims " + size_text(spec.full_width, spec.full_height) + " pixels (data: " +
               size_text(spec.width, spec.height) + "); 1 to " + std::to_string(Image::kMaxSize) + " a side are possible");
  for (const int place : {spec.x, spec.y, spec.full_x, spec.full_y})
    if (place < -kFarthest || place > kFarthest)
      state.fail("the header claims that pixels begin at " + std::to_string(place) + ", which is too far from 0");
  if (spec.nchannels < 1 || spec.nchannels > kMaxChannels)
    state.fail("the header claims " + std::to_string(spec.nchannels) + " channels; 1 to " + std::to_string(kMaxChannels) +
               " are possible");
  if (spec.tile_width > kMaxTile || spec.tile_height > kMaxTile)
    state.fail("the header claims tiles of " + size_text(spec.tile_width, spec.tile_height) + " pixels; " +
               std::to_string(kMaxTile) + " a side are possible");
  if (spec.depth > 1) state.fail("a volume of " + std::to_string(spec.depth) + " slices; only flat images are read");
}

}  // namespace

Rectangle intersection(const Rectangle& a, const Rectangle& b) {
  const int x0 = std::max(a.x, b.x), x1 = std::min(a.x + a.width, b.x + b.width);
  const int y0 = std::max(a.y, b.y), y1 = std::min(a.y + a.height, b.y + b.height);
  return x0 < x1 && y0 < y1 ? Rectangle{x0, y0, x1 - x0, y1 - y0} : Rectangle{};
}

void ImageFile::State::fail(const std::string& what) const { throw Error(Fault::input, path.string(), what); }

const ImageFile::State::Part& ImageFile::State::part_of(int channel) const {
  return parts[static_cast<std::size_t>(channels[static_cast<std::size_t>(channel)].part)];
}

void ImageFile::State::open() {
  prepare_oiio();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) fail(std::filesystem::exists(path, error) ? "not a file" : "no such file");
  if (std::filesystem::file_size(path, error) == 0) fail("the file is empty");
  const Format* known = recognize(path);
  if (!known) fail("not an image of a known format; OpenEXR, PNG, TIFF, Radiance HDR and PFM are read");
  format = known->name;
  file = OIIO::ImageInput::create(known->reader);
  if (!file) fail("OpenImageIO was built without " + std::string(known->name) + ": " + OIIO::geterror());
  OIIO::ImageSpec spec, settings;
  settings.attribute("oiio:UnassociatedAlpha", 1);  // else alpha would be multiplied into the colors of PNG and TIFF
  if (!file->open(path.string(), spec, settings)) fail("cannot be read: " + one_line(file->geterror()));
  for (int number = 0; number < kMaxParts && file->seek_subimage(number, 0); ++number) add_part(number);
  static_cast<void>(file->geterror());  // that there is no further part: what is not asked for is printed
  if (parts.empty()) fail("cannot be read: there is no image in it");
  name_channels();
}

void ImageFile::State::add_part(int number) {
  const OIIO::ImageSpec spec = file->spec();
  if (spec.deep) fail("a deep image; only flat ones are read");
  require_sane(*this, spec);
  require_upright(*this, spec);
  const Rectangle data{spec.x, spec.y, spec.width, spec.height};
  const Rectangle full{spec.full_x, spec.full_y, spec.full_width, spec.full_height};
  if (number == 0) {
    display = format == "openexr" ? full : data;  // positions in a TIFF are about paper
    const float aspect = spec.get_float_attribute("PixelAspectRatio", 1.0F);
    pixel_aspect = std::isfinite(aspect) && aspect > 0 ? aspect : 1.0F;
  } else if (format == "openexr" && full != display) {
    fail("its parts have different display windows (" + size_text(display.width, display.height) + " and " +
         size_text(full.width, full.height) + ")");
  }
  for (int c = 0; c < spec.nchannels; ++c) {
    const std::optional<Numbers> numbers = numbers_of(spec.channelformat(c));
    if (!numbers)
      fail("the channel '" + spec.channelnames[static_cast<std::size_t>(c)] + "' holds numbers of type " +
           spec.channelformat(c).c_str() + "; half, float and unsigned integers of 8, 16 and 32 bits are read");
    channels.push_back({spec.channelnames[static_cast<std::size_t>(c)], number, *numbers});
    index.push_back(c);
  }
  parts.push_back({spec, data});
}

void ImageFile::State::name_channels() {
  std::set<std::string> taken;
  for (FileChannel& channel : channels) {
    const auto& spec = parts[static_cast<std::size_t>(channel.part)].spec;
    std::string part = spec.get_string_attribute("oiio:subimagename");
    if (part.empty() && channel.part > 0) part = "part" + std::to_string(channel.part + 1);
    const bool told = channel.name.starts_with(part + ".");
    if (parts.size() > 1 && !part.empty() && !told) channel.name = part + "." + channel.name;
    if (!taken.insert(channel.name).second)
      fail("two channels have the same name, '" + channel.name + "', so that neither can be chosen");
  }
}

ImageFile::ImageFile(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  state_->path = path;
  state_->open();
}

ImageFile::~ImageFile() = default;

const std::filesystem::path& ImageFile::path() const { return state_->path; }
std::string_view ImageFile::format() const { return state_->format; }
const std::vector<FileChannel>& ImageFile::channels() const { return state_->channels; }
const Rectangle& ImageFile::display_window() const { return state_->display; }
const Rectangle& ImageFile::data_window(int channel) const { return state_->part_of(channel).data; }
float ImageFile::pixel_aspect() const { return state_->pixel_aspect; }

std::optional<Matrix> ImageFile::matrix(std::string_view attribute) const {
  const OIIO::string_view name(attribute.data(), attribute.size());
  for (const State::Part& part : state_->parts) {
    const OIIO::ParamValue* found = part.spec.find_attribute(name);
    if (!found || found->type().aggregate != OIIO::TypeDesc::MATRIX44 || found->type().is_array()) continue;
    Matrix matrix;
    if (found->type().basetype == OIIO::TypeDesc::FLOAT)
      std::copy_n(static_cast<const float*>(found->data()), 16, matrix.begin());
    else if (found->type().basetype == OIIO::TypeDesc::DOUBLE)
      std::copy_n(static_cast<const double*>(found->data()), 16, matrix.begin());
    else
      continue;
    return matrix;
  }
  return std::nullopt;
}

std::vector<ImageFile::Attribute> ImageFile::attributes() const {
  std::vector<Attribute> result;
  std::set<std::string> taken;
  for (const State::Part& part : state_->parts)
    for (const OIIO::ParamValue& value : part.spec.extra_attribs)
      if (!is_about_storage(value.name().string()) && taken.insert(value.name().string()).second)
        result.push_back({value.name().string(), value.get_string()});
  return result;
}

}  // namespace quell
