#include "quell/sequence/header_camera.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "quell/sequence/matrix.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr double kLanding = 0.6;     // pixels, per axis: half a pixel, and what rounding and the pixel's filter add
constexpr double kMiddle = 0.02;     // of the image's size: more than any jitter
constexpr double kSquare = 0.01;     // relative
constexpr double kStructure = 1e-4;  // relative: products of float matrices

struct Candidate {
  HeaderReading reading;
  Camera camera;
};
using Candidates = std::vector<Candidate>;

Matrix for_columns(const Matrix& numbers, VectorOrder order) { return order == VectorOrder::row ? transposed(numbers) : numbers; }

/// NDC to pixels of the display window, y down.
Matrix pixels_from_ndc(const Size& size, const HeaderReading& reading) {
  const double w = size.width, h = size.height, shorter = std::min(w, h);
  const double middle = reading.ndc == NdcRange::minus_one_to_one ? 0 : 0.5;
  const double kx = reading.ndc == NdcRange::zero_to_one ? w : reading.ndc == NdcRange::minus_one_to_one ? w / 2 : shorter;
  const double down = reading.ndc == NdcRange::zero_to_one ? h : reading.ndc == NdcRange::minus_one_to_one ? h / 2 : shorter;
  const double ky = reading.y == YDirection::up ? -down : down;
  return {kx, 0, 0, w / 2 - kx * middle, 0, ky, 0, h / 2 - ky * middle, 0, 0, 1, 0, 0, 0, 0, 1};
}

/// Camera space to the screen. Of a perspective, the last row is (0, 0, k, 0), of an orthographic camera (0, 0, 0, k).
Matrix screen_from_camera(const Camera& camera) { return product(camera.world_to_screen, inverse(camera.world_to_camera)); }

bool keeps_last_component(const Matrix& m) {
  const double scale = length(row3(m, 0)) + length(row3(m, 1)) + length(row3(m, 2));
  return length(row3(m, 3)) <= kStructure * scale && std::abs(m[15]) > 0;
}

bool stands_in_the_origin(const Camera& camera) {
  const Matrix m = screen_from_camera(camera);
  const double x = std::abs(m[12]), y = std::abs(m[13]), z = std::abs(m[14]), one = std::abs(m[15]);
  const double moved = 1 + length({camera.world_to_camera[3], camera.world_to_camera[7], camera.world_to_camera[11]});
  const bool perspective = x + y <= kStructure * z && one <= kStructure * moved * z;
  return perspective || (x + y + z) * moved <= kStructure * one;
}

/// Whether the view axis meets the middle of the image, whose pixels are as the header says.
bool is_centered(const Camera& camera, float pixel_aspect) {
  const Matrix m = screen_from_camera(camera);
  const bool perspective = std::abs(m[14]) > std::abs(m[15]);
  const std::size_t axis = perspective ? 2 : 3;
  const double w = m[12 + axis], x = m[axis] / w, y = m[4 + axis] / w;
  const bool middle = std::abs(x / camera.size.width - 0.5) <= kMiddle && std::abs(y / camera.size.height - 0.5) <= kMiddle;
  return middle && std::abs(std::abs(m[0] / m[5]) * static_cast<double>(pixel_aspect) - 1) <= kSquare;
}

/// The median distance, along the axis where it is larger, of points from the center of their pixel; infinite without points.
double landing_error(const Matrix& m, FloatImage positions) {
  constexpr int kAcross = 64;  // points looked at, each way
  std::vector<double> errors;
  for (int j = 0; j < std::min(kAcross, positions.height); ++j) {
    for (int i = 0; i < std::min(kAcross, positions.width); ++i) {
      const int x = static_cast<int>((i + 0.5) * positions.width / std::min(kAcross, positions.width));
      const int y = static_cast<int>((j + 0.5) * positions.height / std::min(kAcross, positions.height));
      const Vector3 p{positions.at(x, y, 0), positions.at(x, y, 1), positions.at(x, y, 2)};
      if (p == Vector3{} || !std::isfinite(length(p))) continue;
      const auto along = [&](std::size_t row) { return dot(row3(m, row), p) + m[4 * row + 3]; };
      const double w = along(3);
      const double error = std::max(std::abs(along(0) / w - x - 0.5), std::abs(along(1) / w - y - 0.5));
      errors.push_back(w > 0 ? error : INFINITY);
    }
  }
  if (errors.empty()) return INFINITY;
  const auto median = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), median, errors.end());
  return *median;
}

bool is_same(const Camera& a, const Camera& b) {
  return a.world_to_camera == b.world_to_camera && a.world_to_screen == b.world_to_screen;
}

/// Nothing when world-to-camera cannot be inverted, w is 0 everywhere, or, of an orthographic camera, negative.
std::optional<Camera> camera_by(const HeaderCamera& header, const HeaderReading& reading) {
  Camera camera;
  camera.size = header.size;
  camera.world_to_camera = for_columns(header.world_to_camera, reading.vectors);
  if (!is_invertible(camera.world_to_camera)) return std::nullopt;
  Matrix ndc = for_columns(header.world_to_ndc, reading.vectors);
  if (reading.w == SignOfW::negative)
    for (std::size_t i = 12; i < 16; ++i) ndc[i] = -ndc[i];
  camera.world_to_screen = product(pixels_from_ndc(header.size, reading), ndc);
  const Matrix m = screen_from_camera(camera);
  const bool perspective = std::abs(m[14]) > std::abs(m[15]);
  const double scale = perspective ? length(row3(camera.world_to_screen, 3)) : camera.world_to_screen[15];
  if (!(std::abs(scale) > 0) || (!perspective && reading.w == SignOfW::negative)) return std::nullopt;
  for (double& value : camera.world_to_screen) value /= scale;
  return camera;
}

/// All readings that agree with what is stated and give a camera, each camera once.
Candidates enumerate(const HeaderCamera& header, const Conventions& stated) {
  Candidates all;
  const auto consider = [&](const HeaderReading& reading) {
    const std::optional<Camera> camera = camera_by(header, reading);
    const auto same = [&](const Candidate& other) { return is_same(other.camera, *camera); };
    if (camera && std::none_of(all.begin(), all.end(), same)) all.push_back({reading, *camera});
  };
  const auto possible = [](const auto& stated_value, auto values) {
    return stated_value ? decltype(values){*stated_value} : values;
  };
  for (const VectorOrder vectors : possible(stated.vectors, std::vector{VectorOrder::row, VectorOrder::column}))
    for (const NdcRange ndc :
         possible(stated.ndc, std::vector{NdcRange::zero_to_one, NdcRange::minus_one_to_one, NdcRange::zero_to_one_shorter}))
      for (const YDirection y : possible(stated.y, std::vector{YDirection::down, YDirection::up}))
        for (const SignOfW w : possible(stated.w, std::vector{SignOfW::positive, SignOfW::negative}))
          consider({vectors, ndc, y, w});
  return all;
}

/// Keeps those for which `holds`, when there are any.
bool prefer(Candidates& candidates, const std::function<bool(const Candidate&)>& holds) {
  Candidates kept;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(kept), holds);
  if (kept.empty() || kept.size() == candidates.size()) return false;
  candidates = std::move(kept);
  return true;
}

[[noreturn]] void fail(const HeaderCamera& header) {
  throw Error(Fault::input, header.file,
              "the header's worldToCamera cannot be inverted, or its worldToNDC gives no picture (w is 0)");
}

std::string pixels(double number) {
  std::ostringstream text;
  text.precision(2);
  text << number << " px";
  return text.str();
}

/// Keeps those by which positions land, of these the nearest, and readings that are nearly as near.
void test_positions(Candidates& candidates, const HeaderPositions& positions, HeaderReadings& result) {
  std::vector<double> errors;
  for (const Candidate& candidate : candidates)
    errors.push_back(
        landing_error(positions.space == Space::world ? candidate.camera.world_to_screen : screen_from_camera(candidate.camera),
                      positions.image.floats()));
  const double best = errors.empty() ? INFINITY : *std::min_element(errors.begin(), errors.end());
  Candidates kept;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (errors[i] <= std::min(kLanding, std::max(2 * best, 1e-3))) kept.push_back(candidates[i]);
  candidates = std::move(kept);
  result.why = candidates.empty()
                   ? "by none of them positions land on their pixels (at best half of them within " + pixels(best) + ")"
                   : "positions land on their pixels (half of them within " + pixels(best) + ")";
}

bool has_surface(FloatImage positions) {
  for (int y = 0; y < positions.height; ++y)
    for (int x = 0; x < positions.width; ++x)
      if (positions.at(x, y, 0) != 0 || positions.at(x, y, 1) != 0 || positions.at(x, y, 2) != 0) return true;
  return false;
}

}  // namespace

std::string describe(const HeaderReading& reading) {
  return describe(Conventions{.y = reading.y, .vectors = reading.vectors, .ndc = reading.ndc, .w = reading.w});
}

Camera make_camera(const HeaderCamera& header, const HeaderReading& reading) {
  if (auto camera = camera_by(header, reading)) return *camera;
  fail(header);
}

HeaderReadings find_readings(const HeaderCamera& header, const Conventions& stated, const HeaderPositions* positions) {
  HeaderReadings result{{}, "as stated"};
  Candidates candidates = enumerate(header, stated);
  if (candidates.empty()) fail(header);
  if (candidates.size() > 1) {
    result.why = "by the matrices' form";
    prefer(candidates, [](const Candidate& c) { return keeps_last_component(c.camera.world_to_camera); });
    prefer(candidates, [](const Candidate& c) { return stands_in_the_origin(c.camera); });
  }
  if (candidates.size() > 1 && positions && has_surface(positions->image.floats()))
    test_positions(candidates, *positions, result);
  else if (candidates.size() > 1)
    prefer(candidates, [&](const Candidate& c) { return is_centered(c.camera, header.pixel_aspect); });
  for (const Candidate& candidate : candidates) result.possible.push_back(candidate.reading);
  return result;
}

}  // namespace quell
