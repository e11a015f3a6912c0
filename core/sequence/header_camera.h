// Cameras from the header of an image: the attributes worldToCamera and worldToNDC.
//
// OpenEXR's ImfStandardAttributes.h defines a left-handed camera space, x to the right, y up and z ahead, and NDC of (0, 0) in
// the upper left corner of the display window and (1, 1) in the lower right one; its library multiplies row vectors. Writers
// differ:
//  - Mantra (Houdini): row vectors, -1 to 1, y up, w below 0 in front (a 1280 x 720 rendering's header, in the log of
//    ynput/ayon-houdini issue 76; header_camera_test.cpp holds it).
//  - RenderMan, Arnold: row vectors, z ahead; a script for Nuke that reads such files, ExrToCameraRaw.py, expects -1 to 1, y up.
//  - pbrt-v4: column vectors, 0 to 1 across the shorter side, y up (Image::WriteEXR and ProjectiveCamera::InitMetadata).
//  - V-Ray (cameraTransform, cameraFov) and Redshift (rs/camera/...) write attributes of their own, which are not read.
// So which it is, is found out from what the files hold.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "quell/image/item.h"
#include "quell/sequence/conventions.h"

namespace quell {

/// What a header tells of its camera, as it stands there.
struct HeaderCamera {
  std::string file;  ///< for messages
  Size size;         ///< of the display window
  float pixel_aspect = 1;
  Matrix world_to_camera{}, world_to_ndc{};  ///< 16 numbers in the file's order
};

/// Throws Error(input) when the file has no such matrices, or numbers in them that are not finite.
HeaderCamera read_header_camera(const std::filesystem::path& file);

/// One way to understand such numbers.
struct HeaderReading {
  VectorOrder vectors = VectorOrder::row;
  NdcRange ndc = NdcRange::zero_to_one;
  YDirection y = YDirection::down;
  SignOfW w = SignOfW::positive;
  bool operator==(const HeaderReading&) const = default;
};
/// "y=up, vectors=row, ndc=-1..1, w=positive"
std::string describe(const HeaderReading& reading);

/// The camera by a reading; its world_to_screen is scaled so that w is the distance along the view axis. Throws Error(input) when
/// a matrix cannot be inverted.
Camera make_camera(const HeaderCamera& header, const HeaderReading& reading);

/// What is left of the readings after a frame was looked at.
struct HeaderReadings {
  std::vector<HeaderReading> possible;  ///< that give different cameras; empty: none fits
  std::string why;                      ///< what told them apart, for people
};

/// Positions of the header's frame, not converted.
struct HeaderPositions {
  Image image;
  Space space = Space::world;
};

/// Tells the readings that agree with what is stated apart. A world-to-camera matrix keeps the last component of a point, and the
/// camera stands in its origin: that tells the order of vectors. `positions` (of the same frame; or null) must land on their
/// pixels: half of them within 0.6 px. Without them, a camera whose axis meets the middle of the image within 2 %, by square
/// pixels within 1 %, is preferred, which tells the range, but never the direction of y, and the sign of w only of NDC from 0
/// to 1. What is stated in full is not tested. Throws Error(input) when the matrices give a camera by no reading.
HeaderReadings find_readings(const HeaderCamera& header, const Conventions& stated, const HeaderPositions* positions);

}  // namespace quell
