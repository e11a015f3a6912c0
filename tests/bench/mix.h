// What the inner loops of the kernels are made of, counted from their source: the arithmetic behind GFLOP/s and the issue bound.
#pragma once

namespace quell::bench {

/// Vector operations for as many pixels as a vector has lanes.
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

  constexpr Mix operator*(int n) const {
    return {fma * n, add * n, mul * n, min_max * n, divide * n, root * n, estimate * n, shift * n, logic * n, load * n};
  }
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
/// exp2_negative(): the product with the gain, the rest of rounding, four steps of Horner's rule, and the exponent put in. That
/// is of AVX-512; other units need three operations more.
constexpr Mix kExp2{.fma = 4, .mul = 1, .shift = 2};

/// A tap of sum_taps() of passes/spatial/joint_bilateral_kernel.cpp with all four terms, distances in pixels, narrow normals.
constexpr Mix kJointBilateralMix = Mix{.load = 3} + kSub3 + kDot3 + kDotAdd3 +  // position: way, height, length
                                   Mix{.fma = 2, .mul = 2, .estimate = 1} +     // plane: their quotient, squared, and the sum
                                   Mix{.load = 4} + kSub3 + kDotAdd3 +          // color, and the distance in pixels
                                   Mix{.load = 3} + kSub3 + kDot3 + Mix{.fma = 4} +  // normal: chord, and the angle's polynomial
                                   Mix{.fma = 1} + kExp2 +
                                   Mix{.fma = 3, .add = 1, .load = 3};  // distance in the world; weight; sums

/// A pixel of filter_row() of passes/spatial/atrous_kernel.cpp with the stops of SVGF, narrow normals, a variance, and the
/// depth's gradient taken there. What gathers rows is left out, and so are exponents and weights that wait in memory.
constexpr Mix kAtrousTap = Mix{.fma = 1, .add = 1, .logic = 1, .load = 1} +  // luminance
                           Mix{.fma = 1, .add = 1, .logic = 1, .load = 1} +  // depth
                           kDotAdd3 + Mix{.fma = 3, .load = 3} +             // normal: cosine and logarithm
                           Mix{.fma = 4, .shift = 2} +                       // exp2(), of AVX-512
                           Mix{.fma = 3, .add = 1, .load = 3} + Mix{.fma = 1, .mul = 1, .load = 1};  // sums; that of the variance
constexpr Mix kAtrousPair{.fma = 4, .mul = 1, .estimate = 1, .logic = 1};  // two taps share the gain of depths
constexpr Mix kAtrousSlope{.add = 2, .logic = 13, .load = 3};
constexpr Mix kAtrousGain{.fma = 3, .add = 3, .mul = 2, .min_max = 3, .divide = 1, .root = 1, .load = 6};  // with the blur
constexpr Mix kAtrousMix = kAtrousTap * 24 + kAtrousPair * 12 + kAtrousSlope * 2 + kAtrousGain +
                           Mix{.add = 3, .mul = 1, .min_max = 1, .logic = 1, .load = 8} +  // pixel()
                           Mix{.add = 5, .mul = 9, .divide = 1, .logic = 5, .load = 8};    // the tap in the middle, the quotients

}  // namespace quell::bench
