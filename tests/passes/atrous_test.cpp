#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

using Vec = std::array<double, 3>;

Vec pixel(const Image& image, int x, int y) {
  const FloatImage view = image.floats();
  return {view.at(x, y, 0), view.at(x, y, 1), view.at(x, y, 2)};
}
Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double square(double x) { return x * x; }

// Inputs by port; those that are not there are absent.
using Scene = std::map<std::string, Image>;

struct Case {
  std::string stops = "svgf";
  int level = 0;
  Size size{33, 17};
  std::set<std::string> without = {"depth_gradient", "blurred_variance"};
  std::map<std::string, double> params = {};  // others have the defaults below
  std::string phi_color_per_level = "quartered";

  double param(const std::string& name) const {
    static const std::map<std::string, double> kDefaults{{"sigma_z", 1},       {"eps_z", 1e-6},      {"sigma_n", 128},
                                                         {"sigma_l", 4},       {"phi_color", 1},     {"phi_normal", 0.1},
                                                         {"phi_position", 1},  {"sigma_color", 0.8}, {"sigma_normal", 0.1},
                                                         {"sigma_plane", 0.1}, {"sigma_coord", 32}};
    return params.count(name) ? params.at(name) : kDefaults.at(name);
  }
  bool has(const std::string& input) const { return without.count(input) == 0; }
};

// Repeatable noise in [0, 1).
double noise(int x, int y, int c) {
  unsigned h =
      static_cast<unsigned>(x) * 374761393u + static_cast<unsigned>(y) * 668265263u + static_cast<unsigned>(c) * 2246822519u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return static_cast<double>((h ^ (h >> 16)) & 0xffffff) / 0x1000000;
}

// A wavy surface with holes, a few fireflies, columns that face anywhere, and a step of depth in the middle.
Scene make_scene(const Case& c) {
  const auto is_hole = [](int x, int y) { return (x / 3 + y / 4) % 5 == 4; };
  const auto normal = [=](int x, int y, int k) {
    if (is_hole(x, y)) return 0.0F;
    const double a = 0.4 * noise(x / 2, y, 7) * (x % 7 == 0 ? 8 : 0.3), b = 0.7 * y + 0.2 * noise(x, y, 8);
    const Vec n{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
    return static_cast<float>(n[static_cast<std::size_t>(k)]);
  };
  const auto position = [](int x, int y, int k) {
    const Vec p{1e2 + 0.5 * x, -20 + 0.5 * y, 30 + 0.2 * std::sin(x + 0.5 * y) + 0.05 * noise(x, y, 3)};
    return static_cast<float>(p[static_cast<std::size_t>(k)]);
  };
  const auto depth = [=](int x, int y, int) {
    if (is_hole(x, y)) return QUELL_NO_SURFACE_DEPTH;
    return static_cast<float>(5 + 0.05 * x - 0.1 * y + 0.02 * noise(x, y, 4) + (3 * x > y + 50 ? 7 : 0));
  };
  const auto color = [](int x, int y, int k) {
    return static_cast<float>(2 * noise(x, y, k) + (x % 11 == 5 && y % 5 == 2 ? 40 : 0));
  };
  const auto variance = [](int x, int y, int) {
    return static_cast<float>(x % 9 == 8 ? 0 : 0.3 * noise(x, y, 5) * (y % 6 == 0 ? 1e-4 : 1));
  };
  const auto slope = [](int x, int y, int) { return static_cast<float>(0.1 * noise(x, y, 6)); };
  const std::vector<std::tuple<const char*, PortType, std::function<float(int, int, int)>>> all{
      {"color", QUELL_TYPE_COLOR, color},
      {"normal", QUELL_TYPE_NORMAL, normal},
      {"position", QUELL_TYPE_POSITION, position},
      {"depth", QUELL_TYPE_DEPTH, depth},
      {"depth_gradient", QUELL_TYPE_SCALAR, slope},
      {"variance", QUELL_TYPE_VARIANCE, variance},
      {"blurred_variance", QUELL_TYPE_VARIANCE, [&](int x, int y, int k) { return 0.5F * variance(y, x, k); }}};
  Scene scene;
  for (const auto& [name, type, value] : all)
    if (c.has(name)) scene.emplace(name, test_image(type, c.size, value));
  return scene;
}

struct Result {
  Image color, variance;
};

Result run(const Case& c, const Scene& scene, int grain = 0, int threads = 1) {
  PassTest pass("atrous");
  pass.set("level", c.level).set("stops", c.stops).set("phi_color_per_level", c.phi_color_per_level);
  for (const auto& [name, value] : c.params) pass.set(name, value);
  for (const auto& [name, image] : scene) pass.input(name, image);
  pass.grain(grain).threads(threads).run();
  return {*pass.output_item("color").image(), *pass.output_item("variance").image()};
}

bool same_bits(const Image& a, const Image& b) {
  for (int c = 0; c < a.channels(); ++c)
    for (int y = 0; y < a.height(); ++y)
      if (std::memcmp(a.floats().row(y, c), b.floats().row(y, c), static_cast<std::size_t>(a.width()) * sizeof(float)) != 0)
        return false;
  return true;
}

// The published formulas, pixel by pixel in double precision.
class Reference {
 public:
  Reference(const Case& c, const Scene& scene) : c_(c), scene_(scene) {}

  struct Filtered {
    Vec color;
    double variance;
  };
  Filtered filter(int x, int y) const {
    static constexpr double kB3[3] = {3.0 / 8, 1.0 / 4, 1.0 / 16};
    if (!counts(x, y)) return {pixel(image("color"), x, y), has("variance") ? at("variance", x, y) : 0};
    Vec color{};
    double weights = 0, variance = 0;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const int step = 1 << c_.level, qx = x + dx * step, qy = y + dy * step;
        if (!inside(qx, qy) || !counts(qx, qy)) continue;
        const double w = kB3[std::abs(dx)] * kB3[std::abs(dy)] * stop(x, y, qx, qy);
        const Vec q = pixel(image("color"), qx, qy);
        weights += w;
        for (std::size_t k = 0; k < 3; ++k) color[k] += w * q[k];
        if (has("variance")) variance += w * w * at("variance", qx, qy);
      }
    return {{color[0] / weights, color[1] / weights, color[2] / weights}, variance / square(weights)};
  }

 private:
  const Image& image(const std::string& name) const { return scene_.at(name); }
  bool has(const std::string& name) const { return scene_.count(name) == 1; }
  double at(const std::string& name, int x, int y) const { return image(name).floats().at(x, y); }
  double p(const std::string& name) const { return c_.param(name); }
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < c_.size.width && y < c_.size.height; }
  bool counts(int x, int y) const {
    if (has("normal") && dot(pixel(image("normal"), x, y), pixel(image("normal"), x, y)) == 0) return false;
    return c_.stops != "svgf" || !has("depth") || at("depth", x, y) < 1e10;
  }

  double stop(int x, int y, int qx, int qy) const {
    if (x == qx && y == qy) return 1;
    if (c_.stops == "svgf") return w_z(x, y, qx, qy) * w_n(x, y, qx, qy) * w_l(x, y, qx, qy);
    return c_.stops == "dammertz" ? dammertz(x, y, qx, qy) : joint_bilateral(x, y, qx, qy);
  }

  // Schied et al.
  double w_z(int x, int y, int qx, int qy) const {
    if (!has("depth")) return 1;
    const double explained = has("depth_gradient") ? at("depth_gradient", x, y) * std::hypot(qx - x, qy - y)
                                                   : std::abs(slope(x, y, 1, 0) * (qx - x) + slope(x, y, 0, 1) * (qy - y));
    const double z = at("depth", x, y);
    return std::exp(-std::abs(z - at("depth", qx, qy)) / (p("sigma_z") * explained + p("eps_z") * z));
  }
  // The smaller of the two differences along an axis, of those that there are.
  double slope(int x, int y, int ax, int ay) const {
    double smaller = std::numeric_limits<double>::infinity();
    for (const int side : {-1, 1}) {
      const int qx = x + side * ax, qy = y + side * ay;
      if (!inside(qx, qy) || at("depth", qx, qy) >= 1e10) continue;
      const double change = side * (at("depth", qx, qy) - at("depth", x, y));
      if (std::abs(change) < std::abs(smaller)) smaller = change;
    }
    return std::isinf(smaller) ? 0 : smaller;
  }
  double w_n(int x, int y, int qx, int qy) const {
    if (!has("normal")) return 1;
    return std::pow(std::max(0.0, dot(pixel(image("normal"), x, y), pixel(image("normal"), qx, qy))), p("sigma_n"));
  }
  double luminance(int x, int y) const { return dot(pixel(image("color"), x, y), {0.2126, 0.7152, 0.0722}); }
  double w_l(int x, int y, int qx, int qy) const {
    if (!has("variance") && !has("blurred_variance")) return 1;
    const double variance = has("blurred_variance") ? at("blurred_variance", x, y) : blurred(x, y);
    return std::exp(-std::abs(luminance(x, y) - luminance(qx, qy)) / (p("sigma_l") * std::sqrt(variance) + 1e-8));
  }
  double blurred(int x, int y) const {
    double sum = 0, weights = 0;
    for (int qy = y - 1; qy <= y + 1; ++qy)
      for (int qx = x - 1; qx <= x + 1; ++qx) {
        if (!inside(qx, qy)) continue;
        const double w = (qx == x ? 2 : 1) * (qy == y ? 2 : 1);
        sum += w * at("variance", qx, qy), weights += w;
      }
    return sum / weights;
  }

  // Dammertz et al.
  double dammertz(int x, int y, int qx, int qy) const {
    const int halvings = c_.phi_color_per_level == "same" ? 0 : c_.phi_color_per_level == "halved" ? 1 : 2;
    double e = squared("color", x, y, qx, qy) / (p("phi_color") * std::pow(0.5, halvings * c_.level));
    if (has("normal")) e += squared("normal", x, y, qx, qy) / std::pow(4.0, c_.level) / p("phi_normal");
    if (has("position")) e += squared("position", x, y, qx, qy) / p("phi_position");
    return std::exp(-e);
  }
  double squared(const std::string& name, int x, int y, int qx, int qy) const {
    const Vec d = pixel(image(name), qx, qy) - pixel(image(name), x, y);
    return dot(d, d);
  }

  // The course's. The formula is about the unit vectors that the rounded normals mean.
  double joint_bilateral(int x, int y, int qx, int qy) const {
    double e = (square(qx - x) + square(qy - y)) / (2 * square(p("sigma_coord")));
    e += squared("color", x, y, qx, qy) / (2 * square(p("sigma_color")));
    if (!has("normal")) return std::exp(-e);
    const Vec n = pixel(image("normal"), x, y), m = pixel(image("normal"), qx, qy);
    const double cosine = dot(n, m) / std::sqrt(dot(n, n) * dot(m, m));
    e += square(std::acos(std::min(1.0, std::max(-1.0, cosine)))) / (2 * square(p("sigma_normal")));
    if (!has("position")) return std::exp(-e);
    const Vec d = pixel(image("position"), qx, qy) - pixel(image("position"), x, y);
    if (dot(d, d) > 0) e += square(dot(n, d)) / dot(d, d) / (2 * square(p("sigma_plane")));
    return std::exp(-e);
  }

  const Case& c_;
  const Scene& scene_;
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* stops : {"svgf", "dammertz", "joint_bilateral"}) {
    for (const Size size : {Size{1, 1}, {2, 1}, {1, 2}, {15, 5}, {16, 4}, {17, 9}, {64, 2}, {3, 40}, {150, 3}})
      cases.push_back({.stops = stops, .size = size});
    for (const int level : {1, 2, 3, 4, 7}) cases.push_back({.stops = stops, .level = level, .size = {75, 43}});
    cases.push_back({.stops = stops, .level = 4, .size = {1100, 5}});  // more than one tile
    for (const char* input : {"normal", "position", "depth", "variance"})
      cases.push_back({.stops = stops, .without = {input, "depth_gradient", "blurred_variance"}});
    cases.push_back(
        {.stops = stops, .without = {"normal", "position", "depth", "depth_gradient", "variance", "blurred_variance"}});
    cases.push_back({.stops = stops, .level = 1, .without = {}});
  }
  const auto with = [&](const std::string& stops, const std::string& name, const std::vector<double>& values) {
    for (const double value : values) cases.push_back({.stops = stops, .level = 1, .size = {40, 20}, .params = {{name, value}}});
  };
  with("svgf", "sigma_z", {0, 0.1, 10, 1e6});
  with("svgf", "eps_z", {1e-8, 1e-3, 1});
  with("svgf", "sigma_n", {1, 2, 10.5, 63, 64, 65, 300});
  with("svgf", "sigma_l", {0, 0.1, 100, 1e6});
  for (const char* name : {"phi_color", "phi_normal", "phi_position"}) with("dammertz", name, {1e-6, 1e-2, 100, 1e12});
  for (const char* change : {"same", "halved"}) cases.push_back({.stops = "dammertz", .level = 2, .phi_color_per_level = change});
  with("joint_bilateral", "sigma_coord", {1e-3, 2, 1e6});
  with("joint_bilateral", "sigma_color", {1e-6, 1e-2, 10, 1e6});
  with("joint_bilateral", "sigma_normal", {1e-3, 0.01, 0.2, 0.21, 3, 1e3});
  with("joint_bilateral", "sigma_plane", {0.02, 1, 1e6});
  return cases;
}

// The vector units of this machine that the pass was compiled for, best first.
std::vector<std::int64_t> targets() {
  std::vector<std::int64_t> bits;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) bits.push_back(left & -left);
  return bits;
}

class AtrousOnTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

// 1e-4 is the error that the pass promises, and the budget in its kernel. The absolute part is a rounding of the brightest color.
TEST_P(AtrousOnTarget, MatchesTheFormulasInDoublePrecision) {
  const std::vector<Case> cases = all_cases();
  double worst = 0;
  for (const Case& c : cases) {
    const Scene scene = make_scene(c);
    const Result got = run(c, scene);
    const Reference reference(c, scene);
    double worst_here = 0;
    for (int y = 0; y < c.size.height; ++y)
      for (int x = 0; x < c.size.width; ++x) {
        const Reference::Filtered want = reference.filter(x, y);
        const std::string where = std::to_string(x) + "," + std::to_string(y) + " of case " + std::to_string(&c - cases.data());
        for (std::size_t k = 0; k < 3; ++k) {
          worst_here = std::max(worst_here, std::abs(pixel(got.color, x, y)[k] - want.color[k]) / (want.color[k] + 1e-2));
          ASSERT_NEAR(pixel(got.color, x, y)[k], want.color[k], 1e-4 * want.color[k] + 1e-6) << where;
        }
        ASSERT_NEAR(got.variance.floats().at(x, y), want.variance, 2e-4 * want.variance + 1e-8) << where;
      }
    if (getenv("SHOW")) printf("%s level %d case %ld %g\n", c.stops.c_str(), c.level, &c - cases.data(), worst_here);
    worst = std::max(worst, worst_here);
  }
}

TEST_P(AtrousOnTarget, GivesTheSameBitsForAnyBandsAndThreads) {
  for (const char* stops : {"svgf", "dammertz", "joint_bilateral"}) {
    const Case c{.stops = stops, .level = 2, .size = {150, 41}};
    const Scene scene = make_scene(c);
    const Result whole = run(c, scene, 41);
    for (const int grain : {1, 3, 8, 13})
      for (const int threads : {1, 3}) {
        const Result banded = run(c, scene, grain, threads);
        EXPECT_TRUE(same_bits(whole.color, banded.color)) << stops << ", " << grain << " rows, " << threads;
        EXPECT_TRUE(same_bits(whole.variance, banded.variance)) << stops << ", " << grain << " rows, " << threads;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(All, AtrousOnTarget, ::testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(atrous);
