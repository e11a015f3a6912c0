// Tests of whether a frame is read as it was meant. Pure functions: images and cameras in, findings out.
//
// Each test tells which convention is wrong by trying the others on what the file holds: where another reading agrees and the
// present one does not, the finding names it as the remedy. Inputs that are not there are passed over in silence; a test that
// needs what is not there is told as not tested, with the reason.
#pragma once

#include <vector>

#include "quell/sequence/checks/finding.h"
#include "quell/sequence/checks/frame_data.h"

namespace quell {

/// Subjects, as they are told.
inline constexpr const char* kSizesSubject = "sizes agree";
inline constexpr const char* kCameraSubject = "the camera's matrices belong together";
inline constexpr const char* kPositionSubject = "positions land on their pixels";
inline constexpr const char* kDepthSubject = "depth agrees with positions";
inline constexpr const char* kMotionSubject = "motion agrees with the matrices";
inline constexpr const char* kSkyMotionSubject = "motion of the background";
inline constexpr const char* kNormalLengthSubject = "normals are unit";
inline constexpr const char* kNormalSurfaceSubject = "normals stand on the surfaces";
inline constexpr const char* kNormalFacingSubject = "normals face the camera";
inline constexpr const char* kIdSubject = "ids are objects";
inline constexpr const char* kBackgroundSubject = "the id of the background";
inline constexpr const char* kColorSubject = "color is radiance";
inline constexpr const char* kAlphaSubject = "alpha";
inline constexpr const char* kAlbedoSubject = "albedo is a reflectance";
inline constexpr const char* kFiniteSubject = "numbers are finite";

/// A surface point may lie anywhere in its pixel, 0.5 px from the center along an axis; 0.1 px more are left for pixel filters
/// that reach beyond the pixel and for positions in half precision.
inline constexpr double kLandingTolerance = 0.6;

/// All inputs and the camera are of one size.
std::vector<Finding> check_sizes(const FrameData& frame);
/// The camera stands where its projection has depth 0, and looks along the axis that both matrices tell.
std::vector<Finding> check_camera(const FrameData& frame);
/// The camera projects each surface point into its pixel: the distance from the pixel's center along x or y, whichever is larger.
std::vector<Finding> check_positions(const FrameData& frame);
/// Depth is the projection's w, to 0.2 %; else the distance from the camera, or 1 / w.
std::vector<Finding> check_depth(const FrameData& frame);
/// A surface point of object i was at P_i * C_i^-1 * p in the frame before (P_i and C_i: the object's matrix then and now);
/// where it was seen then, minus where it is seen now, is its motion. Points of the background lie at infinity.
std::vector<Finding> check_motion(const FrameData& frame);
/// Stored normals are of unit length, perpendicular to what neighboring positions span, and turned to the camera.
std::vector<Finding> check_normals(const FrameData& frame);
/// Objects have matrices, and the background is where no other input has a surface.
std::vector<Finding> check_ids(const FrameData& frame);
/// Color and albedo are not negative, not all zero, not for a display, and color is 0 where alpha is.
std::vector<Finding> check_color(const FrameData& frame);
/// Counts NaN and infinity in what the files hold.
std::vector<Finding> check_finite(const FrameData& frame);

/// Reads the input anew, as the remedy has it. Needs its stored image.
void apply(const Remedy& remedy, FrameData& frame);

/// All of these. What a test finds a remedy for, is mended for those that follow, so that one mistake is told once.
std::vector<Finding> check_frame(const FrameData& frame);

}  // namespace quell
