#include "quell/sequence/image_input.h"

#include <algorithm>
#include <new>

#include "quell/sequence/convert.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

using Names = std::vector<std::string>;

std::string upper(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

std::string joined(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

/// Sets of names under which an image of so many planes is usually written.
std::vector<Names> usual_names(int planes) {
  if (planes == 3) return {{"R", "G", "B"}, {"X", "Y", "Z"}};
  return {{"X", "Y"}, {"R", "G"}, {"U", "V"}};
}

/// Indices of `wanted` in `names`; empty when one is missing.
std::vector<int> find_all(const Names& wanted, const Names& names) {
  std::vector<int> indices;
  for (const std::string& name : wanted) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return {};
    indices.push_back(static_cast<int>(found - names.begin()));
  }
  return indices;
}

[[noreturn]] void fail(const std::string& file, const Names& found, PortType type, const std::string& why) {
  const int planes = info(type).channels;
  const std::string needed = planes == 1   ? "1 channel"
                             : planes == 2 ? "2 channels (X,Y, R,G or U,V)"
                                           : "3 channels (R,G,B or X,Y,Z)";
  constexpr std::size_t kShown = 12;
  Names shown(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(std::min(found.size(), kShown)));
  if (found.size() > kShown) shown.push_back("...");
  throw Error(Fault::input, file,
              "found " + std::to_string(found.size()) + (found.size() == 1 ? " channel (" : " channels (") + joined(shown) +
                  "), but " + std::string(name(type)) + " needs " + needed + why);
}

std::vector<int> select_stated(const Names& in_file, const ImageRequest& request, const std::string& file) {
  if (static_cast<int>(request.channels.size()) != info(request.type).channels)
    fail(file, in_file, request.type, "; " + std::to_string(request.channels.size()) + " are named: " + joined(request.channels));
  for (const std::string& name : request.channels)
    if (std::find(in_file.begin(), in_file.end(), name) == in_file.end())
      fail(file, in_file, request.type, "; there is no '" + name + "'" + did_you_mean(name, in_file));
  return find_all(request.channels, in_file);
}

Image read_ids(ExrFile& exr, int channel, const ImageRequest& request, const std::string& name, BufferPool& pool) {
  Image ids(QUELL_TYPE_ID, exr.size(), pool);
  if (exr.is_uint(channel)) {
    exr.read(channel, ids.writable_ids());
    convert_ids(request.background, ids.writable_ids());
    return ids;
  }
  Image indices(QUELL_TYPE_SCALAR, exr.size(), pool);
  exr.read({channel}, indices.writable_floats());
  // Outside the data window stand zeros, which are an index like any other; fill_outside() follows.
  convert_ids(indices.floats(), request.background, name, ids.writable_ids());
  return ids;
}

Image read_floats(ExrFile& exr, const std::vector<int>& channels, const ImageRequest& request, BufferPool& pool) {
  Image image(request.type, exr.size(), pool);
  exr.read(channels, image.writable_floats());
  if (request.type == QUELL_TYPE_NORMAL) normalize_normals(image.writable_floats());
  if (request.type == QUELL_TYPE_DEPTH) mark_no_surface(image.writable_floats());
  return image;
}

std::string describe_window(const ExrFile& exr) {
  const auto size = [](int width, int height) { return std::to_string(width) + " x " + std::to_string(height); };
  const Rectangle& covered = exr.covered();
  std::string text = "the file's pixels ";
  if (exr.cropped()) text += "reach beyond the image of " + size(exr.size().width, exr.size().height) + " and are cropped";
  if (covered.width < exr.size().width || covered.height < exr.size().height)
    text += std::string(exr.cropped() ? ", and " : "") + "cover " + size(covered.width, covered.height) + " of " +
            size(exr.size().width, exr.size().height) + "; the rest is filled with nothing (0, no surface)";
  return text;
}

}  // namespace

std::vector<int> select_channels(const Names& in_file, const ImageRequest& request, const std::string& file) {
  if (!request.channels.empty()) return select_stated(in_file, request, file);
  Names names;
  for (const std::string& name : in_file) names.push_back(upper(name));
  const int planes = info(request.type).channels;
  const bool has_alpha = names.size() > 1 && std::count(names.begin(), names.end(), "A") == 1;
  if (request.type == QUELL_TYPE_ALPHA && has_alpha) return find_all({"A"}, names);
  if (names.size() - (has_alpha ? 1 : 0) == static_cast<std::size_t>(planes)) {
    if (planes == 1) return {has_alpha && names[0] == "A" ? 1 : 0};
    for (const Names& usual : usual_names(planes))
      if (auto found = find_all(usual, names); !found.empty()) return found;
  }
  fail(file, in_file, request.type, "; name them with \"channels\"");
}

Size probe_image(const std::filesystem::path& file, const ImageRequest& request) {
  const ExrFile exr(file);
  select_channels(exr.channels(), request, file.string());
  return exr.size();
}

Image read_image(const std::filesystem::path& file, const ImageRequest& request, BufferPool& pool,
                 const std::function<void(const std::string&)>& note) {
  ExrFile exr(file);
  const std::vector<int> channels = select_channels(exr.channels(), request, file.string());
  try {
    Image image = request.type == QUELL_TYPE_ID ? read_ids(exr, channels[0], request, file.string(), pool)
                                                : read_floats(exr, channels, request, pool);
    const bool whole = exr.covered() == Rectangle{0, 0, image.width(), image.height()};
    if (!whole || exr.cropped()) note(file.string() + ": " + describe_window(exr));
    if (!whole) fill_outside(image, exr.covered());
    return image;
  } catch (const std::bad_alloc&) {
    throw Error(
        Fault::input, file.string(),
        "not enough memory for " + std::to_string(exr.size().width) + " x " + std::to_string(exr.size().height) + " pixels");
  }
}

}  // namespace quell
