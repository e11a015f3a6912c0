// Which part of the images a sequence reads.
#include "quell/sequence/sequence_state.h"
#include "quell/text/error.h"

namespace quell {
namespace {

std::string size_text(const Rectangle& r) { return std::to_string(r.width) + " x " + std::to_string(r.height); }

}  // namespace

Size Sequence::State::resolution(const std::filesystem::path& camera) {
  if (const std::optional<PictureWindow> pictures = picture_window()) return {pictures->display.width, pictures->display.height};
  throw Error(
      Fault::input, camera.string(),
      "this camera's file does not tell the resolution, and the sequence has no image to take it from; add one with --in");
}

std::optional<PictureWindow> Sequence::State::picture_window() {
  {
    const std::lock_guard lock(mutex);
    if (known_window) return *known_window;
  }
  const SequenceInput* picture = main_picture();
  const std::optional<PictureWindow> found = picture ? std::optional(find_window(*picture)) : std::nullopt;
  const std::lock_guard lock(mutex);
  known_window = found;
  return found;
}

PictureWindow Sequence::State::find_window(const SequenceInput& picture) {
  const std::filesystem::path path = picture.spec.pattern.path(first_frame(picture));
  const ImageFile file(path);
  PictureWindow window{file.display_window(), file.display_window(), file.pixel_aspect()};
  if (window_choice == WindowChoice::data) window.data = file.data_window(selection(picture).channels[0]);
  if (!crop) return window;
  const auto fits = [](int begin, int size, int whole) {
    return begin >= 0 && size >= 1 && size <= whole && begin <= whole - size;
  };
  if (!fits(crop->x, crop->width, window.data.width) || !fits(crop->y, crop->height, window.data.height))
    throw Error(Fault::usage, "--crop",
                std::to_string(crop->x) + "," + std::to_string(crop->y) + "," + std::to_string(crop->width) + "," +
                    std::to_string(crop->height) + " is not all within the image, which is " + size_text(window.data) + " (" +
                    path.string() + "); the numbers are x, y, width and height");
  window.data = {window.data.x + crop->x, window.data.y + crop->y, crop->width, crop->height};
  return window;
}

std::optional<Rectangle> Sequence::State::window() {
  if (window_choice == WindowChoice::display && !crop) return std::nullopt;
  const std::optional<PictureWindow> pictures = picture_window();
  if (!pictures) return std::nullopt;
  const Rectangle &display = pictures->display, &data = pictures->data;
  return Rectangle{data.x - display.x, data.y - display.y, data.width, data.height};
}

void Sequence::State::require_same_size(const SequenceInput& input) {
  if (!window()) return;  // else different sizes show by themselves
  const Rectangle whole = picture_window()->display;
  const Rectangle own = ImageFile(input.spec.pattern.path(first_frame(input))).display_window();
  if (own.width == whole.width && own.height == whole.height) return;
  throw Error(Fault::input, input.spec.pattern.text(),
              "the images of '" + input.spec.name + "' are " + size_text(own) + ", those of '" + main_picture()->spec.name +
                  "' " + size_text(whole) + ", so that they have no part in common");
}

Camera shift(Camera camera, const Rectangle& window) {
  for (std::size_t column = 0; column < 4; ++column) {
    camera.world_to_screen[column] -= window.x * camera.world_to_screen[12 + column];
    camera.world_to_screen[4 + column] -= window.y * camera.world_to_screen[12 + column];
  }
  camera.size = {window.width, window.height};
  return camera;
}

}  // namespace quell
