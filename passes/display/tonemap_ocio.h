// A display and view of OpenColorIO, made ready for planar rows.
#pragma once

#include <memory>
#include <string>

#include "quell/sdk/types.h"

namespace quell {

/// Immutable, so it may be applied from several threads at once.
class OcioView {
 public:
  /// What the parameters of `tonemap` say; empty strings take the defaults documented there.
  struct Choice {
    std::string config;
    std::string colorspace;
    std::string display;
    std::string view;
  };
  /// Throws std::runtime_error when the config cannot be read or has no such color space, display or view, with what it has.
  explicit OcioView(const Choice& choice);
  ~OcioView();

  /// Turns rows y0 to y1 - 1 of an image of 3 planes from scene-linear into the display's code values.
  void apply(const FloatOutput& image, int y0, int y1) const;

 private:
  struct Processor;
  std::unique_ptr<const Processor> processor_;
};

}  // namespace quell
