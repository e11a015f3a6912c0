// Passes for the tests of graph files: ports and parameters of every kind, and nothing computed.
#pragma once

#include "quell/plugin/registry.h"

namespace quell::test {

/// A registry with the passes filter, blend, reproject, back_project, merge, copy, meter, select,
/// split and smooth.
const Registry& passes();

}  // namespace quell::test
