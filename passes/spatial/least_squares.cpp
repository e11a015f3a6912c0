// Golub & Van Loan, "Matrix Computations", sections 5.1 to 5.3: reflections turn the columns of A one after the other into those
// of a triangle R, and the right-hand sides with them.
#include "passes/spatial/least_squares.h"

#include <cmath>

#include "quell/sdk/plain_loop.h"

namespace quell::least_squares {
namespace {

constexpr std::size_t kLanes = 16;          // sums side by side, which the compiler makes vectors of
constexpr double kSmallestPart = 1e-6;      // of a column, that others do not explain; features have the precision of floats
constexpr double kSmallestSquare = 1e-200;  // of a column's length, below which it counts as 0

QUELL_PLAIN_LOOP double dot(const double* __restrict a, const double* __restrict b, std::size_t rows) {
  double sums[kLanes] = {};
  for (std::size_t i = 0; i < rows; i += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k) sums[k] += a[i + k] * b[i + k];
  double total = 0;
  for (const double sum : sums) total += sum;
  return total;
}

QUELL_PLAIN_LOOP double squared_length(const double* a, std::size_t rows) {
  double sums[kLanes] = {};
  for (std::size_t i = 0; i < rows; i += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k) sums[k] += a[i + k] * a[i + k];
  double total = 0;
  for (const double sum : sums) total += sum;
  return total;
}

QUELL_PLAIN_LOOP void subtract(double factor, const double* __restrict a, std::size_t rows, double* __restrict from) {
  for (std::size_t i = 0; i < rows; ++i) from[i] -= factor * a[i];
}

}  // namespace

void solve(double* columns, std::size_t rows, int unknowns, double (&x)[kSides][kMaxUnknowns]) {
  double triangle[kMaxUnknowns][kMaxUnknowns] = {};  // [column][row]
  bool is_free[kMaxUnknowns] = {};
  int rank = 0;  // columns that count are reflected into rows 0, 1, ...
  int row_of[kMaxUnknowns] = {};
  double whole[kMaxUnknowns] = {};
  const auto column = [&](int i) { return columns + static_cast<std::size_t>(i) * rows; };
  for (int i = 0; i < unknowns; ++i) whole[i] = squared_length(column(i), rows);
  for (int i = 0; i < unknowns; ++i) {
    double* v = column(i);
    for (int row = 0; row < rank; ++row) triangle[i][row] = v[row], v[row] = 0;
    const double rest = squared_length(v, rows);
    is_free[i] = rest <= kSmallestPart * kSmallestPart * whole[i] || rest <= kSmallestSquare;
    if (is_free[i]) continue;
    // The reflection that sends what is left of the column to (r, 0, 0, ...); the sign avoids cancellation.
    const double r = v[rank] > 0 ? -std::sqrt(rest) : std::sqrt(rest);
    const double squared = 2 * (rest - r * v[rank]);  // of v, once r is taken off
    v[rank] -= r;
    triangle[i][rank] = r;
    for (int j = i + 1; j < unknowns + kSides; ++j) subtract(2 * dot(v, column(j), rows) / squared, v, rows, column(j));
    row_of[i] = rank++;
  }
  for (int side = 0; side < kSides; ++side)
    for (int i = unknowns - 1; i >= 0; --i) {
      x[side][i] = 0;
      if (is_free[i]) continue;
      double rest = column(unknowns + side)[row_of[i]];
      for (int j = i + 1; j < unknowns; ++j) rest -= triangle[j][row_of[i]] * x[side][j];
      x[side][i] = rest / triangle[i][row_of[i]];
    }
}

}  // namespace quell::least_squares
