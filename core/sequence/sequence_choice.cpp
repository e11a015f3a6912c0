// What is read of files that serve several inputs, and how that is told.
#include "quell/sequence/renderer_names.h"
#include "quell/sequence/sequence_state.h"

namespace quell {

const SequenceInput* Sequence::State::find_shared(std::string_view name, PortType type) {
  if (!shared || !is_image(type)) return nullptr;
  Listings listings;
  const FrameFiles files = find_frames(*shared, listings.of(shared->folder()));
  const ImageFile first(shared->path(files.frames.front()));
  if (recognize(first.channels(), name, type).empty()) return nullptr;
  InputSpec spec;
  spec.name = name;
  spec.pattern = *shared;
  spec.origin = shared->text();
  spec.shared = true;
  add(std::move(spec), listings);
  return find(name);
}

Selection Sequence::State::selection(const SequenceInput& input) {
  // Not request(), which asks for the window, which may ask for this.
  ImageRequest request{type(input), input.spec.channels};
  request.layer = input.spec.layer;
  request.input = input.spec.name;
  request.pattern = input.spec.pattern.text();
  request.stem = input.spec.pattern.stem();
  request.shared = input.spec.shared;
  const std::filesystem::path path = input.spec.pattern.path(first_frame(input));
  Selection found = select_channels(ImageFile(path).channels(), request, path.string());
  found.conventions = input.spec.conventions.or_else(found.conventions);
  return found;
}

std::string Sequence::State::describe_choice(const SequenceInput& input) {
  try {
    if (input.frames.empty() || !is_image(type(input))) return "";
    const Selection chosen = selection(input);
    const std::string conventions = quell::describe(chosen.conventions);
    const bool is_stated = !input.spec.layer.empty() || !input.spec.channels.empty();
    if (!input.spec.shared && !is_stated && chosen.renderer.empty() && conventions.empty()) return "";
    const ImageFile file(input.spec.pattern.path(first_frame(input)));
    std::string text = chosen.layer.empty() ? "" : chosen.layer + ": ";
    const char* joint = "";
    for (const int channel : chosen.channels) {
      const std::string& name = file.channels()[static_cast<std::size_t>(channel)].name;
      text += joint + std::string(chosen.layer.empty() ? name : channel_suffix(name));
      joint = ",";
    }
    if (!chosen.renderer.empty()) text += " (" + chosen.renderer + ")";
    return text + (conventions.empty() ? "" : "  " + conventions);
  } catch (const Error&) { return ""; }  // told by who reads it
}

}  // namespace quell
