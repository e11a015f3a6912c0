#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "quell/sequence/image_writer.h"
#include "quell/text/error.h"

namespace quell {
namespace {

/// With all digits that a double has; JSON has no NaN and no infinity, so those are null.
std::string number(double value) {
  if (!std::isfinite(value)) return "null";
  if (value == 0 && std::signbit(value)) return "-0.0";  // "-0" is an integer, which has no such zero
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  text << value;
  return text.str();
}

std::string matrix(const Matrix& m) {
  std::string text = "[";
  for (std::size_t row = 0; row < 4; ++row) {
    text += row == 0 ? "[" : ", [";
    for (std::size_t column = 0; column < 4; ++column) text += (column == 0 ? "" : ", ") + number(m[4 * row + column]);
    text += "]";
  }
  return text + "]";
}

std::string camera_json(const Camera& camera, std::int64_t frame) {
  std::string text = "{\n \"frame\": " + std::to_string(frame) + ",\n \"width\": " + std::to_string(camera.size.width) +
                     ",\n \"height\": " + std::to_string(camera.size.height) +
                     ",\n \"world_to_camera\": " + matrix(camera.world_to_camera) +
                     ",\n \"world_to_pixel\": " + matrix(camera.world_to_screen);
  if (camera.jitter != std::array<double, 2>{})
    text += ",\n \"jitter\": [" + number(camera.jitter[0]) + ", " + number(camera.jitter[1]) + "]";
  text += ",\n \"objects\": {";
  const char* joint = "\n  \"";
  for (const auto& [id, object_to_world] : camera.object_to_world) {
    text += joint + std::to_string(id) + "\": {\"object_to_world\": " + matrix(object_to_world) + "}";
    joint = ",\n  \"";
  }
  return text + "\n }\n}\n";
}

}  // namespace

std::string to_json(const Item& item, std::int64_t frame) {
  if (const CameraRecord* record = item.camera()) return camera_json(record->camera(), frame);
  std::string text = "{\"frame\": " + std::to_string(frame) + ", \"values\": [";
  const char* joint = "";
  for (const double value : *item.values()) {
    text += joint + number(value);
    joint = ", ";
  }
  return text + "]}\n";
}

void write_text(const std::string& text, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw Error(Fault::frame, file.string(), std::string("cannot be written: ") + std::strerror(errno));
}

}  // namespace quell
