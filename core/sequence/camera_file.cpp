#include "quell/sequence/camera_file.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

#include "quell/sequence/matrix.h"
#include "quell/text/json.h"

namespace quell {
namespace {

static_assert(std::endian::native == std::endian::little, "read_mat_camera copies little-endian numbers");

constexpr std::size_t kMatrixBytes = 16 * sizeof(float);
constexpr std::uintmax_t kMaxMatBytes = std::uintmax_t{64} << 20;  // a million objects; more comes from a wrong file

std::string read_bytes(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw Error(Fault::input, file.string(), "cannot be read: " + error.message());
  if (size > kMaxMatBytes) throw Error(Fault::input, file.string(), "larger than any matrix file");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) throw Error(Fault::input, file.string(), "cannot be read");
  return bytes;
}

Matrix matrix_at(const std::string& bytes, std::size_t index, const std::filesystem::path& file) {
  float values[16];
  std::memcpy(values, bytes.data() + sizeof(std::int32_t) + index * kMatrixBytes, kMatrixBytes);
  Matrix matrix;
  for (std::size_t i = 0; i < 16; ++i) {
    if (!std::isfinite(values[i]))
      throw Error(Fault::input, file.string(), "matrix " + std::to_string(index) + " holds a number that is not finite");
    matrix[i] = values[i];
  }
  return matrix;
}

/// Reads the parts of a sidecar, collecting what is wrong.
class SidecarReader {
 public:
  explicit SidecarReader(const std::filesystem::path& file) : text_(read_text(file, Fault::input)) {}

  Camera read() {
    Camera camera;
    const auto root = parse_json(text_, errors_);
    if (root && root->kind != Json::Kind::object) {
      errors_.error(root->where, "expected an object with world_to_camera, world_to_pixel, width, height and objects");
    } else if (root) {
      camera.size = {read_length(*root, "width"), read_length(*root, "height")};
      camera.world_to_camera = read_matrix(*root, "world_to_camera");
      camera.world_to_screen = read_matrix(*root, "world_to_pixel");
      if (const Json* jitter = root->find("jitter")) read_jitter(*jitter, camera);
      read_objects(*root, camera);
      const Json* view = root->find("world_to_camera");
      if (errors_.empty() && !is_invertible(camera.world_to_camera)) errors_.error(view->where, "this matrix cannot be inverted");
    }
    errors_.throw_if_any(Fault::input);
    return camera;
  }

 private:
  const Json* require(const Json& object, std::string_view key) {
    const Json* value = object.find(key);
    if (!value) errors_.error(object.where, "the key \"" + std::string(key) + "\" is missing in this object");
    return value;
  }

  int read_length(const Json& root, std::string_view key) {
    const Json* value = require(root, key);
    if (!value) return 0;
    if (value->kind == Json::Kind::integer && value->integer >= 1 && value->integer <= Image::kMaxSize)
      return static_cast<int>(value->integer);
    errors_.error(value->where,
                  "expected a number of pixels, 1 to " + std::to_string(Image::kMaxSize) + ", found " + excerpt(*value));
    return 0;
  }

  Matrix read_matrix(const Json& object, std::string_view key) {
    Matrix matrix = kIdentity;
    const Json* value = require(object, key);
    if (!value) return matrix;
    bool ok = value->kind == Json::Kind::array && value->elements.size() == 4;
    for (std::size_t row = 0; ok && row < 4; ++row) {
      const Json& numbers = value->elements[row];
      ok = numbers.kind == Json::Kind::array && numbers.elements.size() == 4;
      for (std::size_t column = 0; ok && column < 4; ++column) {
        const Json& number = numbers.elements[column];
        ok = number.is_number() && std::isfinite(number.number);
        if (ok) matrix[4 * row + column] = number.number;
      }
    }
    if (!ok) errors_.error(value->where, "expected a matrix: 4 rows of 4 finite numbers");
    return matrix;
  }

  void read_jitter(const Json& value, Camera& camera) {
    const auto& numbers = value.elements;
    const auto finite = [](const Json& number) { return number.is_number() && std::isfinite(number.number); };
    if (value.kind != Json::Kind::array || numbers.size() != 2 || !finite(numbers[0]) || !finite(numbers[1]))
      return errors_.error(value.where, "expected the jitter in pixels, [x, y], found " + excerpt(value));
    camera.jitter = {numbers[0].number, numbers[1].number};
  }

  void read_objects(const Json& root, Camera& camera) {
    const Json* objects = require(root, "objects");
    if (!objects) return;
    if (objects->kind != Json::Kind::object) return errors_.error(objects->where, "expected an object: {\"<id>\": {...}}");
    for (const JsonMember& member : objects->members) {
      std::uint32_t id = 0;
      const char* const end = member.key.data() + member.key.size();
      const auto parsed = std::from_chars(member.key.data(), end, id);
      if (parsed.ec != std::errc() || parsed.ptr != end || id == QUELL_NO_ID)
        errors_.error(member.where, "expected an object's index (an integer from 0), found \"" + member.key + "\"");
      else if (member.value.kind != Json::Kind::object)
        errors_.error(member.value.where, "expected an object with object_to_world");
      else
        camera.object_to_world[id] = read_matrix(member.value, "object_to_world");
    }
  }

  SourceTextPtr text_;
  Diagnostics errors_;
};

}  // namespace

Camera read_mat_camera(const std::filesystem::path& file, Size resolution) {
  const std::string bytes = read_bytes(file);
  std::int32_t count = 0;
  if (bytes.size() >= sizeof count) std::memcpy(&count, bytes.data(), sizeof count);
  const std::int64_t expected = 4 + (std::int64_t{count} + 2) * std::int64_t{kMatrixBytes};
  if (bytes.size() < sizeof count || count < 0 || expected != static_cast<std::int64_t>(bytes.size()))
    throw Error(Fault::input, file.string(),
                "the file has " + std::to_string(bytes.size()) + " bytes, but claims " + std::to_string(count) +
                    " objects; that number and n + 2 matrices would be 4 + 64 (n + 2) bytes");
  Camera camera;
  camera.size = resolution;
  const auto objects = static_cast<std::uint32_t>(count);
  for (std::uint32_t i = 0; i < objects; ++i) camera.object_to_world[i] = matrix_at(bytes, i, file);
  camera.world_to_camera = matrix_at(bytes, objects, file);
  camera.world_to_screen = matrix_at(bytes, objects + 1, file);
  if (!is_invertible(camera.world_to_camera))
    throw Error(Fault::input, file.string(), "the world-to-camera matrix cannot be inverted");
  return camera;
}

Camera read_json_camera(const std::filesystem::path& file) { return SidecarReader(file).read(); }

}  // namespace quell
