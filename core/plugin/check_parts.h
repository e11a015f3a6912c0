// The parts of check(desc): each tells what is wrong with one piece of a descriptor, and is empty when nothing is. Nothing is
// read beyond what a struct_size covers. Private to this box.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "quell/sdk/abi.h"

namespace quell {

inline constexpr std::uint32_t kMostEntries = 1000;  // ports, parameters, ...; larger counts come from a broken descriptor

/// Starts with a small letter; goes on with small letters, digits and underscores. False for null.
bool is_snake_case(const char* name);
/// "" when an array of `count` entries can be walked. `size` is what an entry has had since version 1.0, `known` what it has now;
/// since newer plugins are not loaded, others cannot be.
std::string fault_in_array(const char* what, const void* array, std::uint32_t count, std::size_t size, std::size_t known);

std::string fault_in_param(const quell_param_desc& desc);
/// Whether a value (a default, or a former one, whose type and range may have been others) can be read.
std::string fault_in_value(const quell_param_value& value);

/// The size of a struct whose last field in version 1.0 is `field`.
#define QUELL_SIZE_TO(type, field) (offsetof(type, field) + sizeof(type::field))

}  // namespace quell
