#include <cstring>
#include <set>
#include <string_view>

#include "quell/plugin/check_parts.h"
#include "quell/plugin/registry.h"

namespace quell {
namespace {

constexpr std::uint32_t kCameraBit = QUELL_TYPE_BIT(QUELL_TYPE_CAMERA);
constexpr const char* kCameraOutput = "an output cannot be a camera: the interface has no place to write one";

std::string fault_in_port(const quell_port_desc& port, const quell_pass_desc& pass, bool is_output) {
  if (!is_snake_case(port.name)) return "its name is not in snake_case";
  if (!port.doc) return "its doc is null";
  if (port.types >= QUELL_TYPE_BIT(QUELL_TYPE_COUNT)) return "it has a type that is not known";
  if (port.flags & ~(QUELL_PORT_OPTIONAL | QUELL_PORT_ARRAY | QUELL_PORT_ANY_SIZE)) return "it has a flag that is not known";
  const bool is_array = port.flags & QUELL_PORT_ARRAY;
  if (!is_output) {
    if (port.same_as != -1) return "only an output may be of the same type as an input";
    return port.types == 0 ? "it accepts no type" : "";
  }
  if (port.flags & QUELL_PORT_OPTIONAL) return "an output cannot be optional";
  if (port.flags & QUELL_PORT_ANY_SIZE) return "an output cannot be of any size: infer says which it has";
  if (port.same_as < -1 || port.same_as >= static_cast<std::int64_t>(pass.input_count)) return "its same_as names no input";
  if (port.same_as >= 0) {
    const quell_port_desc& followed = *QUELL_AT(quell_port_desc, pass.inputs, port.same_as);
    const bool from_array = followed.flags & QUELL_PORT_ARRAY;
    if (from_array != is_array) return "it and the input that same_as names must both be arrays, or neither";
    return followed.types & kCameraBit ? kCameraOutput : "";
  }
  if (is_array) return "an output that is an array needs a same_as input";
  const bool is_one_type = port.types != 0 && (port.types & (port.types - 1)) == 0;
  if (!is_one_type) return "an output has exactly one type, or a same_as input";
  return port.types == kCameraBit ? kCameraOutput : "";
}

std::string fault_in_ports(const quell_pass_desc& pass, const quell_port_desc* ports, std::uint32_t count, bool is_output) {
  const std::string what = is_output ? "output" : "input";
  std::string fault =
      fault_in_array((what + "s").c_str(), ports, count, QUELL_SIZE_TO(quell_port_desc, doc), sizeof(quell_port_desc));
  std::set<std::string_view> names;
  for (std::uint32_t i = 0; i < count && fault.empty(); ++i) {
    const quell_port_desc& port = *QUELL_AT(quell_port_desc, ports, i);
    const std::string label = what + (port.name ? " '" + std::string(port.name) + "'" : " " + std::to_string(i));
    if (fault = fault_in_port(port, pass, is_output); !fault.empty())
      fault = label + ": " + fault;
    else if (!names.insert(port.name).second)
      fault = label + " is there twice";
  }
  return fault;
}

std::string fault_in_params(const quell_pass_desc& pass) {
  std::string fault = fault_in_array("params", pass.params, pass.param_count, QUELL_SIZE_TO(quell_param_desc, default_value),
                                     sizeof(quell_param_desc));
  std::set<std::string_view> names;
  for (std::uint32_t i = 0; i < pass.param_count && fault.empty(); ++i) {
    const quell_param_desc& param = *QUELL_AT(quell_param_desc, pass.params, i);
    const std::string label = "parameter " + (param.name ? "'" + std::string(param.name) + "'" : std::to_string(i));
    if (fault = fault_in_param(param); !fault.empty())
      fault = label + ": " + fault;
    else if (!names.insert(param.name).second)
      fault = label + " is there twice";
  }
  return fault;
}

/// The name that a change leaves behind must be a parameter of today, or be renamed by a later change.
bool is_known_after(const quell_pass_desc& pass, std::string_view name, std::uint32_t change) {
  for (std::uint32_t i = 0; i < pass.param_count; ++i)
    if (name == QUELL_AT(quell_param_desc, pass.params, i)->name) return true;
  for (std::uint32_t i = change + 1; i < pass.change_count; ++i)
    if (name == QUELL_AT(quell_change, pass.changes, i)->param) return true;
  return false;
}

std::string fault_in_changes(const quell_pass_desc& pass) {
  std::string fault = fault_in_array("changes", pass.changes, pass.change_count, QUELL_SIZE_TO(quell_change, former_default),
                                     sizeof(quell_change));
  for (std::uint32_t i = 0; i < pass.change_count && fault.empty(); ++i)
    if (!QUELL_AT(quell_change, pass.changes, i)->param) return "change " + std::to_string(i) + " names no parameter";
  for (std::uint32_t i = 0; i < pass.change_count && fault.empty(); ++i) {
    const quell_change& change = *QUELL_AT(quell_change, pass.changes, i);
    const std::string label = "change " + std::to_string(i) + " (version " + std::to_string(change.version) + "): ";
    const char* name = change.renamed_to ? change.renamed_to : change.param;
    if (change.version < 2 || change.version > pass.version)
      return label + "its version must be one of 2 to the pass's own, " + std::to_string(pass.version);
    if (!is_known_after(pass, name, i)) return label + "there is no parameter '" + name + "'";
    if (!change.former_default) continue;
    if (fault = fault_in_value(*change.former_default); !fault.empty()) fault = label + fault;
  }
  return fault;
}

std::string fault_in_pass(const quell_pass_desc& pass) {
  if (!pass.summary || !pass.doc || !pass.source) return "its summary, doc or source is null";
  if (pass.version == 0) return "its version is 0; versions count from 1";
  if (pass.oldest_version == 0 || pass.oldest_version > pass.version)
    return "its oldest version is " + std::to_string(pass.oldest_version) + ", not one of 1 to " + std::to_string(pass.version);
  if (!pass.create) return "its function create is null";
  if (!pass.destroy) return "its function destroy is null";
  if (!pass.infer) return "its function infer is null";
  if (!pass.process) return "its function process is null";
  if (pass.output_count == 0) return "it has no outputs";
  if (std::string fault = fault_in_ports(pass, pass.inputs, pass.input_count, false); !fault.empty()) return fault;
  if (std::string fault = fault_in_ports(pass, pass.outputs, pass.output_count, true); !fault.empty()) return fault;
  if (std::string fault = fault_in_params(pass); !fault.empty()) return fault;
  return fault_in_changes(pass);
}

}  // namespace

bool is_snake_case(const char* name) {
  if (!name || *name < 'a' || *name > 'z') return false;
  for (; *name; ++name)
    if (!((*name >= 'a' && *name <= 'z') || (*name >= '0' && *name <= '9') || *name == '_')) return false;
  return true;
}

std::string fault_in_array(const char* what, const void* array, std::uint32_t count, std::size_t size, std::size_t known) {
  if (count == 0) return {};
  if (count > kMostEntries) return "it claims to have " + std::to_string(count) + " " + what;
  if (!array) return "its array of " + std::string(what) + " is null";
  // Entries lie as far apart as the first one says, so all must say the same. Every struct starts with its size.
  const auto* bytes = static_cast<const char*>(array);
  const std::uint32_t stride = *static_cast<const std::uint32_t*>(array);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t own = stride;
    if (stride >= size && stride <= known) std::memcpy(&own, bytes + std::size_t{i} * stride, sizeof(own));
    if (own < size || own != stride || own > known)
      return "its array of " + std::string(what) + " has the struct_size " + std::to_string(own) + " instead of " +
             std::to_string(known);
  }
  return {};
}

std::string check(const quell_pass_desc& desc) {
  if (desc.struct_size < QUELL_SIZE_TO(quell_pass_desc, process) || desc.struct_size > sizeof(desc))
    return "the descriptor of a pass has the struct_size " + std::to_string(desc.struct_size) + " instead of " +
           std::to_string(sizeof(desc));
  if (!desc.id) return "a pass has no id";
  if (!is_snake_case(desc.id)) return "the id of the pass '" + std::string(desc.id) + "' is not in snake_case";
  const std::string fault = fault_in_pass(desc);
  return fault.empty() ? "" : "pass '" + std::string(desc.id) + "': " + fault;
}

}  // namespace quell
