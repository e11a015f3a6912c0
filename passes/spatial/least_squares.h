// Least squares of many equations in few unknowns, by Householder's QR decomposition, in double precision.
#pragma once

#include <cstddef>

namespace quell::least_squares {

inline constexpr int kMaxUnknowns = 16, kSides = 3;  ///< at most; and right-hand sides

/// Rows that a column of `equations` takes, the rest of which are zeros.
constexpr std::size_t padded(std::size_t equations) { return (equations + 15) / 16 * 16; }

/// For each right-hand side b the x that makes |A x - b| least. `columns` are those of A and then of the right-hand sides, each
/// `rows` long, a multiple of 16 that is at least `unknowns`; they are overwritten. A column that depends on those before it,
/// up to 1e-6 of its length, gets x = 0.
void solve(double* columns, std::size_t rows, int unknowns, double (&x)[kSides][kMaxUnknowns]);

}  // namespace quell::least_squares
