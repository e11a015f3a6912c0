#include "quell/sequence/matrix.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace quell {
namespace {

/// Gauss-Jordan elimination with the largest pivot; nothing when a pivot lies so far below the largest element that it is
/// rounding.
std::optional<Matrix> invert(Matrix a) {
  Matrix result = kIdentity;
  double largest = 0;
  for (const double value : a) largest = std::max(largest, std::abs(value));
  for (std::size_t k = 0; k < 4; ++k) {
    std::size_t pivot = k;
    for (std::size_t row = k + 1; row < 4; ++row)
      if (std::abs(a[4 * row + k]) > std::abs(a[4 * pivot + k])) pivot = row;
    if (!(std::abs(a[4 * pivot + k]) > 1e-14 * largest)) return std::nullopt;
    for (std::size_t column = 0; column < 4; ++column) {
      std::swap(a[4 * k + column], a[4 * pivot + column]);
      std::swap(result[4 * k + column], result[4 * pivot + column]);
    }
    const double scale = 1 / a[4 * k + k];
    for (std::size_t column = 0; column < 4; ++column) a[4 * k + column] *= scale, result[4 * k + column] *= scale;
    for (std::size_t row = 0; row < 4; ++row) {
      if (row == k) continue;
      const double factor = a[4 * row + k];
      for (std::size_t column = 0; column < 4; ++column) {
        a[4 * row + column] -= factor * a[4 * k + column];
        result[4 * row + column] -= factor * result[4 * k + column];
      }
    }
  }
  return result;
}

}  // namespace

bool is_invertible(const Matrix& m) { return invert(m).has_value(); }

Matrix inverse(const Matrix& m) { return invert(m).value(); }

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      for (std::size_t k = 0; k < 4; ++k) result[4 * row + column] += a[4 * row + k] * b[4 * k + column];
  return result;
}

Matrix transposed(const Matrix& m) {
  Matrix result;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column) result[4 * row + column] = m[4 * column + row];
  return result;
}

double length(const Vector3& v) { return std::sqrt(dot(v, v)); }

}  // namespace quell
