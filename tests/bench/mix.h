// What the inner loops of the kernels are made of, counted from their source: the arithmetic behind GFLOP/s and the issue bound.
#pragma once

namespace quell::bench {

/// Vector operations for one tap of as many pixels as a vector has lanes.
struct Mix {
  int fma = 0;       ///< multiply-add of any signs
  int add = 0;       ///< and subtract
  int mul = 0;       //
  int min_max = 0;   //
  int divide = 0;    //
  int root = 0;      ///< square root
  int estimate = 0;  ///< of a reciprocal, or of that of a square root
  int shift = 0;     ///< of integers
  int logic = 0;     ///< and, or, compare, select, absolute value
  int load = 0;      ///< of a vector, or of one value into all lanes

  constexpr int flops() const { return 2 * fma + add + mul + min_max + divide + root; }
  constexpr int operations() const { return fma + add + mul + min_max + divide + root + estimate + shift + logic; }
  constexpr Mix operator+(const Mix& o) const {
    return {fma + o.fma,   add + o.add,           mul + o.mul,     min_max + o.min_max, divide + o.divide,
            root + o.root, estimate + o.estimate, shift + o.shift, logic + o.logic,     load + o.load};
  }
};

constexpr Mix kSub3{.add = 3};
constexpr Mix kDot3{.fma = 2, .mul = 1};
constexpr Mix kDotAdd3{.fma = 3};
/// exp2_negative(): the limit, rounding, the rest, four steps of Horner's rule, and the exponent put in.
constexpr Mix kExp2{.fma = 6, .add = 1, .mul = 1, .min_max = 1, .shift = 1};

/// sum_taps() of passes/spatial/joint_bilateral_kernel.cpp with all four terms, distances in pixels, narrow normals.
constexpr Mix kJointBilateralMix = Mix{.load = 3} + kSub3 + kDot3 + kDotAdd3 +
                                   Mix{.mul = 1, .divide = 1} +         // plane: way, height, length; square and quotient
                                   Mix{.load = 4} + kSub3 + kDotAdd3 +  // color, and the distance in pixels
                                   Mix{.load = 3} + kSub3 + kDot3 + Mix{.fma = 4} +  // normal: chord, and the angle's polynomial
                                   Mix{.fma = 1, .add = 1} +                         // distance in the world, sum
                                   kExp2 + Mix{.fma = 3, .add = 1};                  // weight; sums of color and weights

}  // namespace quell::bench
