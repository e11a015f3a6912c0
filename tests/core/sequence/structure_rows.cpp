// Rows of layout_rows.h about how files are built, whoever writes them, and about the cameras in their headers.
#include <OpenImageIO/imageio.h>

#include <array>
#include <stdexcept>

#include "tests/core/sequence/layout_rows.h"

namespace quell::test {
namespace {

constexpr double kNoId = 4294967295.0;

ExrContent two_pixels(std::vector<std::string> channels, std::vector<double> pixels) {
  return {.width = 2, .height = 1, .channels = std::move(channels), .pixels = std::move(pixels)};
}

void tiled(const TempFolder& folder) {
  ExrContent content = two_pixels({"R", "G", "B"}, {1, 3, 5, 2, 4, 6});
  content.tile = 1, content.format = "half";
  make_exr(folder / "color.0001.exr", content);
}

void parts(const TempFolder& folder) {
  ExrContent beauty = two_pixels({"R", "G", "B", "A"}, {1, 3, 5, 1, 2, 4, 6, 1});
  ExrContent depth = two_pixels({"Z"}, {7, 8}), normal = two_pixels({"normal.X", "normal.Y", "normal.Z"}, {0, 1, 0, 1, 0, 0});
  beauty.part = "beauty", depth.part = "depth", normal.part = "normal";
  beauty.format = "half";
  make_parts(folder / "shot.0001.exr", {beauty, depth, normal});
}

void mixed(const TempFolder& folder) {
  OIIO::ImageSpec spec(2, 1, 5, OIIO::TypeFloat);
  spec.channelnames = {"R", "G", "B", "ID", "Z"};
  spec.channelformats = {OIIO::TypeHalf, OIIO::TypeHalf, OIIO::TypeHalf, OIIO::TypeUInt32, OIIO::TypeFloat};
  struct __attribute__((packed)) Pixel {
    std::uint16_t color[3];
    std::uint32_t id;
    float depth;
  };
  const Pixel pixels[2] = {{{0x3C00, 0x4200, 0x4500}, 4000000001U, 7},  // halves 1, 3, 5; an id that no float can hold
                           {{0x4000, 0x4400, 0x4600}, 3, 16777215}};    // 2, 4, 6; a depth that no half can hold
  const auto output = OIIO::ImageOutput::create("openexr");
  const std::string file = (folder / "shot.0001.exr").string();
  if (!output->open(file, spec) || !output->write_image(OIIO::TypeUnknown, pixels) || !output->close())
    throw std::runtime_error("the test cannot write " + file + ": " + output->geterror());
}

/// Pixels for the right half of the display window alone.
void smaller(const TempFolder& folder) {
  for (const char* name : {"color", "depth", "id"}) {
    ExrContent content{.width = 1, .height = 1, .x = 1, .full_width = 2, .full_height = 1};
    content.pixels = {8};
    if (name[0] == 'c') content.channels = {"R", "G", "B"}, content.pixels = {2, 4, 6};
    make_exr(folder / (std::string(name) + ".0001.exr"), content);
  }
}

/// A pixel more than the display window on every side.
void larger(const TempFolder& folder) {
  ExrContent content{.width = 4, .height = 3, .channels = {"R", "G", "B"}, .x = -1, .y = -1, .full_width = 2, .full_height = 1};
  content.pixels.assign(36, 99);
  const std::array<double, 6> inside{1, 3, 5, 2, 4, 6};
  std::copy(inside.begin(), inside.end(), content.pixels.begin() + 15);  // the second row's second and third pixel
  make_exr(folder / "color.0001.exr", content);
}

void names(const TempFolder& folder) {
  make_exr(folder / "shot.0001.exr", two_pixels({"Küche 1.Combined.B", "Küche 1.Combined.G", "Küche 1.Combined.R",
                                                 "Küche 1.Normal.Z", "Küche 1.Normal.X", "Küche 1.Normal.Y"},
                                                {5, 3, 1, 0, 0, 1, 6, 4, 2, 0, 1, 0}));
}

void wide_pixels(const TempFolder& folder) {
  ExrContent content = two_pixels({"R", "G", "B"}, {1, 3, 5, 2, 4, 6});
  content.pixel_aspect = 2;
  make_exr(folder / "color.0001.exr", content);
}

// The camera of the headers stands in (10, 20, 30) and looks along the world's z; x is to the right, y up. Of a point (x, y, z)
// before it, it sees x / z pixels to the right of the middle of 4 x 2 pixels, and y / z above it.
using Numbers = std::array<double, 16>;
constexpr std::array<double, 3> kEye{10, 20, 30};

/// What `rows` make of a point before the camera, made of a point of the world; for column vectors.
Numbers of_world(Numbers rows) {
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t i = 0; i < 3; ++i) rows[4 * row + 3] -= rows[4 * row + i] * kEye[i];
  return rows;
}

Numbers for_rows(const Numbers& m) {
  Numbers result;
  for (std::size_t i = 0; i < 16; ++i) result[i] = m[i % 4 * 4 + i / 4];
  return result;
}

/// Color and positions of 4 x 2 pixels with these matrices.
void make_camera_header(const TempFolder& folder, const Numbers& camera, const Numbers& ndc, bool is_pbrt = false) {
  ExrContent content{.width = 4, .height = 2, .channels = {"R", "G", "B", "P.X", "P.Y", "P.Z", is_pbrt ? "dzdx" : "A"}};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x) {
      const double z = 5 + x;
      const std::array<double, 3> origin = is_pbrt ? std::array<double, 3>{} : kEye;  // pbrt's positions are in camera space
      content.pixels.insert(content.pixels.end(), {1, 1, 1, origin[0] + (x + 0.5 - 2) * z, origin[1] + (1 - y - 0.5) * z,
                                                   origin[2] + z, is_pbrt ? 0.0 : 1.0});
    }
  content.matrices = {{"worldToCamera", camera}, {"worldToNDC", ndc}};
  make_exr(folder / "shot.0001.exr", content);
}

const Numbers kToCamera = of_world({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});

void header_of_openexr(const TempFolder& folder) {
  const Numbers ndc{0.25, 0, 0.5, 0, 0, -0.5, 0.5, 0, 0, 0, 1.01, -0.1, 0, 0, 1, 0};
  make_camera_header(folder, for_rows(kToCamera), for_rows(of_world(ndc)));
}
void header_of_renderman(const TempFolder& folder) {
  const Numbers ndc{0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.01, -0.1, 0, 0, 1, 0};
  make_camera_header(folder, for_rows(kToCamera), for_rows(of_world(ndc)));
}
void header_of_mantra(const TempFolder& folder) {
  const Numbers ndc{0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.01, -0.1, 0, 0, -1, 0};
  make_camera_header(folder, for_rows(kToCamera), for_rows(of_world(ndc)));
}
void header_of_pbrt(const TempFolder& folder) {
  const Numbers ndc{0.5, 0, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0, 1.01, -0.1, 0, 0, 1, 0};
  make_camera_header(folder, kToCamera, of_world(ndc), true);
}

LayoutRow row_of_header(const std::string& name, const std::string& writer, const std::string& reading,
                        std::function<void(const TempFolder&)> write) {
  LayoutRow row{name, writer,         "`worldToCamera`, `worldToNDC` in the header", "camera", reading, std::move(write),
                "",   {2.25, 0.75, 4}};
  row.size = {4, 2};
  return row;
}

}  // namespace

std::vector<LayoutRow> structure_rows() {
  const std::vector<double> color = {1, 2, 3, 4, 5, 6};
  LayoutRow wide{"NonSquare", "any", "pixels that are not square, which results keep", "color", "", wide_pixels, "", color};
  wide.pixel_aspect = 2;
  const std::string is_smaller = "data window within the display window: ", kitchen = "`Küche 1.Combined` B,G,R: ";
  return {
      {"Tiled", "any", "tiles instead of scan lines", "color", "", tiled, "", color},
      {"PartsColor", "any", "a part for each layer, `beauty` R,G,B,A", "color", "beauty: R,G,B", parts, "", color},
      {"PartsDepth", "any", "a part for each layer, `depth` Z", "depth", "depth: Z", parts, "", {7, 8}},
      {"PartsNormal",
       "any",
       "a part for each layer, `normal` with the channels normal.X, normal.Y, normal.Z",
       "normal",
       "normal: X,Y,Z",
       parts,
       "",
       {0, 1, 1, 0, 0, 0}},
      {"MixedColor", "any", "half, float and uint in one part: R,G,B half", "color", "R,G,B", mixed, "", color},
      {"MixedDepth", "any", "half, float and uint in one part: Z float", "depth", "Z", mixed, "", {7, 16777215}},
      {"MixedId", "any", "half, float and uint in one part: ID uint", "id", "ID", mixed, "", {4000000001.0, 3}},
      {"SmallerColor", "any", is_smaller + "the rest is black", "color", "", smaller, "", {0, 2, 0, 4, 0, 6}},
      {"SmallerDepth", "any", is_smaller + "the rest is no surface", "depth", "", smaller, "", {1e10, 8}},
      {"SmallerId", "any", is_smaller + "the rest is no object", "id", "", smaller, "", {kNoId, 8}},
      {"Larger", "any", "data window beyond the display window (overscan): cropped", "color", "", larger, "", color},
      {"Names", "any", kitchen + "spaces, any letters, any order", "color", "Küche 1.Combined: R,G,B", names, "", color},
      wide,
      row_of_header("HeaderOpenExr", "programs that follow OpenEXR's definition", "y=down, vectors=row, ndc=0..1, w=positive",
                    header_of_openexr),
      row_of_header("HeaderRenderMan", "RenderMan, Arnold (as a script for Nuke reads them)",
                    "y=up, vectors=row, ndc=-1..1, w=positive", header_of_renderman),
      row_of_header("HeaderMantra", "Houdini's Mantra", "y=up, vectors=row, ndc=-1..1, w=negative", header_of_mantra),
      row_of_header("HeaderPbrt", "pbrt-v4", "y=up, vectors=column, ndc=0..1-shorter, w=positive", header_of_pbrt),
  };
}

}  // namespace quell::test
