#include "tests/core/sequence/convention_rows.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <stdexcept>

namespace quell::test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 8, kHeight = 4;

/// The same numbers in every pixel.
std::function<void(const fs::path&)> exr(const std::vector<std::string>& channels, const std::vector<double>& numbers) {
  return [=](const fs::path& file) {
    ExrContent content{.width = kWidth, .height = kHeight, .channels = channels};
    for (int i = 0; i < kWidth * kHeight; ++i) content.pixels.insert(content.pixels.end(), numbers.begin(), numbers.end());
    make_exr(file, content);
  };
}

std::function<void(const fs::path&)> png(const std::vector<unsigned char>& numbers) {
  return [=](const fs::path& file) {
    const int channels = static_cast<int>(numbers.size());
    OIIO::ImageSpec spec(kWidth, kHeight, channels, OIIO::TypeUInt8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    std::vector<unsigned char> pixels;
    for (int i = 0; i < kWidth * kHeight; ++i) pixels.insert(pixels.end(), numbers.begin(), numbers.end());
    const auto output = OIIO::ImageOutput::create("png");
    if (!output || !output->open(file.string(), spec) || !output->write_image(OIIO::TypeUInt8, pixels.data()) || !output->close())
      throw std::runtime_error("the test cannot write " + file.string());
  };
}

// The motion of all rows: from (5, 1.5) in the frame before to (3, 2.5), y down.
const std::vector<double> kMotion = {2, -1};
// A pixel is 1/8 wide at distance 1; (0, 0) lies 3.5 pixels left of the axis, and 1.5 above it.
const double kAxis = 4, kRay = kAxis * std::sqrt(1 + (3.5 / 8) * (3.5 / 8) + (1.5 / 8) * (1.5 / 8));

double linear(double srgb) { return std::pow((srgb + 0.055) / 1.055, 2.4); }

std::vector<ConventionRow> motion_rows() {
  return {
      {"motion", "sign=previous-current", "quell, NVIDIA's denoisers", "NRD: old = new + motion", "exr", exr({"X", "Y"}, {2, -1}),
       kMotion, "sign=current-previous"},
      {"motion", "unit=uv", "Falcor's `mvec`", "Falcor: calcMotionVector()", "exr", exr({"R", "G"}, {2.0 / 8, -1.0 / 4}), kMotion,
       "unit=ndc"},
      {"motion", "unit=uv:sign=current-previous", "Unity", "Unity: FragMotionVectors()", "exr",
       exr({"R", "G"}, {-2.0 / 8, 1.0 / 4}), kMotion, "unit=uv:sign=previous-current"},
      {"motion", "y=up", "Blender's `Vector` (X, Y)", "Cycles: primitive_motion_vector()", "exr", exr({"X", "Y"}, {2, 1}),
       kMotion, "y=down"},
      {"motion", "unit=ndc:y=up", "programs that subtract positions in clip space", "OpenGL's clip space", "exr",
       exr({"X", "Y"}, {2 * 2.0 / 8, 2 * 1.0 / 4}), kMotion, "unit=ndc:y=down"},
      {"motion", "jitter=included", "programs that subtract jittered positions",
       "the sidecar's jitter is (0.25, -0.5), then (0, 0)", "exr", exr({"X", "Y"}, {2 + 0.25, -1 - 0.5}), kMotion,
       "jitter=excluded"},
  };
}

std::vector<ConventionRow> geometry_rows() {
  return {
      {"depth", "depth=axis", "Blender", "Cycles: camera_z_depth()", "exr", exr({"Z"}, {kAxis}), {kAxis}, "depth=ray"},
      {"depth",
       "depth=ray",
       "Mitsuba 3 (`depth` of its aov integrator)",
       "Mitsuba 3: aov.cpp writes si.t",
       "exr",
       exr({"depth.T"}, {kRay}),
       {kAxis},
       "depth=axis"},
      {"depth",
       "depth=reciprocal",
       "Nuke's ScanlineRender and DepthGenerator",
       "Nuke's user guide, DepthGenerator: depth (1/Z)",
       "exr",
       exr({"depth.Z"}, {1 / kAxis}),
       {kAxis},
       "depth=axis"},
      // Camera space's x, y, z are the world's x, z, -y.
      {"normal",
       "space=camera",
       "pbrt-v4's gbuffer film",
       "pbrt-v4: GBufferFilm, \"coordinatesystem\" is \"camera\"",
       "exr",
       exr({"X", "Y", "Z"}, {0.48, 0.6, 0.64}),
       {0.48, -0.64, 0.6},
       "space=world"},
      {"position",
       "space=camera",
       "pbrt-v4's gbuffer film",
       "pbrt-v4: GBufferFilm, \"coordinatesystem\" is \"camera\"",
       "exr",
       exr({"X", "Y", "Z"}, {2, 1, -4}),
       {12, 24, 31},
       "space=world"},
      {"normal",
       "",
       "pictures of 8 bit",
       "255 (n + 1) / 2, as normal maps are written",
       "png",
       png({255, 128, 128}),
       {1, 0.0039, 0.0039},
       "encoding=signed"},
      {"normal",
       "encoding=unsigned",
       "files of float with n / 2 + 1/2",
       "the same, unrounded",
       "exr",
       exr({"X", "Y", "Z"}, {0.74, 0.18, 0.8}),
       {0.48, -0.64, 0.6},
       "encoding=signed"},
  };
}

std::vector<ConventionRow> color_rows() {
  const double value = linear(188 / 255.0), half = 51 / 255.0;
  return {
      {"color",
       "",
       "PNG",
       "the PNG specification: sRGB, alpha not premultiplied",
       "png",
       png({188, 188, 188, 51}),
       {value * half, value * half, value * half},
       "alpha=premultiplied"},
      {"color",
       "transfer=srgb:alpha=straight",
       "display-referred files of float",
       "the same numbers",
       "exr",
       exr({"R", "G", "B", "A"}, {188 / 255.0, 188 / 255.0, 188 / 255.0, half}),
       {value * half, value * half, value * half},
       "transfer=linear:alpha=straight"},
      {"albedo", "", "PNG", "the PNG specification: sRGB", "png", png({188, 188, 188}), {value, value, value}, "transfer=linear"},
  };
}

}  // namespace

const std::vector<ConventionRow>& convention_rows() {
  static const std::vector<ConventionRow> all = [] {
    std::vector<ConventionRow> rows = motion_rows();
    for (auto more : {geometry_rows(), color_rows()}) rows.insert(rows.end(), more.begin(), more.end());
    return rows;
  }();
  return all;
}

std::string convention_camera() {
  // Camera x = x - 10, y = z - 30, z = -(y - 20). Pixels: u = 4 + 8 x / w, v = 2 - 8 y / w, w = -z.
  return R"({"width": 8, "height": 4, "objects": {},
    "world_to_camera": [[1,0,0,-10],[0,0,1,-30],[0,-1,0,20],[0,0,0,1]],
    "world_to_pixel": [[8,4,0,-160],[0,2,-8,200],[0,0,0,1],[0,1,0,-20]])";
}

std::string convention_table() {
  std::string table = "| input | convention | written by | known from |\n|---|---|---|---|\n";
  for (const ConventionRow& row : convention_rows()) {
    std::string settings = row.convention.empty() ? "of " + row.extension + " files" : "`" + row.convention + "`";
    table += "| " + row.input + " | " + settings + " | " + row.writer + " | " + row.source + " |\n";
  }
  return table;
}

}  // namespace quell::test
