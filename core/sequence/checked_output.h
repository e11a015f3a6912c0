// An image file in the making, of which it is known whether all of it arrived. Private to core/sequence.
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>

namespace quell {

/// Writes rows with OpenImageIO's writer of a format ("openexr", "png").
class CheckedOutput {
 public:
  /// Creates the file. Throws Error(frame), as all that follows does.
  CheckedOutput(const char* format, const std::filesystem::path& file, OIIO::ImageSpec spec);
  ~CheckedOutput();

  /// Rows [begin, end), in the file's coordinates, all channels of a pixel after another; `type` TypeUnknown: as in the file.
  void write_rows(int begin, int end, OIIO::TypeDesc type, const void* pixels);
  /// After the last row. A file that was not closed is not whole.
  void close();

 private:
  class File;
  void check(bool ok);
  std::filesystem::path path_;
  std::unique_ptr<File> file_;
  std::unique_ptr<OIIO::ImageOutput> output_;  // before file_ goes
};

}  // namespace quell
