#include "quell/sequence/image_writer.h"

#include <limits>

#include "quell/text/error.h"

namespace quell {

std::vector<std::string> channel_names(PortType type, const std::string& layer) {
  const auto names = [&]() -> std::vector<std::string> {
    switch (type) {
      case QUELL_TYPE_COLOR:
      case QUELL_TYPE_ALBEDO:
        return {"R", "G", "B"};
      case QUELL_TYPE_NORMAL:
      case QUELL_TYPE_POSITION:
        return {"X", "Y", "Z"};
      case QUELL_TYPE_MOTION:
      case QUELL_TYPE_MOMENTS:
        return {"X", "Y"};
      case QUELL_TYPE_DEPTH:
        return {"Z"};
      case QUELL_TYPE_ALPHA:
        return {"A"};
      default:
        return {"Y"};
    }
  };
  std::vector<std::string> full = names();
  if (!layer.empty())
    for (std::string& name : full) name.insert(0, layer + ".");
  return full;
}

Placement place(const FileContent& content) {
  const Size size = content.layers.front().image.size();
  for (const WrittenLayer& layer : content.layers)
    if (layer.image.width() != size.width || layer.image.height() != size.height)
      throw Error(Fault::frame, "layers",
                  "the images of frame " + std::to_string(content.frame.value_or(0)) +
                      " differ in size, so that one file cannot hold them");
  if (!content.original) return place_alone(size);
  const Placement placement = content.original->place(size);
  const Size picture = content.original->picture_size();
  if (content.keep_channels && (picture.width != size.width || picture.height != size.height))
    throw Error(Fault::frame, content.original->file().path().string(),
                "its channels cannot be kept: they have " + std::to_string(picture.width) + " x " +
                    std::to_string(picture.height) + " pixels, and the result " + std::to_string(size.width) + " x " +
                    std::to_string(size.height));
  return placement;
}

void add_attributes(OIIO::ImageSpec& spec, const FileContent& content, const FileSinkOptions& options) {
  if (content.original) content.original->add_attributes(spec, content.keep_channels);
  for (const auto& attributes : {options.attributes, content.attributes})
    for (const FileAttribute& attribute : attributes) spec.attribute(attribute.name, attribute.text);
  if (!content.frame) return;
  if (*content.frame >= std::numeric_limits<int>::min() && *content.frame <= std::numeric_limits<int>::max())
    spec.attribute("quell:frame", static_cast<int>(*content.frame));
  else
    spec.attribute("quell:frame", std::to_string(*content.frame));
}

}  // namespace quell
