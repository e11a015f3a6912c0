// Graphs that were written for an earlier version of a pass keep their meaning. Private to this box.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/sdk/abi.h"

namespace quell::detail {

/// Why a graph that names this version of the pass is refused; empty when it is not.
std::string refuse_version(const quell_pass_desc& pass, std::uint32_t version);

/// The parameter that a graph written for `version` means by a name; nothing when there is none.
std::optional<std::uint32_t> find_param(const quell_pass_desc& pass, std::uint32_t version, std::string_view name);

/// "; it is called 'sigma_color' since version 2", or what suggest() says.
std::string suggest_param(const quell_pass_desc& pass, std::string_view name);

/// A default that `version` had, and today's version has no more.
struct FormerDefault {
  std::uint32_t param;
  const quell_param_value* value;
};
std::vector<FormerDefault> former_defaults(const quell_pass_desc& pass, std::uint32_t version);

}  // namespace quell::detail
