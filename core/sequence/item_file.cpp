#include "quell/sequence/item_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "quell/sequence/camera_file.h"
#include "quell/sequence/image_file.h"
#include "quell/sequence/image_writer.h"
#include "quell/sequence/pending_file.h"
#include "quell/text/json.h"

namespace quell {
namespace {

// Decimal digits would do, too, but JSON has neither NaN nor infinity, and its -0 is an integer.
std::string values_json(const Values& values, std::int64_t frame) {
  std::string text = "{\"frame\": " + std::to_string(frame) + ", \"values\": [";
  const char* joint = "";
  for (const double value : values) {
    char digits[40];
    const auto [end, error] = std::to_chars(std::begin(digits), std::end(digits), value, std::chars_format::hex);
    text += joint + ("\"" + std::string(digits, end) + "\"");
    joint = ", ";
  }
  return text + "]}\n";
}

double parse_hexadecimal(const Json& value, Diagnostics& errors) {
  double number = 0;
  const char* end = value.string.data() + value.string.size();
  const auto [next, error] = std::from_chars(value.string.data(), end, number, std::chars_format::hex);
  if (value.kind != Json::Kind::string || error != std::errc() || next != end)
    errors.error(value.where, "expected a hexadecimal number in quotes, such as \"1.8p+1\", found " + excerpt(value));
  return std::isnan(number) ? std::copysign(std::numeric_limits<double>::quiet_NaN(), number) : number;
}

Values read_hexadecimal_values(const std::filesystem::path& file) {
  Diagnostics errors;
  const SourceTextPtr text = read_text(file, Fault::input);
  std::vector<double> numbers;
  if (const auto root = parse_json(text, errors)) {
    const Json* values = root->find("values");
    if (!values || values->kind != Json::Kind::array)
      errors.error(root->where, "expected an object with a list \"values\"");
    else
      for (const Json& element : values->elements) numbers.push_back(parse_hexadecimal(element, errors));
  }
  errors.throw_if_any(Fault::input);
  return Values(numbers);
}

std::vector<int> find_channels(const ImageFile& file, PortType type) {
  std::vector<int> found;
  for (const std::string& wanted : channel_names(type)) {
    const auto place = std::ranges::find(file.channels(), wanted, &FileChannel::name);
    const Numbers numbers = type == QUELL_TYPE_ID ? Numbers::uint32 : Numbers::single;
    if (place == file.channels().end() || place->numbers != numbers)
      throw Error(Fault::input, file.path().string(),
                  "it has no channel '" + wanted + "' of " + (type == QUELL_TYPE_ID ? "uint" : "float") +
                      ", so that it is not what a run has kept of an image of type " + std::string(name(type)));
    found.push_back(static_cast<int>(place - file.channels().begin()));
  }
  return found;
}

Image read_kept_image(const std::filesystem::path& path, PortType type, BufferPool& pool) {
  ImageFile file(path);
  const std::vector<int> channels = find_channels(file, type);
  const Rectangle& window = file.display_window();
  Image image(type, {window.width, window.height}, pool);
  if (type == QUELL_TYPE_ID)
    file.read(channels.front(), window, image.writable_ids());
  else
    file.read(channels, window, image.writable_floats());
  return image;
}

}  // namespace

const char* item_extension(PortType type) { return is_image(type) ? ".exr" : ".json"; }

void write_item(const Item& item, std::int64_t frame, const std::filesystem::path& file) {
  PendingFile pending(file);
  if (const Image* image = item.image())
    write_exr({.layers = {{*image, "", false}}, .frame = frame}, {.compression = "zip"}, pending.path());
  else
    write_text(item.values() ? values_json(*item.values(), frame) : to_json(item, frame), pending.path());
  pending.commit();
}

Item read_item(const std::filesystem::path& file, PortType type, BufferPool& pool) {
  if (is_image(type)) return read_kept_image(file, type, pool);
  if (type == QUELL_TYPE_CAMERA) return read_json_camera(file);
  return read_hexadecimal_values(file);
}

}  // namespace quell
