// A small scene with everything known by formulas: a camera that moves and turns, a floor, a wall, a ball that slides and turns,
// and sky above. Nothing here uses a matrix to find where a point is seen.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "quell/image/item.h"
#include "quell/sequence/checks/frame_data.h"

namespace quell::test {

using Triple = std::array<double, 3>;

/// A pinhole camera: where it stands, three unit directions, and the distance of the image plane in pixels.
struct Pinhole {
  Triple eye{}, right{}, up{}, forward{};
  double focal = 0;
  std::array<double, 2> jitter{};  ///< pixels that everything is shifted by
  Size size;

  /// Pixels, y down.
  std::array<double, 2> see(const Triple& p) const;
  std::array<double, 2> see_direction(const Triple& d) const;
  Camera record() const;  ///< looks along -z, without objects
};

struct SceneOptions {
  Size size{80, 60};
  bool still = false;              ///< camera and ball do not move
  std::array<double, 2> jitter{};  ///< of odd frames; even ones have its opposite
  bool sideways_only = false;      ///< the camera moves along its own x axis alone, and nothing turns
  double narrow = 1;               ///< times the focal length
};

/// What a pixel shows.
struct Hit {
  std::uint32_t id = 0;
  Triple position{}, normal{};
};

class Scene {
 public:
  explicit Scene(SceneOptions options = {}) : options_(options) {}

  Pinhole pinhole(int frame) const;
  Camera camera(int frame) const;  ///< with the matrices of floor (0), ball (1) and wall (2)
  std::optional<Hit> hit(int frame, int x, int y) const;
  /// Pixels, y down, previous minus current, without jitter.
  std::array<double, 2> motion(int frame, int x, int y) const;

  /// What a renderer with these conventions stores in a file, ids with 255 for the background unless stated.
  Image stored(PortType type, int frame, const Conventions& conventions) const;
  /// All inputs of a frame, stored by `truth` and read as `read_as`.
  FrameData read(int frame, const Conventions& truth, const Conventions& read_as) const;

 private:
  std::array<double, 3> value(PortType type, int frame, const Conventions& conventions, int x, int y) const;
  SceneOptions options_;
};

}  // namespace quell::test
