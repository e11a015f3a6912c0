// operator new, replaced for the whole program that links this, and counted.
#pragma once

#include <cstddef>

namespace quell::test {

/// Calls of operator new so far, from all threads and libraries.
std::size_t allocations();

}  // namespace quell::test
