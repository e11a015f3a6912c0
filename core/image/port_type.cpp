#include "quell/image/port_type.h"

#include <array>
#include <bit>

namespace quell {
namespace {

constexpr std::array<PortTypeInfo, QUELL_TYPE_COUNT> kTypes{{
    {"color", 3, QUELL_FORMAT_F32, "scene-linear radiance"},
    {"albedo", 3, QUELL_FORMAT_F32, "reflectance, at least 0"},
    {"normal", 3, QUELL_FORMAT_F32, "world space, unit length, 0 where there is no surface"},
    {"position", 3, QUELL_FORMAT_F32, "world space"},
    {"depth", 1, QUELL_FORMAT_F32, "distance along the view axis, 1e10 where there is no surface"},
    {"id", 1, QUELL_FORMAT_U32, "object index, 0xffffffff where there is no surface"},
    {"motion", 2, QUELL_FORMAT_F32, "pixels, y down: previous position minus current position"},
    {"moments", 2, QUELL_FORMAT_F32, "first and second moment of luminance"},
    {"variance", 1, QUELL_FORMAT_F32, "variance of luminance"},
    {"scalar", 1, QUELL_FORMAT_F32, "one value a pixel"},
    {"mask", 1, QUELL_FORMAT_F32, "0 or 1"},
    {"alpha", 1, QUELL_FORMAT_F32, "coverage"},
    {"camera", 0, QUELL_FORMAT_F32, "matrices of camera and objects"},
    {"value", 0, QUELL_FORMAT_F32, "an array of numbers a frame"},
}};

}  // namespace

const PortTypeInfo& info(PortType type) { return kTypes.at(static_cast<std::size_t>(type)); }

std::optional<PortType> port_type(std::string_view name) {
  for (std::size_t i = 0; i < kTypes.size(); ++i)
    if (kTypes[i].name == name) return static_cast<PortType>(i);
  return std::nullopt;
}

std::string describe(Types types) {
  if (types == kAnyImage) return "any image";
  if (types == kAnyFloatImage) return "any image but id";
  std::string text;
  int left = std::popcount(types);
  for (std::uint32_t i = 0; i < QUELL_TYPE_COUNT; ++i) {
    if (!(types & QUELL_TYPE_BIT(i))) continue;
    text += kTypes[i].name;
    --left;
    if (left > 0) text += left > 1 ? ", " : " or ";
  }
  return text;
}

}  // namespace quell
