// Cameras from files.
#pragma once

#include <filesystem>

#include "quell/image/item.h"

namespace quell {

/// The GAMES202 course's matrices: little-endian int32 n, then n + 2 row-major 4x4 float32: object-to-world of objects 0..n-1,
/// world-to-camera, world-to-screen. The file does not tell the resolution. Throws Error(input) when the size is not exactly
/// that, when a number is not finite, or world-to-camera cannot be inverted.
Camera read_mat_camera(const std::filesystem::path& file, Size resolution);

/// A JSON sidecar: width, height, world_to_camera, world_to_pixel (lists of 4 rows, column vectors; pixels y down), objects,
/// {"<id>": {"object_to_world": ...}}, and optionally jitter, [x, y] in pixels (contained in world_to_pixel). Other keys are the
/// renderer's own and not looked at. Throws Error(input) with every mistake and its place.
Camera read_json_camera(const std::filesystem::path& file);

}  // namespace quell
