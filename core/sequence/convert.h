// Where there is no surface: depths and ids that mean so, and pixels that a file does not hold.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "quell/image/image.h"
#include "quell/sequence/image_file.h"

namespace quell {

/// Depth 0, infinite, or at least 1e9 means that there is no surface, and becomes QUELL_NO_SURFACE_DEPTH.
void mark_no_surface(FloatOutput depth);

/// Object indices from floats. The background value becomes QUELL_NO_ID; when it is not known, every negative value does.
/// Throws Error(input) that names `file` and the first pixel whose value is not an index (not an integer, negative, beyond
/// 0xfffffffe).
void convert_ids(FloatImage from, std::optional<std::int64_t> background, const std::string& file, IdOutput to);
/// The same for indices that were read as integers, in place: 0xffffffff is background in any case.
void convert_ids(std::optional<std::int64_t> background, IdOutput ids);

/// Sets what lies outside `covered` to "no surface": QUELL_NO_ID, QUELL_NO_SURFACE_DEPTH, 0 for other types.
void fill_outside(Image& image, const Rectangle& covered);

}  // namespace quell
