#include "quell/graph/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quell::detail {
namespace {

std::string number(double value) {
  Json json;
  json.kind = Json::Kind::number, json.number = value;
  return excerpt(json);
}

// " from 0 to 64", " of at least 0", or nothing for the bounds of the C++ type itself, which nobody wants to read.
std::string range_of(const quell_param_desc& desc) {
  const double widest =
      desc.type == QUELL_PARAM_INT ? double{std::numeric_limits<std::int32_t>::max()} : double{std::numeric_limits<float>::max()};
  const bool has_min = desc.min_value > -widest, has_max = desc.max_value < widest;
  std::string range;
  if (has_min && has_max)
    range = " from " + number(desc.min_value) + " to " + number(desc.max_value);
  else if (has_min)
    range = " of at least " + number(desc.min_value);
  else if (has_max)
    range = " of at most " + number(desc.max_value);
  return *desc.unit ? range + " (" + desc.unit + ")" : range;
}

std::vector<std::string> choices(const quell_param_desc& desc) { return {desc.enum_values, desc.enum_values + desc.enum_count}; }

std::string one_value(const quell_param_desc& desc) {
  switch (desc.type) {
    case QUELL_PARAM_BOOL:
      return "true or false";
    case QUELL_PARAM_INT:
      return "an integer" + range_of(desc);
    case QUELL_PARAM_DOUBLE:
      return "a number" + range_of(desc);
    case QUELL_PARAM_ENUM:
      return list_names(choices(desc));
    case QUELL_PARAM_PATH:
      return "a path, as a string";
    default:
      return "a string";
  }
}

std::string length_of(const quell_param_desc& desc) {
  const std::string min = std::to_string(desc.min_count), max = std::to_string(desc.max_count);
  if (desc.min_count == desc.max_count) return "exactly " + min;
  if (desc.max_count == std::numeric_limits<std::uint32_t>::max()) return desc.min_count ? "at least " + min : "any number";
  return desc.min_count ? min + " to " + max : "at most " + max;
}

class Converter {
 public:
  Converter(const quell_param_desc& desc, const ValueContext& context, Diagnostics& errors)
      : desc_(desc), context_(context), errors_(errors) {}

  std::optional<ParamValue> run(const Json& value) {
    if (desc_.is_array && value.kind != Json::Kind::array) return refuse(value, "a list, each value " + one_value(desc_));
    const std::size_t count = value.elements.size();
    if (desc_.is_array && (count < desc_.min_count || count > desc_.max_count)) {
      errors_.error(value.where, label() + "takes a list of " + length_of(desc_) + " values, got " + std::to_string(count),
                    context_.notes);
      return std::nullopt;
    }
    switch (desc_.type) {
      case QUELL_PARAM_BOOL:
        return convert<std::uint8_t>(value, &Converter::boolean);
      case QUELL_PARAM_INT:
        return convert<std::int64_t>(value, &Converter::integer);
      case QUELL_PARAM_DOUBLE:
        return convert<double>(value, &Converter::real);
      case QUELL_PARAM_ENUM:
        return convert<std::int64_t>(value, &Converter::choice);
      default:
        return convert<std::string>(value, &Converter::text);
    }
  }

 private:
  std::string label() const { return "'" + context_.label + "' "; }
  std::nullopt_t refuse(const Json& value, const std::string& expected) {
    errors_.error(value.where, label() + "takes " + expected + ", got " + excerpt(value), context_.notes);
    return std::nullopt;
  }

  template <class T>
  std::optional<ParamValue> convert(const Json& value, std::optional<T> (Converter::*element)(const Json&)) {
    std::vector<T> result;
    bool fits = true;
    const auto add = [&](const Json& json) {
      std::optional<T> converted = (this->*element)(json);
      if (converted)
        result.push_back(std::move(*converted));
      else
        fits = false;
    };
    if (desc_.is_array)
      for (const Json& json : value.elements) add(json);
    else
      add(value);
    return fits ? std::optional(ParamValue{std::move(result)}) : std::nullopt;
  }

  bool is_in_range(double value) const { return value >= desc_.min_value && value <= desc_.max_value; }

  std::optional<std::uint8_t> boolean(const Json& value) {
    if (value.kind != Json::Kind::boolean) return refuse(value, one_value(desc_));
    return value.boolean ? 1 : 0;
  }
  std::optional<std::int64_t> integer(const Json& value) {
    // 3.0 is an integer; 2^63 is the first double that does not fit.
    const bool is_whole =
        value.kind == Json::Kind::integer ||
        (value.kind == Json::Kind::number && std::abs(value.number) < 0x1p63 && std::trunc(value.number) == value.number);
    if (!is_whole || !is_in_range(value.number)) return refuse(value, one_value(desc_));
    return value.kind == Json::Kind::integer ? value.integer : static_cast<std::int64_t>(value.number);
  }
  std::optional<double> real(const Json& value) {
    if (!value.is_number() || !is_in_range(value.number)) return refuse(value, one_value(desc_));
    return value.number;
  }
  std::optional<std::int64_t> choice(const Json& value) {
    const std::vector<std::string> names = choices(desc_);
    const auto found = std::find(names.begin(), names.end(), value.string);
    if (value.kind == Json::Kind::string && found != names.end()) return found - names.begin();
    errors_.error(value.where,
                  label() + "takes " + one_value(desc_) + ", got " + excerpt(value) + did_you_mean(value.string, names),
                  context_.notes);
    return std::nullopt;
  }
  std::optional<std::string> text(const Json& value) {
    if (value.kind != Json::Kind::string) return refuse(value, one_value(desc_));
    if (value.string.find('\0') != std::string::npos) return refuse(value, one_value(desc_) + " without the character 0");
    if (desc_.type != QUELL_PARAM_PATH || value.string.empty()) return value.string;
    return (context_.folder / value.string).lexically_normal().string();
  }

  const quell_param_desc& desc_;
  const ValueContext& context_;
  Diagnostics& errors_;
};

}  // namespace

std::optional<ParamValue> to_param(const quell_param_desc& desc, const Json& value, const ValueContext& context,
                                   Diagnostics& errors) {
  return Converter(desc, context, errors).run(value);
}

std::string expected_value(const quell_param_desc& desc) {
  return desc.is_array ? "a list of " + length_of(desc) + " values, each " + one_value(desc) : one_value(desc);
}

Json to_json_value(const quell_param_value& value, const Position& where) {
  Json list;
  list.kind = Json::Kind::array, list.where = where;
  for (std::uint32_t i = 0; i < value.count; ++i) {
    Json& element = list.elements.emplace_back();
    element.where = where;
    if (value.type == QUELL_PARAM_BOOL)
      element.kind = Json::Kind::boolean, element.boolean = value.data.bools[i] != 0;
    else if (value.type == QUELL_PARAM_INT || value.type == QUELL_PARAM_ENUM)
      element.kind = Json::Kind::integer, element.integer = value.data.ints[i],
      element.number = static_cast<double>(element.integer);
    else if (value.type == QUELL_PARAM_DOUBLE)
      element.kind = Json::Kind::number, element.number = value.data.doubles[i];
    else
      element.kind = Json::Kind::string, element.string = value.data.strings[i];
  }
  return list;
}

}  // namespace quell::detail
