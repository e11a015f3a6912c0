#include <cmath>
#include <span>

#include "quell/sequence/conventions.h"
#include "quell/sequence/convert.h"
#include "quell/sequence/matrix.h"
#include "quell/text/error.h"

namespace quell {
namespace {

using CameraPtr = std::shared_ptr<const Camera>;

std::span<float> row_of(FloatOutput image, int y, int plane) {
  return {image.row(y, plane), static_cast<std::size_t>(image.width)};
}

/// Calls change(pixel, x, y) for every pixel of a three-plane image: three doubles, rounded to float afterwards.
template <class Change>
void change_triples(FloatOutput image, const Change& change) {
  for (int y = 0; y < image.height; ++y) {
    float* const plane[3] = {image.row(y, 0), image.row(y, 1), image.row(y, 2)};
    for (int x = 0; x < image.width; ++x) {
      Vector3 pixel{plane[0][x], plane[1][x], plane[2][x]};
      change(pixel, x, y);
      for (std::size_t c = 0; c < 3; ++c) plane[c][x] = static_cast<float>(pixel[c]);
    }
  }
}

Size whole_size(const Image& image, const ConversionContext& context) {
  return context.whole == Size{} ? image.size() : context.whole;
}

CameraPtr require_camera(const ConversionContext& context, const std::string& what) {
  CameraPtr camera = context.camera ? context.camera(0) : nullptr;
  if (!camera) throw Error(Fault::input, context.file, what + " needs the camera of its frame, and there is none for it");
  return camera;
}

/// For what a camera says in pixels.
CameraPtr require_camera_of_size(const ConversionContext& context, const Size& size, const std::string& what) {
  CameraPtr camera = require_camera(context, what);
  const auto text = [](const Size& s) { return std::to_string(s.width) + " x " + std::to_string(s.height); };
  if (camera->size != size)
    throw Error(Fault::input, context.file,
                what + " needs a camera of the image's size: this one is of " + text(camera->size) + " pixels, the image has " +
                    text(size));
  return camera;
}

// ---------------------------------------------------------------------------------------------------------------- motion

std::array<double, 2> jitter_difference(const Size& size, const ConversionContext& context) {
  const CameraPtr now = require_camera_of_size(context, size, "motion that holds jitter");
  const CameraPtr before = context.camera(1);
  if (!before && context.note)
    context.note(
        "motion holds jitter, and some frames have no camera before them: there, the previous frame counts as one without "
        "jitter");
  const std::array<double, 2> past = before ? before->jitter : std::array<double, 2>{};
  if (before && now->jitter == std::array<double, 2>{} && past == now->jitter && context.note)
    context.note("motion is stated to hold jitter, but the cameras tell none; sidecars tell it as \"jitter\": [x, y], in pixels");
  return {past[0] - now->jitter[0], past[1] - now->jitter[1]};
}

void convert_motion(Image& image, const Conventions& conventions, const ConversionContext& context) {
  const Size whole = whole_size(image, context);
  const double sign = conventions.sign == MotionSign::current_minus_previous ? -1 : 1;
  std::array<double, 2> scale{sign, conventions.y == YDirection::up ? -sign : sign}, offset{};
  const MotionUnit unit = conventions.unit.value_or(MotionUnit::pixels);
  if (unit != MotionUnit::pixels) {
    const double across = unit == MotionUnit::uv ? 1 : 2;  // what the whole image measures
    scale[0] *= whole.width / across, scale[1] *= whole.height / across;
  }
  if (conventions.jitter == Jitter::included) offset = jitter_difference(whole, context);
  for (int plane = 0; plane < 2; ++plane) {
    const double s = scale[static_cast<std::size_t>(plane)], o = offset[static_cast<std::size_t>(plane)];
    if (s == 1 && o == 0) continue;
    for (int y = 0; y < image.height(); ++y)
      for (float& value : row_of(image.writable_floats(), y, plane)) value = static_cast<float>(s * double{value} - o);
  }
}

// ----------------------------------------------------------------------------------------------------------------- depth

/// How long a ray's part along the view axis is, of a ray of length 1.
///
/// With s0, s1 and s3 the rows of world_to_screen, a world point p = (x, y, z, 1) is seen at (u, v) when s0 p = u s3 p and s1 p =
/// v s3 p. Those are two planes through the eye, with the normals a = s0 - u n and b = s1 - v n (three numbers each, n being
/// those of s3), and the ray is where they meet: along d = a x b. s3 p grows along the view axis alone, in the direction n. So of
/// a distance along the ray, the share |n d| / (|n| |d|) goes along the axis, whichever way n and d point. Expanded, d = s0 x s1
/// + u (s1 x n) + v (n x s0), and n d = n (s0 x s1) is the same for all pixels.
///
/// An orthographic camera has n = 0; its rays are parallel to the axis, and a distance from its image plane is one along the
/// axis. In float matrices n may be rounding instead of 0. It is looked at in camera space, where the eye is the origin: the row
/// is (n, 0) of a perspective there, (0, 0, 0, 1) of an orthographic camera.
class RayToAxis {
 public:
  explicit RayToAxis(const Camera& camera, const std::string& file) {
    const Matrix& screen = camera.world_to_screen;
    const Matrix from_camera = product(screen, inverse(camera.world_to_camera));
    parallel_ = !(length(row3(from_camera, 3)) > 1e-5 * std::abs(from_camera[15]));
    const Vector3 s0 = row3(screen, 0), s1 = row3(screen, 1), n = row3(screen, 3);
    constant_ = cross(s0, s1), by_u_ = cross(s1, n), by_v_ = cross(n, s0);
    along_ = std::abs(dot(n, constant_)) / length(n);
    if (!parallel_ && !(along_ > 0))
      throw Error(Fault::input, file, "depth along rays: this frame's camera projects everything onto a line");
  }

  double operator()(double u, double v) const {
    if (parallel_) return 1;
    Vector3 d = constant_;
    for (std::size_t i = 0; i < 3; ++i) d[i] += u * by_u_[i] + v * by_v_[i];
    return along_ / length(d);
  }

 private:
  bool parallel_ = false;
  double along_ = 0;
  Vector3 constant_{}, by_u_{}, by_v_{};
};

void convert_rays(Image& image, const ConversionContext& context) {
  const CameraPtr camera = require_camera_of_size(context, whole_size(image, context), "depth along rays");
  const RayToAxis share(*camera, context.file);
  for (int y = 0; y < image.height(); ++y) {
    double u = context.x + 0.5;
    for (float& z : row_of(image.writable_floats(), y, 0)) {
      if (z != QUELL_NO_SURFACE_DEPTH) z = static_cast<float>(z * share(u, context.y + y + 0.5));
      u += 1;
    }
  }
}

void convert_depth(Image& image, const Conventions& conventions, const ConversionContext& context) {
  if (conventions.depth == DepthMeasure::reciprocal)
    for (int y = 0; y < image.height(); ++y)
      for (float& z : row_of(image.writable_floats(), y, 0)) z = static_cast<float>(1 / double{z});
  mark_no_surface(image.writable_floats());
  if (conventions.depth == DepthMeasure::ray) convert_rays(image, context);
}

// ---------------------------------------------------------------------------------------------------- normal and position

void decode(Vector3& n) {
  constexpr double kGrey = 1.0 / 255;  // 127 and 128 of 255 both mean 0
  const bool zero = n == Vector3{};
  const auto grey = [](double value) { return std::abs(value - 0.5) <= kGrey; };
  if (zero || (grey(n[0]) && grey(n[1]) && grey(n[2]))) {
    n = {};
  } else {
    for (double& value : n) value = 2 * value - 1;
  }
}

Vector3 times(const Matrix& m, const Vector3& v) { return {dot(row3(m, 0), v), dot(row3(m, 1), v), dot(row3(m, 2), v)}; }

void convert_normals(Image& image, const Conventions& conventions, const ConversionContext& context) {
  const bool encoded = conventions.encoding == Encoding::unsigned_numbers;
  const bool turned = conventions.space == Space::camera;
  // Normals are transformed by the inverse transpose; of camera-to-world, that is the transpose of world-to-camera.
  const Matrix to_world = turned ? transposed(require_camera(context, "a normal in camera space")->world_to_camera) : kIdentity;
  change_triples(image.writable_floats(), [&](Vector3& n, int, int) {
    if (encoded) decode(n);
    if (turned) n = times(to_world, n);
    const double size = length(n);
    if (!(size > 0) || !std::isfinite(size)) return;
    for (double& value : n) value /= size;
  });
}

void convert_positions(Image& image, const Conventions& conventions, const ConversionContext& context) {
  if (conventions.space != Space::camera) return;
  const Matrix to_world = inverse(require_camera(context, "a position in camera space")->world_to_camera);
  change_triples(image.writable_floats(), [&](Vector3& p, int, int) {
    if (p == Vector3{}) return;
    const double w = dot(row3(to_world, 3), p) + to_world[15];
    const Vector3 turned = times(to_world, p);
    for (std::size_t i = 0; i < 3; ++i) p[i] = (turned[i] + to_world[4 * i + 3]) / w;
  });
}

// ----------------------------------------------------------------------------------------------------------------- color

/// IEC 61966-2-1, section 5.2; negative values follow the straight part.
double linear_from_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

void convert_colors(Image& image, const Conventions& conventions, const ConversionContext& context) {
  const bool curve = conventions.transfer == Transfer::srgb;
  const bool straight = image.type() == QUELL_TYPE_COLOR && conventions.alpha == AlphaKind::straight;
  const std::optional<Image> alpha = straight && context.alpha ? context.alpha() : std::nullopt;
  if (!curve && !alpha) return;
  const FloatImage coverage = alpha ? alpha->floats() : FloatImage{};
  change_triples(image.writable_floats(), [&](Vector3& color, int x, int y) {
    for (double& value : color) {
      if (curve) value = linear_from_srgb(value);
      if (alpha) value *= coverage.at(x, y);
    }
  });
}

}  // namespace

void to_meaning(Image& image, const Conventions& conventions, const ConversionContext& context) {
  switch (image.type()) {
    case QUELL_TYPE_MOTION:
      return convert_motion(image, conventions, context);
    case QUELL_TYPE_DEPTH:
      return convert_depth(image, conventions, context);
    case QUELL_TYPE_NORMAL:
      return convert_normals(image, conventions, context);
    case QUELL_TYPE_POSITION:
      return convert_positions(image, conventions, context);
    case QUELL_TYPE_COLOR:
    case QUELL_TYPE_ALBEDO:
      return convert_colors(image, conventions, context);
    default:
      return;
  }
}

}  // namespace quell
