// From JSON values to parameters of passes. Private to this box.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "quell/graph/scope.h"

namespace quell::detail {

/// What surrounds a value that is to become a parameter.
struct ValueContext {
  std::string label;             ///< in messages: "filter.radius"
  std::filesystem::path folder;  ///< relative paths are taken from it
  std::vector<Note> notes;       ///< for errors
};

/// Checks type, range, length and enum values. Nothing, and an error, when the value does not fit.
std::optional<ParamValue> to_param(const quell_param_desc& desc, const Json& value, const ValueContext& context,
                                   Diagnostics& errors);

/// What a parameter takes, in words: "an integer from 0 to 64 (px)", "a list of 1 to 9 values, each a number".
std::string expected_value(const quell_param_desc& desc);

/// A value of the plugin interface as JSON, standing at `where`.
Json to_json_value(const quell_param_value& value, const Position& where);

}  // namespace quell::detail
