#include "quell/sequence/image_input.h"

#include <algorithm>
#include <new>

#include "quell/sequence/convert.h"
#include "quell/text/error.h"

namespace quell {
namespace {

/// An open file, and what is to be read of it.
struct Source {
  ImageFile& file;
  PortType type;
  Selection selection;
  Conventions conventions;
  Rectangle window;  ///< in the file's coordinates

  Size size() const { return {window.width, window.height}; }
  std::string name() const { return file.path().string(); }
};

Rectangle window_to_read(const ImageFile& file, const ImageRequest& request) {
  const Rectangle& display = file.display_window();
  if (!request.window) return display;
  const Rectangle& wanted = *request.window;
  return {display.x + wanted.x, display.y + wanted.y, wanted.width, wanted.height};
}

/// 8 and 16 bit integers are read as 0 to 1: enough for colors and directions, but no place, distance or motion in a scene.
void require_range(const ImageFile& file, Numbers numbers, PortType type) {
  const bool is_small = numbers == Numbers::uint8 || numbers == Numbers::uint16;
  const bool needs_range =
      type == QUELL_TYPE_POSITION || type == QUELL_TYPE_DEPTH || type == QUELL_TYPE_MOTION || type == QUELL_TYPE_MOMENTS;
  if (is_small && needs_range)
    throw Error(Fault::input, file.path().string(),
                "holds " + std::string(numbers == Numbers::uint8 ? "8" : "16") +
                    " bit integers, which say 0 to 1 and cannot be " + std::string(name(type)) + "; give files of floats");
}

Source select_source(ImageFile& file, const ImageRequest& request) {
  Source source{file, request.type, select_channels(file.channels(), request, file.path().string()), {}, {}};
  const Numbers numbers = file.channels()[static_cast<std::size_t>(source.selection.channels[0])].numbers;
  require_range(file, numbers, request.type);
  source.conventions = request.conventions.or_else(source.selection.conventions)
                           .or_else(default_conventions(file.format(), numbers, request.type));
  source.window = window_to_read(file, request);
  return source;
}

Image read_ids(const Source& source, BufferPool& pool) {
  Image ids(QUELL_TYPE_ID, source.size(), pool);
  const int channel = source.selection.channels[0];
  const auto& background = source.conventions.background;
  if (is_integer(source.file.channels()[static_cast<std::size_t>(channel)].numbers)) {
    source.file.read(channel, source.window, ids.writable_ids());
    convert_ids(background, ids.writable_ids());
    return ids;
  }
  Image indices(QUELL_TYPE_SCALAR, source.size(), pool);
  source.file.read({channel}, source.window, indices.writable_floats());
  // Outside the data window stand zeros, which are an index like any other; fill_outside() follows.
  convert_ids(indices.floats(), background, source.name(), ids.writable_ids());
  return ids;
}

std::optional<Image> read_alpha(const Source& source, BufferPool& pool) {
  if (!source.selection.alpha) return std::nullopt;
  Image alpha(QUELL_TYPE_ALPHA, source.size(), pool);
  source.file.read({*source.selection.alpha}, source.window, alpha.writable_floats());
  return alpha;
}

Image read_floats(const Source& source, BufferPool& pool, ConversionContext context) {
  Image image(source.type, source.size(), pool);
  source.file.read(source.selection.channels, source.window, image.writable_floats());
  const Rectangle& display = source.file.display_window();
  context.whole = {display.width, display.height};
  context.x = source.window.x - display.x, context.y = source.window.y - display.y;
  context.alpha = [&] { return read_alpha(source, pool); };
  to_meaning(image, source.conventions, context);
  return image;
}

/// `part`: of what the display window shows, a part was asked for, beyond which files may reach.
std::string describe_window(const Rectangle& covered, const Rectangle& data, const Rectangle& wanted, bool part) {
  const auto size = [](const Rectangle& r) { return std::to_string(r.width) + " x " + std::to_string(r.height); };
  const bool cropped = !part && (covered.width < data.width || covered.height < data.height);
  std::string text = "the file's pixels ";
  if (cropped) text += "reach beyond the image of " + size(wanted) + " and are cropped";
  if (covered != wanted)
    text += std::string(cropped ? ", and " : "") + "cover " + size(covered) + " of " + size(wanted) +
            "; the rest is filled with nothing (0, no surface)";
  return text;
}

/// The part of the window for which all of these channels have pixels.
Rectangle find_covered(const Source& source) {
  Rectangle covered = source.window;
  for (const int channel : source.selection.channels) covered = intersection(covered, source.file.data_window(channel));
  return covered;
}

}  // namespace

Size probe_image(const std::filesystem::path& path, const ImageRequest& request) {
  ImageFile file(path);
  return select_source(file, request).size();
}

Image read_image(const std::filesystem::path& path, const ImageRequest& request, BufferPool& pool,
                 const std::function<void(const std::string&)>& note) {
  ImageFile file(path);
  const Source source = select_source(file, request);
  const Rectangle& window = source.window;
  try {
    Image image = request.type == QUELL_TYPE_ID
                      ? read_ids(source, pool)
                      : read_floats(source, pool, {.file = path.string(), .camera = request.camera, .note = note});
    const Rectangle covered = find_covered(source);
    const Rectangle& data = file.data_window(source.selection.channels[0]);
    if (covered != window || (!request.window && covered != data))
      note(describe_window(covered, data, window, request.window.has_value()));
    const Rectangle inside{covered.x - window.x, covered.y - window.y, covered.width, covered.height};
    fill_outside(image, covered.empty() ? Rectangle{} : inside);
    return image;
  } catch (const std::bad_alloc&) {
    throw Error(Fault::input, path.string(),
                "not enough memory for " + std::to_string(window.width) + " x " + std::to_string(window.height) + " pixels");
  }
}

StoredImage read_stored(const std::filesystem::path& path, const ImageRequest& request, BufferPool& pool) {
  ImageFile file(path);
  const Source source = select_source(file, request);
  const Rectangle &display = file.display_window(), &window = source.window;
  StoredImage stored{Image(request.type == QUELL_TYPE_ID ? QUELL_TYPE_SCALAR : request.type, source.size(), pool),
                     std::string(file.format()),
                     {},
                     source.selection,
                     file.channels()[static_cast<std::size_t>(source.selection.channels[0])].numbers,
                     source.conventions,
                     {display.width, display.height},
                     window.x - display.x,
                     window.y - display.y};
  for (const int channel : source.selection.channels)
    stored.channels.push_back(file.channels()[static_cast<std::size_t>(channel)].name);
  const FloatOutput out = stored.image.writable_floats();
  if (request.type != QUELL_TYPE_ID || !is_integer(stored.numbers)) {
    file.read(source.selection.channels, window, out);
    return stored;
  }
  Image integers(QUELL_TYPE_ID, source.size(), pool);  // as floats, 8 and 16 bit would be 0 to 1
  file.read(source.selection.channels[0], window, integers.writable_ids());
  for (int y = 0; y < out.height; ++y)
    std::transform(integers.ids().row(y), integers.ids().row(y) + out.width, out.row(y),
                   [](std::uint32_t id) { return static_cast<float>(id); });
  return stored;
}

}  // namespace quell
