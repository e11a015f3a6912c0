#include "quell/sequence/contact_sheet.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

#include "quell/sequence/image_writer.h"
#include "quell/sequence/oiio.h"
#include "quell/sequence/pending_file.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr int kMargin = 12, kTitle = 24, kFoot = 22, kHeading = 34;
constexpr int kTitleSize = 15, kNoteSize = 12, kHeadingSize = 18;
constexpr Rgb kPaper{24, 24, 26};

/// A font that Debian installs, by what OpenImageIO's FreeType finds; "" when there is none.
std::string find_font() {
  for (const char* font : {"DejaVuSans", "LiberationSans-Regular", "NotoSans-Regular", "FreeSans"}) {
    OIIO::ImageBuf trial(OIIO::ImageSpec(16, 16, 3, OIIO::TypeUInt8));
    if (OIIO::ImageBufAlgo::render_text(trial, 0, 12, "a", 10, font)) return font;
    static_cast<void>(trial.geterror());  // what is not asked for is printed
  }
  return "";
}

/// An image that write_png() turns into the same bytes.
Image image_of_bytes(const std::uint8_t* bytes, int width, int height) {
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double v = static_cast<double>(i) / 255;
    linear[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  }
  BufferPool pool;
  Image image(QUELL_TYPE_COLOR, {width, height}, pool);
  const FloatOutput out = image.writable_floats();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) out.at(x, y, c) = linear[*bytes++];
  return image;
}

void write_image(const Image& image, const std::filesystem::path& file) {
  PendingFile pending(file);
  try {
    write_png({.layers = {{image, ""}}}, {}, pending.path());
  } catch (const Error& error) {
    if (error.where() != pending.path().string()) throw;
    // Speak of the name that the user knows.
    throw Error(error.fault(), file.string(), std::string(error.what()).substr(error.where().size() + 2));
  }
  pending.commit();
}

class Sheet {
 public:
  Sheet(int width, int height) : buffer_(OIIO::ImageSpec(width, height, 3, OIIO::TypeUInt8)), font_(find_font()) {
    fill(0, 0, width, height, kPaper);
  }

  bool has_font() const { return !font_.empty(); }

  void fill(int x, int y, int width, int height, Rgb color) {
    for (int row = y; row < y + height; ++row)
      for (int column = x; column < x + width; ++column) set(column, row, color);
  }

  void draw(const Raster& picture, int x, int y) {
    for (int row = 0; row < picture.height; ++row)
      for (int column = 0; column < picture.width; ++column) set(x + column, y + row, picture.at(column, row));
  }

  /// `y` is the text's base line. With `right`, the text ends at x. What is wider than `most` is cut off.
  void write(int x, int y, std::string text, int size, float gray, int most, bool right = false) {
    if (!has_font()) return;
    int width = measure(text, size);
    for (bool cut = false; width > most && text.size() > 4; cut = true) {
      text.resize(text.size() - (cut ? 4 : 1));
      while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0u) == 0x80u) text.pop_back();
      text += "...";
      width = measure(text, size);
    }
    const float color[] = {gray, gray, gray};
    OIIO::ImageBufAlgo::render_text(buffer_, right ? x - width : x, y, text, size, font_, color);
    static_cast<void>(buffer_.geterror());
  }

  Image image() const {
    const auto* const bytes = static_cast<const std::uint8_t*>(buffer_.localpixels());
    return image_of_bytes(bytes, buffer_.spec().width, buffer_.spec().height);
  }

 private:
  int measure(const std::string& text, int size) const { return OIIO::ImageBufAlgo::text_size(text, size, font_).width(); }

  void set(int x, int y, Rgb color) {
    const OIIO::ImageSpec& spec = buffer_.spec();
    if (x < 0 || y < 0 || x >= spec.width || y >= spec.height) return;
    std::copy(color.begin(), color.end(), static_cast<std::uint8_t*>(buffer_.pixeladdr(x, y)));
  }

  OIIO::ImageBuf buffer_;
  std::string font_;
};

void draw_scale(Sheet& sheet, const Panel& panel, int x, int y) {
  const int begin = x + panel.picture.width / 4, width = panel.picture.width / 2;
  for (int i = 0; i < width; ++i) {
    const auto place = static_cast<std::size_t>(i) * panel.scale.size() / static_cast<std::size_t>(width);
    sheet.fill(begin + i, y + 6, 1, 10, panel.scale[place]);
  }
  sheet.write(begin - 6, y + 16, panel.scale_begin, kNoteSize, 0.8F, panel.picture.width / 4, true);
  sheet.write(begin + width + 6, y + 16, panel.scale_end, kNoteSize, 0.8F, panel.picture.width / 4);
}

void draw_panel(Sheet& sheet, const Panel& panel, int x, int y) {
  sheet.write(x, y + kTitle - 7, panel.title, kTitleSize, 0.95F, panel.picture.width);
  sheet.draw(panel.picture, x, y + kTitle);
  const int foot = y + kTitle + panel.picture.height;
  if (!panel.scale.empty()) draw_scale(sheet, panel, x, foot);
  sheet.write(x, foot + 16, panel.note, kNoteSize, 0.7F, panel.picture.width);
}

}  // namespace

Size panel_size(Size image, int smallest, int largest) {
  double scale = 1;
  if (image.width > largest) scale = static_cast<double>(largest) / image.width;
  if (image.width < smallest) scale = std::ceil(static_cast<double>(smallest) / image.width);
  return {std::max(1, static_cast<int>(image.width * scale)), std::clamp(static_cast<int>(image.height * scale), 1, 4 * largest)};
}

void write_raster(const std::filesystem::path& file, const Raster& raster) {
  prepare_oiio();
  static_assert(sizeof(Rgb) == 3, "pixels follow each other without gaps");
  write_image(image_of_bytes(raster.pixels.front().data(), raster.width, raster.height), file);
}

bool write_contact_sheet(const std::filesystem::path& file, const std::string& heading, const std::vector<Panel>& panels,
                         int columns) {
  prepare_oiio();
  int width = 1, height = 1;
  for (const Panel& panel : panels) width = std::max(width, panel.picture.width), height = std::max(height, panel.picture.height);
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const int cell_width = width + kMargin, cell_height = kTitle + height + kFoot + kMargin;
  Sheet sheet(kMargin + columns * cell_width, kHeading + kMargin + rows * cell_height);
  sheet.write(kMargin, kHeading - 8, heading, kHeadingSize, 1, columns * cell_width);
  for (int i = 0; i < static_cast<int>(panels.size()); ++i)
    draw_panel(sheet, panels[static_cast<std::size_t>(i)], kMargin + i % columns * cell_width,
               kHeading + i / columns * cell_height);
  write_image(sheet.image(), file);
  return sheet.has_font();
}

}  // namespace quell
