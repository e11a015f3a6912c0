// What a pass says of itself, for people.
#pragma once

#include <string>

#include "quell/plugin/registry.h"

namespace quell::app {

/// Everything that the descriptor tells: ports, parameters, sources, history of versions.
std::string describe(const RegisteredPass& pass);

}  // namespace quell::app
