#include "quell/sequence/oiio.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>

namespace quell {

void prepare_oiio() {
  // "threads" 0 and "exr_threads" 0 would mean one for each core; -1 is how OpenEXR is told to start none.
  static const bool done = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  static_cast<void>(done);
}

std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "no reason given" : text;
}

}  // namespace quell
