// The port types by name, and what each is made of. Their meaning stands at quell_type in the SDK.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "quell/sdk/types.h"

namespace quell {

using PortType = quell_type;

struct PortTypeInfo {
  std::string_view name;
  int channels;  ///< 0: not an image
  quell_format format;
  std::string_view doc;
};

const PortTypeInfo& info(PortType type);
inline std::string_view name(PortType type) { return info(type).name; }
inline bool is_image(PortType type) { return info(type).channels > 0; }
std::optional<PortType> port_type(std::string_view name);
/// "color", "color or albedo", "color, albedo or normal"; "any image" for all of them.
std::string describe(Types types);
inline bool accepts(Types types, PortType type) { return (types & QUELL_TYPE_BIT(type)) != 0; }

}  // namespace quell
