#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "quell/plugin/check_parts.h"

namespace quell {
namespace {

constexpr std::uint32_t kMostElements = 1u << 20;  // of an array's default

std::string count_text(const quell_param_desc& desc) {
  return std::to_string(desc.min_count) + " to " + std::to_string(desc.max_count) + " values";
}

std::string fault_in_enum(const quell_param_desc& desc) {
  if (desc.enum_count == 0 || desc.enum_count > kMostEntries || !desc.enum_values) return "an enum needs 1 to 1000 values";
  if (!desc.enum_docs) return "the enum's documentation is null";
  std::set<std::string_view> names;
  for (std::uint32_t i = 0; i < desc.enum_count; ++i) {
    if (!desc.enum_values[i] || !*desc.enum_values[i]) return "value " + std::to_string(i) + " of the enum has no name";
    if (!desc.enum_docs[i]) return "value " + std::to_string(i) + " of the enum has no documentation";
    if (!names.insert(desc.enum_values[i]).second)
      return std::string("the enum's value '") + desc.enum_values[i] + "' is there twice";
  }
  return {};
}

std::string fault_in_range(const quell_param_desc& desc) {
  if (desc.is_array && desc.min_count > desc.max_count) return "its least count is above its largest";
  const bool is_number = desc.type == QUELL_PARAM_INT || desc.type == QUELL_PARAM_DOUBLE;
  if (is_number && !(desc.min_value <= desc.max_value)) return "its least value is above its largest, or not a number";
  return {};
}

bool is_within(const quell_param_desc& desc, const quell_param_value& value, std::uint32_t i) {
  switch (desc.type) {
    case QUELL_PARAM_BOOL:
      return value.data.bools[i] <= 1;
    case QUELL_PARAM_ENUM:
      return value.data.ints[i] >= 0 && value.data.ints[i] < desc.enum_count;
    case QUELL_PARAM_INT: {
      const auto number = static_cast<double>(value.data.ints[i]);
      return number >= desc.min_value && number <= desc.max_value;
    }
    case QUELL_PARAM_DOUBLE:
      return value.data.doubles[i] >= desc.min_value && value.data.doubles[i] <= desc.max_value;
    default:
      return true;
  }
}

std::string fault_in_default(const quell_param_desc& desc) {
  if (!desc.default_value) return "it has no default";
  const quell_param_value& value = *desc.default_value;
  if (const std::string fault = fault_in_value(value); !fault.empty()) return "its default: " + fault;
  if (value.type != desc.type) return "its default has another type than itself";
  if (!desc.is_array && value.count != 1) return "its default must be one value";
  if (desc.is_array && (value.count < desc.min_count || value.count > desc.max_count))
    return "its default has " + std::to_string(value.count) + " values, not " + count_text(desc);
  for (std::uint32_t i = 0; i < value.count; ++i)
    if (!is_within(desc, value, i)) return "its default is outside its range";
  return {};
}

}  // namespace

std::string fault_in_value(const quell_param_value& value) {
  constexpr std::size_t kSize = QUELL_SIZE_TO(quell_param_value, data);
  if (value.struct_size < kSize || value.struct_size > sizeof(value))
    return "a value has the struct_size " + std::to_string(value.struct_size) + " instead of " + std::to_string(sizeof(value));
  if (value.type > QUELL_PARAM_PATH) return "a value has the unknown type " + std::to_string(value.type);
  if (value.count > kMostElements) return "a value claims " + std::to_string(value.count) + " elements";
  if (value.count > 0 && !value.data.bools) return "a value's data is null";  // all members of the union are pointers
  const bool is_text = value.type == QUELL_PARAM_STRING || value.type == QUELL_PARAM_PATH;
  for (std::uint32_t i = 0; is_text && i < value.count; ++i)
    if (!value.data.strings[i]) return "a value's text is null";
  return {};
}

std::string fault_in_param(const quell_param_desc& desc) {
  if (!is_snake_case(desc.name)) return "its name is not in snake_case";
  if (!desc.unit || !desc.doc) return "its unit or doc is null";
  if (desc.type > QUELL_PARAM_PATH) return "it has the unknown type " + std::to_string(desc.type);
  if (desc.type == QUELL_PARAM_ENUM)
    if (std::string fault = fault_in_enum(desc); !fault.empty()) return fault;
  if (std::string fault = fault_in_range(desc); !fault.empty()) return fault;
  return fault_in_default(desc);
}

}  // namespace quell
