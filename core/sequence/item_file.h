// Items in files of their own, bit for bit: for what a run keeps until another one goes on with it.
#pragma once

#include <cstdint>
#include <filesystem>

#include "quell/image/item.h"

namespace quell {

/// ".exr" for images, ".json" for cameras and values.
const char* item_extension(PortType type);

/// Writes an item that is there: images as EXR of floats (ids as uint) with ZIP compression, cameras as the sidecars that
/// read_json_camera() reads, values as numbers in hexadecimal. The file takes its name when it is complete. Throws Error(frame).
void write_item(const Item& item, std::int64_t frame, const std::filesystem::path& file);

/// What write_item() has written, the same bits. Throws Error(input) when the file is missing, damaged, or holds no such item.
Item read_item(const std::filesystem::path& file, PortType type, BufferPool& pool);

}  // namespace quell
