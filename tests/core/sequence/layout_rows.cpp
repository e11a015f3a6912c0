#include "tests/core/sequence/layout_rows.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstring>
#include <fstream>

namespace quell::test {
namespace {

using Channels = std::vector<TwoPixels>;
constexpr double kNoId = 4294967295.0;

void blender(const TempFolder& folder) {
  make_channels(folder / "shot.0001.exr", {{"ViewLayer.Combined.R", 1, 2},
                                           {"ViewLayer.Combined.G", 3, 4},
                                           {"ViewLayer.Combined.B", 5, 6},
                                           {"ViewLayer.Combined.A", 1, 0.5},
                                           {"ViewLayer.Denoising Albedo.R", .1, 0},
                                           {"ViewLayer.Denoising Albedo.G", .2, 0},
                                           {"ViewLayer.Denoising Albedo.B", .3, 0},
                                           {"ViewLayer.Denoising Normal.X", 9, 9},
                                           {"ViewLayer.Denoising Normal.Y", 9, 9},
                                           {"ViewLayer.Denoising Normal.Z", 9, 9},
                                           {"ViewLayer.Denoising Depth.Z", 9, 9},
                                           {"ViewLayer.Depth.Z", 7, 1e10},
                                           {"ViewLayer.Emit.R", 0, 8},
                                           {"ViewLayer.Emit.G", 0, 8},
                                           {"ViewLayer.Emit.B", 0, 8},
                                           {"ViewLayer.IndexOB.X", 3, 0},
                                           {"ViewLayer.Normal.X", 0, 0},
                                           {"ViewLayer.Normal.Y", 2, 0},
                                           {"ViewLayer.Normal.Z", 0, 0},
                                           {"ViewLayer.Position.X", 1, 0},
                                           {"ViewLayer.Position.Y", 2, 0},
                                           {"ViewLayer.Position.Z", 3, 0},
                                           {"ViewLayer.Vector.X", 1.5, 2},
                                           {"ViewLayer.Vector.Y", 4, -8},
                                           {"ViewLayer.Vector.Z", 9, 9},
                                           {"ViewLayer.Vector.W", 9, 9}});
}

void blender_denoised(const TempFolder& folder) {
  Channels channels;
  for (const char* layer : {"RenderLayer.Combined.", "RenderLayer.Noisy Image."})
    for (const char* channel : {"R", "G", "B"})
      channels.push_back({std::string(layer) + channel, layer[12] == 'N' ? 5.0 : 4.0, layer[12] == 'N' ? 6.0 : 4.0});
  make_channels(folder / "old_0001.exr", channels);
}

void arnold(const TempFolder& folder) {
  make_channels(folder / "arnold.0001.exr", {{"R", 1, 2},
                                             {"G", 3, 4},
                                             {"B", 5, 6},
                                             {"A", 1, 1},
                                             {"N.X", 0, 1},
                                             {"N.Y", 1, 0},
                                             {"N.Z", 0, 0},
                                             {"P.X", 1, 4},
                                             {"P.Y", 2, 5},
                                             {"P.Z", 3, 6},
                                             {"Z", 7, 8},
                                             {"diffuse_albedo.R", .1, .2},
                                             {"albedo.R", .5, .6},
                                             {"albedo.G", .5, .6},
                                             {"albedo.B", .5, .6},
                                             {"diffuse_albedo.G", .1, .2},
                                             {"diffuse_albedo.B", .1, .2}});
}

void arnold_id(const TempFolder& folder) { make_channels(folder / "ids.0001.exr", {{"ID", 12, 4000000000.0}}, "uint"); }

void pbrt(const TempFolder& folder) {
  make_channels(folder / "pbrt.0001.exr",
                {{"R", 1, 2},          {"G", 3, 4},    {"B", 5, 6},    {"Albedo.R", .5, .6}, {"Albedo.G", .5, .6},
                 {"Albedo.B", .5, .6}, {"P.X", 1, 4},  {"P.Y", 2, 5},  {"P.Z", 3, 6},        {"N.X", 0, 0},
                 {"N.Y", 0, 0},        {"N.Z", 1, 1},  {"Ns.X", 1, 0}, {"Ns.Y", 0, 1},       {"Ns.Z", 0, 0},
                 {"dzdx", 0, 0},       {"dzdy", 0, 0}, {"u", 0, 0},    {"v", 0, 0},          {"Variance.R", 1, 1}});
  make_turned_camera(folder / "camera.0001.json");
}

void pbrt_old(const TempFolder& folder) {
  make_channels(folder / "pbrt.0001.exr", {{"R", 1, 2},
                                           {"G", 3, 4},
                                           {"B", 5, 6},
                                           {"Px", 1, 4},
                                           {"Py", 2, 5},
                                           {"Pz", 3, 6},
                                           {"Nsx", 1, 0},
                                           {"Nsy", 0, 1},
                                           {"Nsz", 0, 0},
                                           {"dzdx", 0, 0},
                                           {"dzdy", 0, 0}});
  make_turned_camera(folder / "camera.0001.json");
}

void mitsuba(const TempFolder& folder) {
  make_channels(folder / "mitsuba.0001.exr", {{"my_image.R", 1, 2},
                                              {"my_image.G", 3, 4},
                                              {"my_image.B", 5, 6},
                                              {"my_image.A", 1, 1},
                                              {"dd.y.T", 5, 10},
                                              {"nn.X", 0, 1},
                                              {"nn.Y", 1, 0},
                                              {"nn.Z", 0, 0},
                                              {"position.X", 1, 4},
                                              {"position.Y", 2, 5},
                                              {"position.Z", 3, 6},
                                              {"shape_index.I", 2, 3},
                                              {"albedo.R", .5, .6},
                                              {"albedo.G", .5, .6},
                                              {"albedo.B", .5, .6}});
  make_turned_camera(folder / "camera.0001.json");
}

void renderman(const TempFolder& folder) {
  make_channels(folder / "renderman.0001.exr", {{"Ci.r", 1, 2},
                                                {"Ci.g", 3, 4},
                                                {"Ci.b", 5, 6},
                                                {"Ci.a", 1, 0.5},
                                                {"__Nworld.r", 0, 1},
                                                {"__Nworld.g", 1, 0},
                                                {"__Nworld.b", 0, 0},
                                                {"__Pworld.r", 1, 4},
                                                {"__Pworld.g", 2, 5},
                                                {"__Pworld.b", 3, 6},
                                                {"albedo.r", .5, .6},
                                                {"albedo.g", .5, .6},
                                                {"albedo.b", .5, .6},
                                                {"VLen", 5, 10}});
  make_turned_camera(folder / "camera.0001.json");
}

void vray(const TempFolder& folder) {
  make_channels(folder / "vray.0001.exr", {{"R", 1, 2},
                                           {"G", 3, 4},
                                           {"B", 5, 6},
                                           {"ZDepth", 7, 8},
                                           {"rawDiffuseFilter.R", .5, .6},
                                           {"rawDiffuseFilter.G", .5, .6},
                                           {"rawDiffuseFilter.B", .5, .6},
                                           {"diffuseFilter.R", .1, .2},
                                           {"diffuseFilter.G", .1, .2},
                                           {"diffuseFilter.B", .1, .2}});
}

void falcor(const TempFolder& folder) {
  const Channels vector = {{"R", 0.5, 0}, {"G", 0, 1}, {"B", 0, 0}, {"A", 1, 1}};
  make_channels(folder / "Mogwai.AccumulatePass.output.0001.exr", vector);
  make_channels(folder / "Mogwai.GBufferRT.mvec.0001.exr", vector);
  make_channels(folder / "Mogwai.GBufferRT.normW.0001.exr", {{"R", 0, 0}, {"G", 2, 0}, {"B", 0, 0}, {"A", 1, 1}});
  make_channels(folder / "Mogwai.GBufferRT.posW.0001.exr", vector);
  make_channels(folder / "Mogwai.GBufferRT.diffuseOpacity.0001.exr", vector);
  make_channels(folder / "Mogwai.GBufferRaster.linearZ.0001.exr", {{"R", 7, 8}, {"G", 1, 1}});
}

void single(const TempFolder& folder) {
  make_channels(folder / "color.0001.exr", {{"R", 1, 2}, {"G", 3, 4}, {"B", 5, 6}, {"A", 1, 1}}, "half");
  make_channels(folder / "normal.0001.exr", {{"X", 0, 0}, {"Y", 2, 0}, {"Z", 0, 0}});
  make_channels(folder / "depth.0001.exr", {{"Y", 7, 0}});
  make_channels(folder / "motion.0001.exr", {{"X", 1, 2}, {"Y", 3, 4}});
}

void course(const TempFolder& folder) {
  make_channels(folder / "beauty_1.exr", {{"R", 1, 2}, {"G", 3, 4}, {"B", 5, 6}});
  make_channels(folder / "ID_1.exr", {{"Y", 3, -1}});
}

template <class Value>
void make_picture(const std::filesystem::path& file, const char* format, const std::vector<Value>& pixels) {
  const int channels = static_cast<int>(pixels.size() / 2);
  OIIO::ImageSpec spec(2, 1, channels, OIIO::BaseTypeFromC<Value>::value);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const auto output = OIIO::ImageOutput::create(format);
  if (!output->open(file.string(), spec) || !output->write_image(OIIO::BaseTypeFromC<Value>::value, pixels.data()) ||
      !output->close())
    throw std::runtime_error("the test cannot write " + file.string() + ": " + output->geterror());
}

void png8(const TempFolder& folder) {
  make_picture<std::uint8_t>(folder / "color.0001.png", "png", {255, 0, 128, 255, 255, 255, 255, 0});
}
void png8_normal(const TempFolder& folder) {
  make_picture<std::uint8_t>(folder / "normal.0001.png", "png", {255, 128, 128, 128, 0, 128});
}
void png16_id(const TempFolder& folder) { make_picture<std::uint16_t>(folder / "id.0001.png", "png", {7, 65535}); }
void tiff16(const TempFolder& folder) {
  make_picture<std::uint16_t>(folder / "albedo.0001.tif", "tiff", {0, 65535, 0, 65535, 0, 65535});
}
void tiff_float(const TempFolder& folder) { make_picture<float>(folder / "position.0001.tiff", "tiff", {1, 2, 3, -4, 5, 6}); }
void hdr(const TempFolder& folder) { make_picture<float>(folder / "color.0001.hdr", "hdr", {1, 2, 4, 0.5F, 0.25F, 0}); }
void pfm(const TempFolder& folder) {
  std::ofstream file(folder / "depth.0001.pfm", std::ios::binary);
  file << "Pf\n2 1\n-1.0\n";
  for (const float value : {7.0F, 8.0F}) file.write(reinterpret_cast<const char*>(&value), 4);
}

/// (n / 255) by the sRGB curve.
double linear(int n) {
  const double v = n / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::vector<LayoutRow> rows_of_renderers() {
  const double slant = std::sqrt(1.25);  // a ray's length for one unit along the axis, in both pixels
  const std::string blender_vector = "ViewLayer.Vector: X,Y (Blender)  sign=previous-current, unit=pixels, y=up, jitter=excluded";
  return {
      {"BlenderColor",
       "Blender",
       "`ViewLayer.Combined` R,G,B,A",
       "color",
       "ViewLayer.Combined: R,G,B (Blender)",
       blender,
       "shot.####.exr",
       {1, 2, 3, 4, 5, 6}},
      {"BlenderNoisy",
       "Blender, with its denoiser",
       "`Noisy Image` R,G,B, before `Combined`",
       "color",
       "RenderLayer.Noisy Image: R,G,B (Blender)",
       blender_denoised,
       "old_0001.exr",
       {5, 6, 5, 6, 5, 6}},
      {"BlenderAlbedo",
       "Blender",
       "`Denoising Albedo` R,G,B",
       "albedo",
       "(Blender)",
       blender,
       "shot.%04d.exr",
       {.1, 0, .2, 0, .3, 0}},
      {"BlenderEmission", "Blender", "`Emit` R,G,B", "emission", "(Blender)", blender, "", {0, 8, 0, 8, 0, 8}},
      {"BlenderNormal",
       "Blender",
       "`Normal` X,Y,Z (not `Denoising Normal`)",
       "normal",
       "ViewLayer.Normal: X,Y,Z (Blender)",
       blender,
       "shot.0001.exr",
       {0, 0, 1, 0, 0, 0}},
      {"BlenderPosition", "Blender", "`Position` X,Y,Z", "position", "(Blender)", blender, "", {1, 0, 2, 0, 3, 0}},
      {"BlenderDepth", "Blender", "`Depth` Z", "depth", "ViewLayer.Depth: Z (Blender)", blender, "", {7, 1e10}},
      {"BlenderMotion",
       "Blender",
       "`Vector` X,Y,Z,W (X,Y: to the frame before)",
       "motion",
       blender_vector,
       blender,
       "",
       {1.5, 2, -4, 8}},
      {"BlenderId", "Blender", "`IndexOB` X", "id", "background=0", blender, "", {3, kNoId}},
      {"ArnoldColor", "Arnold", "R,G,B,A", "color", "R,G,B", arnold, "arnold.####.exr", {1, 2, 3, 4, 5, 6}},
      {"ArnoldNormal", "Arnold", "`N` X,Y,Z", "normal", "N: X,Y,Z (Arnold)", arnold, "", {0, 1, 1, 0, 0, 0}},
      {"ArnoldPosition", "Arnold", "`P` X,Y,Z", "position", "P: X,Y,Z (Arnold)", arnold, "", {1, 4, 2, 5, 3, 6}},
      {"ArnoldDepth", "Arnold", "Z", "depth", "Z", arnold, "", {7, 8}},
      {"ArnoldAlbedo",
       "Arnold",
       "`albedo`, else `denoise_albedo`, else `diffuse_albedo`",
       "albedo",
       "albedo: R,G,B",
       arnold,
       "",
       {.5, .6, .5, .6, .5, .6}},
      {"ArnoldId", "Arnold", "ID, uint", "id", "ID (Arnold)", arnold_id, "ids.####.exr", {12, 4000000000.0}},
      {"PbrtColor", "pbrt-v4, GBufferFilm", "R,G,B", "color", "R,G,B (pbrt)", pbrt, "pbrt.####.exr", {1, 2, 3, 4, 5, 6}},
      {"PbrtAlbedo", "pbrt-v4, GBufferFilm", "`Albedo` R,G,B", "albedo", "(pbrt)", pbrt, "", {.5, .6, .5, .6, .5, .6}},
      {"PbrtNormal",
       "pbrt-v4, GBufferFilm",
       "`Ns` X,Y,Z, else `N`",
       "normal",
       "Ns: X,Y,Z (pbrt)  space=camera",
       pbrt,
       "",
       {0, -1, 1, 0, 0, 0}},
      {"PbrtPosition",
       "pbrt-v4, GBufferFilm",
       "`P` X,Y,Z",
       "position",
       "P: X,Y,Z (pbrt)  space=camera",
       pbrt,
       "",
       {-2, -5, 1, 4, 3, 6}},
      {"OldPbrtPosition",
       "pbrt-v4, older",
       "Px,Py,Pz and Nsx,Nsy,Nsz",
       "position",
       "Px,Py,Pz (pbrt)  space=camera",
       pbrt_old,
       "",
       {-2, -5, 1, 4, 3, 6}},
      {"MitsubaColor",
       "Mitsuba 3",
       "`my_image` R,G,B,A, whatever its name when nothing else is a color",
       "color",
       "my_image: R,G,B",
       mitsuba,
       "mitsuba.####.exr",
       {1, 2, 3, 4, 5, 6}},
      {"MitsubaDepth",
       "Mitsuba 3",
       "`dd.y` T (dd.y:depth)",
       "depth",
       "dd.y: T (Mitsuba)  depth=ray",
       mitsuba,
       "",
       {5 / slant, 10 / slant}},
      {"MitsubaNormal",
       "Mitsuba 3",
       "`nn` or `sh_normal` X,Y,Z, else `geo_normal`",
       "normal",
       "nn: X,Y,Z (Mitsuba)",
       mitsuba,
       "",
       {0, 1, 1, 0, 0, 0}},
      {"MitsubaPosition", "Mitsuba 3", "`position` X,Y,Z", "position", "position: X,Y,Z", mitsuba, "", {1, 4, 2, 5, 3, 6}},
      {"MitsubaId", "Mitsuba 3", "`shape_index` I", "id", "shape_index: I (Mitsuba)", mitsuba, "", {2, 3}},
      {"RenderManColor", "RenderMan", "`Ci` r,g,b,a", "color", "Ci: r,g,b (RenderMan)", renderman, "", {1, 2, 3, 4, 5, 6}},
      {"RenderManAlbedo", "RenderMan", "`albedo` r,g,b", "albedo", "albedo: r,g,b", renderman, "", {.5, .6, .5, .6, .5, .6}},
      {"RenderManNormal",
       "RenderMan",
       "`__Nworld` r,g,b",
       "normal",
       "__Nworld: r,g,b (RenderMan)",
       renderman,
       "",
       {0, 1, 1, 0, 0, 0}},
      {"RenderManPosition",
       "RenderMan",
       "`__Pworld` r,g,b",
       "position",
       "__Pworld: r,g,b (RenderMan)",
       renderman,
       "",
       {1, 4, 2, 5, 3, 6}},
      {"RenderManDepth",
       "RenderMan",
       "VLen, where there is no z",
       "depth",
       "VLen (RenderMan)  depth=ray",
       renderman,
       "renderman.####.exr",
       {5 / slant, 10 / slant}},
      {"VrayAlbedo",
       "V-Ray",
       "`rawDiffuseFilter` R,G,B, else `diffuseFilter`",
       "albedo",
       "rawDiffuseFilter: R,G,B (V-Ray)",
       vray,
       "",
       {.5, .6, .5, .6, .5, .6}},
      {"VrayDepth", "V-Ray", "ZDepth", "depth", "ZDepth (V-Ray)", vray, "vray.####.exr", {7, 8}},
      {"FalcorColor",
       "Falcor, frame capture",
       "`Mogwai.AccumulatePass.output.0001.exr`",
       "color",
       "(Falcor)",
       falcor,
       "",
       {.5, 0, 0, 1, 0, 0}},
      {"FalcorMotion",
       "Falcor, frame capture",
       "`Mogwai.GBufferRT.mvec.0001.exr` R,G",
       "motion",
       "(Falcor)  sign=previous-current, unit=uv, y=down, jitter=excluded",
       falcor,
       "",
       {1, 0, 0, 1}},
      {"FalcorNormal",
       "Falcor, frame capture",
       "`...normW...`, else `...faceNormalW...`",
       "normal",
       "(Falcor)",
       falcor,
       "",
       {0, 0, 1, 0, 0, 0}},
      {"FalcorPosition", "Falcor, frame capture", "`...posW...`", "position", "(Falcor)", falcor, "", {.5, 0, 0, 1, 0, 0}},
      {"FalcorAlbedo", "Falcor, frame capture", "`...diffuseOpacity...`", "albedo", "(Falcor)", falcor, "", {.5, 0, 0, 1, 0, 0}},
      {"FalcorDepth", "Falcor, frame capture", "`...linearZ...` R", "depth", "(Falcor)", falcor, "", {7, 8}},
  };
}

std::vector<LayoutRow> rows_of_formats() {
  return {
      {"SingleColor", "any", "`color.0001.exr` R,G,B,A, half", "color", "", single, "", {1, 2, 3, 4, 5, 6}},
      {"SingleNormal", "any", "`normal.0001.exr` X,Y,Z", "normal", "", single, "", {0, 0, 1, 0, 0, 0}},
      {"SingleDepth", "any", "`depth.0001.exr` Y", "depth", "", single, "", {7, 1e10}},
      {"SingleMotion", "any", "`motion.0001.exr` X,Y", "motion", "", single, "", {1, 2, 3, 4}},
      {"CourseColor", "GAMES202 course", "`beauty_1.exr`", "color", "", course, "", {1, 2, 3, 4, 5, 6}},
      {"CourseId", "GAMES202 course", "`ID_1.exr` Y", "id", "background=-1", course, "", {3, kNoId}},
      {"PngColor",
       "any",
       "`color.0001.png`, 8 bit, straight alpha, sRGB curve",
       "color",
       "",
       png8,
       "",
       {1, 0, 0, 0, linear(128), 0}},
      {"PngNormal",
       "any",
       "`normal.0001.png`, 0 to 1",
       "normal",
       "",
       png8_normal,
       "",
       {0.99998462, 0.00392151, 0.00392151, -0.99998462, 0.00392151, 0.00392151}},
      {"PngId", "any", "`id.0001.png`, 16 bit", "id", "", png16_id, "", {7, 65535}},
      {"TiffAlbedo", "any", "`albedo.0001.tif`, 16 bit", "albedo", "", tiff16, "", {0, 1, 1, 0, 0, 1}},
      {"TiffPosition", "any", "`position.0001.tiff`, float", "position", "", tiff_float, "", {1, -4, 2, 5, 3, 6}},
      {"HdrColor", "any", "`color.0001.hdr`", "color", "", hdr, "", {1, .5, 2, .25, 4, 0}},
      {"PfmDepth", "any", "`depth.0001.pfm`", "depth", "", pfm, "", {7, 8}},
  };
}

}  // namespace

void make_channels(const std::filesystem::path& file, const Channels& channels, const std::string& format) {
  ExrContent content{.width = 2, .height = 1, .channels = {}, .format = format};
  for (const TwoPixels& channel : channels) content.channels.push_back(channel.channel);
  for (const TwoPixels& channel : channels) content.pixels.push_back(channel.left);
  for (const TwoPixels& channel : channels) content.pixels.push_back(channel.right);
  make_exr(file, content);
}

void make_turned_camera(const std::filesystem::path& file) {
  make_text(file, R"({"width": 2, "height": 1, "world_to_camera": [[0,1,0,0],[-1,0,0,0],[0,0,1,0],[0,0,0,1]],)"
                  R"( "world_to_pixel": [[0,1,1,0],[-1,0,0.5,0],[0,0,0,1],[0,0,1,0]], "objects": {}})");
}

std::vector<LayoutRow> layout_rows() {
  std::vector<LayoutRow> rows = rows_of_renderers();
  for (LayoutRow& row : rows_of_formats()) rows.push_back(std::move(row));
  for (LayoutRow& row : structure_rows()) rows.push_back(std::move(row));
  return rows;
}

std::string layout_table() {
  std::string text = "| written by | what | read as | conventions |\n|---|---|---|---|\n";
  for (const LayoutRow& row : layout_rows()) {
    const std::size_t settings = row.told.find('=');
    const std::size_t start = settings == std::string::npos ? settings : row.told.find_last_of(' ', settings);
    std::string conventions;
    if (settings != std::string::npos) conventions = start == std::string::npos ? row.told : row.told.substr(start + 1);
    text += "| " + row.renderer + " | " + row.writes + " | " + row.input + " | " + conventions + " |\n";
  }
  return text;
}

}  // namespace quell::test
