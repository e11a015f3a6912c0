#include "tests/core/sequence/test_files.h"

#include <OpenImageIO/imageio.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace quell::test {

namespace fs = std::filesystem;

TempFolder::TempFolder() {
  std::string pattern = (fs::temp_directory_path() / "quell-test-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<std::string> TempFolder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

namespace {

OIIO::ImageSpec spec_of(const ExrContent& content) {
  OIIO::ImageSpec spec(content.width, content.height, static_cast<int>(content.channels.size()), OIIO::TypeDesc(content.format));
  spec.channelnames = content.channels;
  spec.x = content.x, spec.y = content.y;
  spec.full_x = spec.full_y = 0;
  spec.full_width = content.full_width ? content.full_width : content.width;
  spec.full_height = content.full_height ? content.full_height : content.height;
  spec.tile_width = spec.tile_height = content.tile;
  spec.attribute("compression", "zip");
  for (const auto& [name, numbers] : content.matrices) {
    const std::vector<float> floats(numbers.begin(), numbers.end());
    spec.attribute(name, OIIO::TypeMatrix44, floats.data());
  }
  if (!content.part.empty()) spec.attribute("oiio:subimagename", content.part);
  if (content.pixel_aspect != 1) spec.attribute("PixelAspectRatio", content.pixel_aspect);
  return spec;
}

bool write_pixels(OIIO::ImageOutput& output, const ExrContent& content) {
  std::vector<double> pixels = content.pixels;
  pixels.resize(static_cast<std::size_t>(content.width) * static_cast<std::size_t>(content.height) * content.channels.size());
  if (content.format != "uint") return output.write_image(OIIO::TypeDesc::DOUBLE, pixels.data());
  const std::vector<std::uint32_t> integers(pixels.begin(), pixels.end());
  return output.write_image(OIIO::TypeUInt32, integers.data());
}

}  // namespace

void make_parts(const fs::path& file, const std::vector<ExrContent>& parts) {
  std::vector<OIIO::ImageSpec> specs;
  for (const ExrContent& part : parts) specs.push_back(spec_of(part));
  const auto output = OIIO::ImageOutput::create("openexr");
  bool ok = output->open(file.string(), static_cast<int>(specs.size()), specs.data());
  for (std::size_t i = 0; ok && i < parts.size(); ++i) {
    if (i > 0) ok = output->open(file.string(), specs[i], OIIO::ImageOutput::AppendSubimage);
    ok = ok && write_pixels(*output, parts[i]);
  }
  if (!ok || !output->close()) throw std::runtime_error("the test cannot write " + file.string() + ": " + output->geterror());
}

void make_exr(const fs::path& file, const ExrContent& content) {
  const auto output = OIIO::ImageOutput::create("openexr");
  const bool ok = output->open(file.string(), spec_of(content)) && write_pixels(*output, content);
  if (!ok || !output->close()) throw std::runtime_error("the test cannot write " + file.string() + ": " + output->geterror());
}

void make_text(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

std::string read_bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

ExrRead load_exr(const fs::path& file) {
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) throw std::runtime_error("the test cannot read " + file.string() + ": " + OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  ExrRead read{spec.width, spec.height, {}, {}, spec.get_string_attribute("compression").c_str()};
  for (int c = 0; c < spec.nchannels; ++c)
    read.channels.push_back(spec.channelnames[static_cast<std::size_t>(c)] + ":" + spec.channelformat(c).c_str());
  read.pixels.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                     static_cast<std::size_t>(spec.nchannels));
  if (spec.channelformat(0) == OIIO::TypeUInt32) {  // as floats they would be scaled to 0..1
    std::vector<std::uint32_t> integers(read.pixels.size());
    input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeUInt32, integers.data());
    std::copy(integers.begin(), integers.end(), read.pixels.begin());
  } else {
    input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, read.pixels.data());
  }
  return read;
}

std::vector<float> values(const Image& image) {
  const FloatImage view = image.floats();
  std::vector<float> all;
  for (int c = 0; c < view.channels; ++c)
    for (int y = 0; y < view.height; ++y) all.insert(all.end(), view.row(y, c), view.row(y, c) + view.width);
  return all;
}

std::vector<std::uint32_t> id_values(const Image& image) {
  const IdImage view = image.ids();
  std::vector<std::uint32_t> all;
  for (int y = 0; y < view.height; ++y) all.insert(all.end(), view.row(y), view.row(y) + view.width);
  return all;
}

std::string sidecar_text(int width, int height, const std::string& objects) {
  return "{\"width\": " + std::to_string(width) + ", \"height\": " + std::to_string(height) +
         ", \"world_to_camera\": " + kIdentityText + ", \"world_to_pixel\": " + kIdentityText + ", \"objects\": {" + objects +
         "}}";
}

}  // namespace quell::test
