// OpenImageIO's settings for this process.
#pragma once

#include <string>

namespace quell {

/// Makes OpenImageIO and OpenEXR work on the calling thread alone: frames are read and written side by side by quell's own
/// threads. Call before using either; only the first call does anything. Thread-safe.
void prepare_oiio();

/// OpenImageIO's errors may have several lines, and end with a line feed; a message here is one.
std::string one_line(std::string text);

}  // namespace quell
