// Arithmetic of 4x4 matrices, in double.
#pragma once

#include <array>

#include "quell/image/item.h"

namespace quell {

using Vector3 = std::array<double, 3>;

/// Whether a matrix can be inverted in double precision.
bool is_invertible(const Matrix& m);
/// The inverse; the matrix must be invertible.
Matrix inverse(const Matrix& m);
Matrix product(const Matrix& a, const Matrix& b);
Matrix transposed(const Matrix& m);

inline double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vector3& v);
/// The first three numbers of a row.
inline Vector3 row3(const Matrix& m, std::size_t row) { return {m[4 * row], m[4 * row + 1], m[4 * row + 2]}; }

}  // namespace quell
