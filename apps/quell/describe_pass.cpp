#include "describe_pass.h"

#include <array>
#include <cstdio>
#include <limits>

#include "quell/image/port_type.h"
#include "quell/plugin/pass_instance.h"
#include "text_layout.h"

namespace quell::app {
namespace {

constexpr std::size_t kIndent = 2;
constexpr std::size_t kColumn = 20;

std::string text(const char* words) { return words ? words : ""; }

std::string number(double value) {
  std::array<char, 64> digits{};
  std::snprintf(digits.data(), digits.size(), "%.10g", value);
  return digits.data();
}

/// The type of a port: "color", "color or albedo", "as input history"; with "list of", "optional" and "of any size".
std::string describe_type(const quell_port_desc& port, const quell_pass_desc& pass) {
  std::string type;
  if (port.flags & QUELL_PORT_ARRAY) type += "list of ";
  if (port.types != 0)
    type += quell::describe(Types{port.types});
  else
    type += "what '" + text(QUELL_AT(quell_port_desc, pass.inputs, port.same_as)->name) + "' is";
  if (port.flags & QUELL_PORT_OPTIONAL) type += ", optional";
  if (port.flags & QUELL_PORT_ANY_SIZE) type += ", of any size";
  return type;
}

std::string describe_ports(const char* heading, const quell_port_desc* ports, std::uint32_t count, const quell_pass_desc& pass) {
  if (count == 0) return {};
  std::string out = std::string("\n") + heading + "\n";
  for (std::uint32_t i = 0; i < count; ++i) {
    const quell_port_desc& port = *QUELL_AT(quell_port_desc, ports, i);
    out += entry(text(port.name), describe_type(port, pass), kIndent, kColumn);
    out += wrap(text(port.doc), kColumn);
  }
  return out;
}

/// Bounds so large that they only say what the type can hold are not worth a word.
std::string describe_range(const quell_param_desc& param) {
  if (param.type != QUELL_PARAM_INT && param.type != QUELL_PARAM_DOUBLE) return {};
  const double largest = param.type == QUELL_PARAM_INT ? double{std::numeric_limits<std::int32_t>::max()}
                                                       : double{std::numeric_limits<float>::max()};
  const bool has_min = param.min_value > -largest, has_max = param.max_value < largest;
  if (has_min && has_max) return ", " + number(param.min_value) + " to " + number(param.max_value);
  if (has_min) return ", at least " + number(param.min_value);
  if (has_max) return ", at most " + number(param.max_value);
  return {};
}

std::string describe_type(const quell_param_desc& param) {
  static constexpr std::array names{"true or false", "whole number", "number", "text", "one of", "path"};
  std::string type = param.type < names.size() ? names[param.type] : "unknown type";
  if (param.is_array) {
    const bool fixed = param.min_count == param.max_count;
    type =
        "list of " +
        (fixed ? std::to_string(param.min_count) : std::to_string(param.min_count) + " to " + std::to_string(param.max_count)) +
        ": " + type;
  }
  return type;
}

std::string describe_choices(const quell_param_desc& param) {
  std::string out;
  for (std::uint32_t i = 0; i < param.enum_count; ++i)
    out += entry(text(param.enum_values[i]), param.enum_docs ? text(param.enum_docs[i]) : "", kColumn + 2, kColumn + 20);
  return out;
}

std::string describe_params(const quell_pass_desc& pass) {
  if (pass.param_count == 0) return "\nparameters\n  none\n";
  std::string out = "\nparameters\n";
  for (std::uint32_t i = 0; i < pass.param_count; ++i) {
    const quell_param_desc& param = *QUELL_AT(quell_param_desc, pass.params, i);
    std::string line = to_json(param, default_value(param)) + "  (" + describe_type(param) + describe_range(param);
    if (!text(param.unit).empty()) line += ", in " + text(param.unit);
    out += entry(text(param.name), line + ")", kIndent, kColumn);
    out += wrap(text(param.doc), kColumn) + describe_choices(param);
  }
  return out;
}

/// The parameter that a change left behind; null when a later change renamed it.
const quell_param_desc* find_param(const quell_pass_desc& pass, const std::string& name) {
  for (std::uint32_t i = 0; i < pass.param_count; ++i) {
    const quell_param_desc* param = QUELL_AT(quell_param_desc, pass.params, i);
    if (name == param->name) return param;
  }
  return nullptr;
}

std::string describe_default(const quell_pass_desc& pass, const quell_change& change) {
  const quell_param_desc* param = find_param(pass, text(change.renamed_to ? change.renamed_to : change.param));
  if (!change.former_default || !param) return "its default changed";
  quell_param_desc former = *param;
  former.type = change.former_default->type;  // an enum's may be told by name, as text
  former.default_value = change.former_default;
  return "its default was " + to_json(former, default_value(former));
}

std::string describe_versions(const quell_pass_desc& pass) {
  std::string out;
  if (pass.oldest_version < pass.version)
    out += wrap("Graphs written for version " + std::to_string(pass.oldest_version) + " or later are understood.", kIndent);
  for (std::uint32_t i = 0; i < pass.change_count; ++i) {
    const quell_change& change = *QUELL_AT(quell_change, pass.changes, i);
    std::string what = "'" + text(change.param) + "'";
    if (change.renamed_to) what += " became '" + text(change.renamed_to) + "'";
    if (change.renamed_to && change.former_default) what += ";";
    if (change.former_default || !change.renamed_to) what += (change.renamed_to ? " " : ": ") + describe_default(pass, change);
    out += entry("version " + std::to_string(change.version), what, kIndent, kColumn);
  }
  return out.empty() ? out : "\nversions\n" + out;
}

}  // namespace

std::string describe(const RegisteredPass& registered) {
  const quell_pass_desc& pass = *registered.desc;
  std::string out = text(pass.id) + ", version " + std::to_string(pass.version) + "\n" + wrap(text(pass.summary), kIndent);
  if (!text(pass.doc).empty()) out += "\n" + wrap(text(pass.doc), kIndent);
  out += describe_ports("inputs", pass.inputs, pass.input_count, pass);
  out += describe_ports("outputs", pass.outputs, pass.output_count, pass);
  out += describe_params(pass);
  out += describe_versions(pass);
  if (!text(pass.source).empty()) out += "\nsource\n" + wrap(text(pass.source), kIndent);
  if (!registered.file.empty()) out += "\nplugin\n  " + registered.file.string() + "\n";
  return out;
}

}  // namespace quell::app
