// What ImageFile keeps: an open reader of OpenImageIO. Private to image_file*.cpp.
#pragma once

#include <OpenImageIO/imageio.h>

#include "quell/sequence/image_file.h"

namespace quell {

struct ImageFile::State {
  struct Part {
    OIIO::ImageSpec spec;
    Rectangle data;
  };

  std::filesystem::path path;
  std::string format;
  std::unique_ptr<OIIO::ImageInput> file;
  Rectangle display;
  float pixel_aspect = 1;
  std::vector<Part> parts;
  std::vector<FileChannel> channels;
  std::vector<int> index;  ///< of each channel in its part

  [[noreturn]] void fail(const std::string& what) const;
  void open();
  void add_part(int number);
  void name_channels();
  const Part& part_of(int channel) const;
};

}  // namespace quell
