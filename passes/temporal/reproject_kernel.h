// The history at where pixels were one frame ago, over rows, on the vector unit of the machine. reproject.cpp makes a pass of it.
#pragma once

#include <span>

#include "quell/sdk/types.h"

namespace quell::reproject {

enum class Fetch { bilinear, nearest, truncate, catmull_rom };

/// Images of the size of the motion, and, previous ones, of the size of the history. All but the motion may be absent; a test
/// takes place when both of its guides are given.
struct Images {
  FloatImage motion;
  IdImage id, previous_id;
  FloatImage depth, previous_depth, depth_gradient, normal, previous_normal, normal_gradient, position, previous_position;
};

/// The parameters of the pass.
struct Settings {
  Fetch fetch = Fetch::bilinear;
  bool rescue = false;
  float min_weight = 0;
  float depth_slope = 0, depth_relative = 0, depth_absolute = 0;
  float normal_slope = 0, normal_absolute = 0;
  float plane_absolute = 0;
};

/// An image of the history, and where it goes to; `to` may be absent.
struct Moved {
  FloatImage from;
  FloatOutput to;
};

/// Row y of the outputs. There is at least one image of the history, and none is absent.
void reproject_row(const Images& in, const Settings& settings, std::span<const Moved> history, int y, const FloatOutput& valid,
                   const FloatOutput& rejected);

/// Row y of the outputs where there is no history at all.
void reproject_nothing(std::span<const Moved> history, int y, const FloatOutput& valid, const FloatOutput& rejected);

}  // namespace quell::reproject
