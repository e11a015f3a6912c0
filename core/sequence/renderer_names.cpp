#include "quell/sequence/renderer_names.h"

namespace quell {
namespace {

constexpr Conventions kNone{};
constexpr Conventions kCameraSpace{.space = Space::camera};
constexpr Conventions kRay{.depth = DepthMeasure::ray};
constexpr Conventions kZeroIsBackground{.background = 0};
constexpr Conventions kBlenderVector{
    .sign = MotionSign::previous_minus_current, .unit = MotionUnit::pixels, .y = YDirection::up, .jitter = Jitter::excluded};
constexpr Conventions kFalcorVector{
    .sign = MotionSign::previous_minus_current, .unit = MotionUnit::uv, .y = YDirection::down, .jitter = Jitter::excluded};

constexpr auto kColor = QUELL_TYPE_COLOR;
constexpr auto kAlbedo = QUELL_TYPE_ALBEDO;
constexpr auto kNormal = QUELL_TYPE_NORMAL;
constexpr auto kPosition = QUELL_TYPE_POSITION;
constexpr auto kDepth = QUELL_TYPE_DEPTH;
constexpr auto kId = QUELL_TYPE_ID;
constexpr auto kMotion = QUELL_TYPE_MOTION;
constexpr auto kAlpha = QUELL_TYPE_ALPHA;

// Sources. "measured": positions, matrices and vectors of a Blender 3.4.1 rendering with all passes were compared.
constexpr std::string_view kMeasured = "measured on files of Blender 3.4.1";
constexpr std::string_view kBlenderManual = "Blender's manual, render passes";
constexpr std::string_view kBlenderNoisy = "Blender's denoising passes: the image before its denoiser; not tried with a file";
constexpr std::string_view kArnoldGuide = "Arnold's developer guide, AOVs; not tried with a file";
constexpr std::string_view kPbrtSource = "pbrt-v4, film.cpp: camera space unless \"coordinatesystem\" is \"world\"";
constexpr std::string_view kMitsubaSource = "Mitsuba 3, integrators/aov.cpp";
constexpr std::string_view kRenderManManual =
    "RenderMan's manual, Denoising and Arbitrary Output Variables; not tried with a file";
constexpr std::string_view kVrayList = "V-Ray's list of render elements; not tried with a file";
constexpr std::string_view kFalcorSource = "Falcor, GBuffer.cpp and GBufferRaster.cpp";
constexpr std::string_view kCustom = "the usual names";

constexpr RendererName kNames[] = {
    // Not read: Blender's Denoising Normal (camera space with z ahead, and the mirror image's in mirrors) and Denoising Depth
    // (likewise), DiffCol (no albedo: GlossCol is missing in it).
    {"Blender", "color", kColor, "*.Noisy Image", "R,G,B", 0, kNone, "", kBlenderNoisy},
    {"Blender", "color", kColor, "Composite.Combined", "R,G,B", 5, kNone, "", kBlenderManual},
    {"Blender", "color", kColor, "*.Combined", "R,G,B", 1, kNone, "", kMeasured},
    {"Blender", "alpha", kAlpha, "Composite.Combined", "A", 5, kNone, "", kBlenderManual},
    {"Blender", "alpha", kAlpha, "*.Combined", "A", 1, kNone, "", kMeasured},
    {"Blender", "emission", kColor, "*.Emit", "R,G,B", 0, kNone, "", kMeasured},
    {"Blender", "albedo", kAlbedo, "*.Denoising Albedo", "R,G,B", 0, kNone, "", kMeasured},
    {"Blender", "normal", kNormal, "*.Normal", "X,Y,Z", 0, kNone, "", kMeasured},
    {"Blender", "position", kPosition, "*.Position", "X,Y,Z", 0, kNone, "", kMeasured},
    {"Blender", "depth", kDepth, "*.Depth", "Z", 0, kNone, "", kMeasured},
    {"Blender", "motion", kMotion, "*.Vector", "X,Y", 0, kBlenderVector, "", kMeasured},
    {"Blender", "id", kId, "*.IndexOB", "X", 0, kZeroIsBackground, "", kMeasured},

    {"pbrt", "color", kColor, "", "R,G,B", 0, kNone, "dzdx", kPbrtSource},
    {"pbrt", "albedo", kAlbedo, "Albedo", "R,G,B", 0, kNone, "dzdx", kPbrtSource},
    {"pbrt", "normal", kNormal, "Ns", "X,Y,Z", 0, kCameraSpace, "dzdx", kPbrtSource},
    {"pbrt", "normal", kNormal, "N", "X,Y,Z", 1, kCameraSpace, "dzdx", kPbrtSource},
    {"pbrt", "normal", kNormal, "", "NSX,NSY,NSZ", 0, kCameraSpace, "dzdx", kPbrtSource},
    {"pbrt", "position", kPosition, "P", "X,Y,Z", 0, kCameraSpace, "dzdx", kPbrtSource},
    {"pbrt", "position", kPosition, "", "PX,PY,PZ", 0, kCameraSpace, "dzdx", kPbrtSource},

    {"Mitsuba", "depth", kDepth, "*", "T", 0, kRay, "", kMitsubaSource},
    {"Mitsuba", "normal", kNormal, "sh_normal", "X,Y,Z", 0, kNone, "", kMitsubaSource},
    {"Mitsuba", "normal", kNormal, "nn", "X,Y,Z", 0, kNone, "", kMitsubaSource},
    {"Mitsuba", "normal", kNormal, "geo_normal", "X,Y,Z", 1, kNone, "", kMitsubaSource},
    {"Mitsuba", "id", kId, "shape_index", "I", 0, kNone, "", kMitsubaSource},

    // Not read: motionvector, since the guide tells neither its sign nor its unit.
    {"Arnold", "color", kColor, "RGBA", "R,G,B", 0, kNone, "", kArnoldGuide},
    {"Arnold", "alpha", kAlpha, "RGBA", "A", 0, kNone, "", kArnoldGuide},
    {"Arnold", "albedo", kAlbedo, "denoise_albedo", "R,G,B", 1, kNone, "", kArnoldGuide},
    {"Arnold", "albedo", kAlbedo, "diffuse_albedo", "R,G,B", 2, kNone, "", kArnoldGuide},
    {"Arnold", "normal", kNormal, "N", "X,Y,Z|R,G,B", 0, kNone, "", kArnoldGuide},
    {"Arnold", "position", kPosition, "P", "X,Y,Z|R,G,B", 0, kNone, "", kArnoldGuide},
    {"Arnold", "depth", kDepth, "Z", "*", 0, kNone, "", kArnoldGuide},
    {"Arnold", "id", kId, "", "ID", 0, kNone, "", kArnoldGuide},
    {"Arnold", "id", kId, "ID", "*", 0, kNone, "", kArnoldGuide},

    // Not read: P and Nn (the manual does not tell their space), dPdtime (leaves the camera's motion out).
    {"RenderMan", "color", kColor, "Ci", "R,G,B", 0, kNone, "", kRenderManManual},
    {"RenderMan", "alpha", kAlpha, "Ci", "A", 0, kNone, "", kRenderManManual},
    {"RenderMan", "normal", kNormal, "__Nworld", "R,G,B|X,Y,Z", 0, kNone, "", kRenderManManual},
    {"RenderMan", "position", kPosition, "__Pworld", "R,G,B|X,Y,Z", 0, kNone, "", kRenderManManual},
    {"RenderMan", "depth", kDepth, "", "VLEN", 1, kRay, "", kRenderManManual},

    // Not read: normals and velocity, since their space, sign and unit depend on settings.
    {"V-Ray", "albedo", kAlbedo, "rawDiffuseFilter", "R,G,B", 3, kNone, "", kVrayList},
    {"V-Ray", "albedo", kAlbedo, "diffuseFilter", "R,G,B", 4, kNone, "", kVrayList},
    {"V-Ray", "depth", kDepth, "ZDepth", "*", 0, kNone, "", kVrayList},
    {"V-Ray", "depth", kDepth, "", "ZDEPTH", 0, kNone, "", kVrayList},
    {"V-Ray", "id", kId, "renderID", "*", 1, kNone, "", kVrayList},
    {"V-Ray", "id", kId, "", "RENDERID", 1, kNone, "", kVrayList},

    {"any", "color", kColor, "", "R,G,B", 1, kNone, "", kCustom},
    {"any", "alpha", kAlpha, "", "A", 1, kNone, "", kCustom},
    {"any", "color", kColor, "beauty", "R,G,B", 1, kNone, "", kCustom},
    {"any", "alpha", kAlpha, "beauty", "A", 1, kNone, "", kCustom},
    {"any", "color", kColor, "rgb", "R,G,B", 1, kNone, "", kCustom},
    {"any", "depth", kDepth, "", "Z", 0, kNone, "", kCustom},
};

constexpr RendererName kFileNames[] = {
    {"Falcor", "color", kColor, "AccumulatePass.output", "R,G,B", 0, kNone, "", kFalcorSource},
    {"Falcor", "color", kColor, "PathTracer.color", "R,G,B", 1, kNone, "", kFalcorSource},
    {"Falcor", "albedo", kAlbedo, "*.diffuseOpacity", "R,G,B", 0, kNone, "", kFalcorSource},
    {"Falcor", "emission", kColor, "*.emissive", "R,G,B", 0, kNone, "", kFalcorSource},
    {"Falcor", "normal", kNormal, "*.normW", "R,G,B|X,Y,Z", 0, kNone, "", kFalcorSource},
    {"Falcor", "normal", kNormal, "*.faceNormalW", "R,G,B|X,Y,Z", 1, kNone, "", kFalcorSource},
    {"Falcor", "position", kPosition, "*.posW", "R,G,B|X,Y,Z", 0, kNone, "", kFalcorSource},
    {"Falcor", "depth", kDepth, "*.linearZ", "R|X|Y", 0, kNone, "", "Falcor, GBufferRaster.cpp; not compared with positions"},
    {"Falcor", "motion", kMotion, "*.mvec", "R,G|X,Y", 0, kFalcorVector, "", kFalcorSource},
};

}  // namespace

std::span<const RendererName> renderer_names() { return kNames; }
std::span<const RendererName> renderer_file_names() { return kFileNames; }

const std::vector<std::string>& usual_inputs() {
  static const std::vector<std::string> kInputs = {"albedo", "alpha",  "color",  "depth",    "emission",
                                                   "id",     "motion", "normal", "position", "variance"};
  return kInputs;
}

}  // namespace quell
