#include "quell/plugin/param_value.h"

#include <cassert>
#include <charconv>

#include "quell/text/json.h"

namespace quell {
namespace {

std::string number(auto value) {
  char text[32];  // the shortest text that reads back as the same double has at most 24 characters
  return {text, std::to_chars(text, text + sizeof(text), value).ptr};
}

std::string element(const quell_param_desc& desc, std::uint8_t value) {
  assert(desc.type == QUELL_PARAM_BOOL);
  return value ? "true" : "false";
}
std::string element(const quell_param_desc& desc, std::int64_t value) {
  return desc.type == QUELL_PARAM_ENUM ? quote_json(desc.enum_values[value]) : number(value);
}
std::string element(const quell_param_desc&, double value) { return number(value); }
std::string element(const quell_param_desc&, const std::string& value) { return quote_json(value); }

}  // namespace

ParamValue default_value(const quell_param_desc& desc) {
  const quell_param_value& from = *desc.default_value;
  switch (desc.type) {
    case QUELL_PARAM_BOOL:
      return {std::vector<std::uint8_t>(from.data.bools, from.data.bools + from.count)};
    case QUELL_PARAM_DOUBLE:
      return {std::vector<double>(from.data.doubles, from.data.doubles + from.count)};
    case QUELL_PARAM_INT:
    case QUELL_PARAM_ENUM:
      return {std::vector<std::int64_t>(from.data.ints, from.data.ints + from.count)};
    default:
      return {std::vector<std::string>(from.data.strings, from.data.strings + from.count)};
  }
}

std::string to_json(const quell_param_desc& desc, const ParamValue& value) {
  return std::visit(
      [&](const auto& elements) {
        if (!desc.is_array) return element(desc, elements.at(0));
        std::string list = "[";
        for (std::size_t i = 0; i < elements.size(); ++i) list += (i ? ", " : "") + element(desc, elements[i]);
        return list + "]";
      },
      value.elements);
}

RawParams::RawParams(const quell_pass_desc& desc, const std::vector<ParamValue>& values) {
  strings_.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    quell_param_value raw{sizeof(quell_param_value), QUELL_AT(quell_param_desc, desc.params, i)->type, 0, {}};
    raw.count = std::visit([](const auto& elements) { return static_cast<std::uint32_t>(elements.size()); }, values[i].elements);
    if (const auto* bools = std::get_if<std::vector<std::uint8_t>>(&values[i].elements)) {
      raw.data.bools = bools->data();
    } else if (const auto* ints = std::get_if<std::vector<std::int64_t>>(&values[i].elements)) {
      raw.data.ints = ints->data();
    } else if (const auto* doubles = std::get_if<std::vector<double>>(&values[i].elements)) {
      raw.data.doubles = doubles->data();
    } else {
      std::vector<const char*>& pointers = strings_.emplace_back();
      for (const std::string& text : std::get<std::vector<std::string>>(values[i].elements)) pointers.push_back(text.c_str());
      raw.data.strings = pointers.data();
    }
    raw_.push_back(raw);
  }
}

}  // namespace quell
