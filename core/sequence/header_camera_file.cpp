#include <algorithm>
#include <cmath>

#include "quell/sequence/header_camera.h"
#include "quell/sequence/image_file.h"
#include "quell/text/error.h"

namespace quell {

HeaderCamera read_header_camera(const std::filesystem::path& file) {
  const ImageFile image(file);
  const auto matrix = [&](const char* name) {
    const std::optional<Matrix> found = image.matrix(name);
    if (!found)
      throw Error(Fault::input, file.string(),
                  std::string("the header has no matrix ") + name + "; a camera needs worldToCamera and worldToNDC");
    if (!std::all_of(found->begin(), found->end(), [](double value) { return std::isfinite(value); }))
      throw Error(Fault::input, file.string(), std::string("the header's ") + name + " holds a number that is not finite");
    return *found;
  };
  const Rectangle& window = image.display_window();
  return {file.string(), {window.width, window.height}, image.pixel_aspect(), matrix("worldToCamera"), matrix("worldToNDC")};
}

}  // namespace quell
