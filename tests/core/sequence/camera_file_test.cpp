#include "quell/sequence/camera_file.h"
#include "quell/sequence/matrix.h"

#include <cstring>
#include <limits>

#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::kIdentityText;
using test::message_of;
using test::sidecar_text;
using testing::HasSubstr;

/// The bytes of a .mat file that claims `count` objects and holds these matrices.
std::string mat_bytes(std::int32_t count, const std::vector<std::array<float, 16>>& matrices) {
  std::string bytes(sizeof count + matrices.size() * 64, '\0');
  std::memcpy(bytes.data(), &count, sizeof count);
  if (!matrices.empty()) std::memcpy(bytes.data() + sizeof count, matrices.data(), matrices.size() * 64);
  return bytes;
}

constexpr std::array<float, 16> kOne{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

class CameraFile : public testing::Test {
 protected:
  std::string mat_error(const std::string& bytes) {
    test::make_text(folder_ / "m.mat", bytes);
    return message_of(Fault::input, [&] { read_mat_camera(folder_ / "m.mat", {4, 3}); });
  }
  std::string json_error(const std::string& text) {
    test::make_text(folder_ / "c.json", text);
    return message_of(Fault::input, [&] { read_json_camera(folder_ / "c.json"); });
  }
  test::TempFolder folder_;
};

TEST_F(CameraFile, MatHoldsObjectsThenCameraThenScreen) {
  std::array<float, 16> object = kOne, view = kOne, screen{};
  object[3] = 5;  // moved along x
  view[11] = -2;  // camera behind the origin
  for (int i = 0; i < 16; ++i) screen[static_cast<std::size_t>(i)] = static_cast<float>(i) + 0.5F;
  test::make_text(folder_ / "m.mat", mat_bytes(2, {kOne, object, view, screen}));
  const Camera camera = read_mat_camera(folder_ / "m.mat", {4, 3});
  EXPECT_EQ(camera.size, (Size{4, 3}));
  ASSERT_EQ(camera.object_to_world.size(), 2U);
  EXPECT_EQ(camera.object_to_world.at(0), kIdentity);
  EXPECT_EQ(camera.object_to_world.at(1)[3], 5);
  EXPECT_EQ(camera.world_to_camera[11], -2);
  EXPECT_EQ(camera.world_to_screen[1], 1.5);
  EXPECT_EQ(camera.world_to_screen[15], 15.5);
}

TEST_F(CameraFile, MatOfNoObjectsIsFine) {
  test::make_text(folder_ / "m.mat", mat_bytes(0, {kOne, kOne}));
  EXPECT_TRUE(read_mat_camera(folder_ / "m.mat", {4, 3}).object_to_world.empty());
}

TEST_F(CameraFile, MatMustHaveExactlyTheSizeThatItsCountTells) {
  EXPECT_THAT(
      mat_error(mat_bytes(3, {kOne, kOne, kOne})),
      HasSubstr("m.mat: the file has 196 bytes, but claims 3 objects; that number and n + 2 matrices would be 4 + 64 (n + 2)"));
  EXPECT_THAT(mat_error(mat_bytes(0, {kOne, kOne, kOne})), HasSubstr("claims 0 objects"));
  EXPECT_THAT(mat_error(mat_bytes(-2, {})), HasSubstr("claims -2 objects"));
  EXPECT_THAT(mat_error(mat_bytes(std::numeric_limits<std::int32_t>::max(), {kOne, kOne})),
              HasSubstr("claims 2147483647 objects"));
  EXPECT_THAT(mat_error(""), HasSubstr("0 bytes"));
  EXPECT_THAT(mat_error("ab"), HasSubstr("2 bytes"));
}

TEST_F(CameraFile, MatMustBeFiniteAndInvertible) {
  std::array<float, 16> broken = kOne;
  broken[6] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(mat_error(mat_bytes(1, {kOne, broken, kOne})), HasSubstr("matrix 1 holds a number that is not finite"));
  broken[6] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(mat_error(mat_bytes(0, {kOne, broken})), HasSubstr("matrix 1 holds a number that is not finite"));
  EXPECT_THAT(mat_error(mat_bytes(0, {std::array<float, 16>{}, kOne})), HasSubstr("cannot be inverted"));
}

TEST_F(CameraFile, SidecarHoldsMatricesAndObjects) {
  test::make_text(folder_ / "c.json", R"({"scene": "x", "width": 640, "height": 360,
    "world_to_camera": [[1,0,0,2],[0,1,0,3],[0,0,1,4],[0,0,0,1]],
    "world_to_pixel": [[1,2,3,4],[5,6,7,8],[9,10,11,12],[13,14,15,16.5]],
    "objects": {"7": {"name": "box", "object_to_world": [[1,0,0,9],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}}})");
  const Camera camera = read_json_camera(folder_ / "c.json");
  EXPECT_EQ(camera.size, (Size{640, 360}));
  EXPECT_EQ(camera.world_to_camera[7], 3);
  EXPECT_EQ(camera.world_to_screen[4], 5);
  EXPECT_EQ(camera.world_to_screen[15], 16.5);
  ASSERT_EQ(camera.object_to_world.size(), 1U);
  EXPECT_EQ(camera.object_to_world.at(7)[3], 9);
}

TEST_F(CameraFile, SidecarMayHoldTheJitter) {
  std::string text = sidecar_text(4, 3);
  const auto with = [&](const std::string& jitter) { return "{\"jitter\": " + jitter + ", " + text.substr(1); };
  test::make_text(folder_ / "c.json", with("[0.25, -0.5]"));
  EXPECT_THAT(read_json_camera(folder_ / "c.json").jitter, testing::ElementsAre(0.25, -0.5));
  test::make_text(folder_ / "c.json", text);
  EXPECT_THAT(read_json_camera(folder_ / "c.json").jitter, testing::ElementsAre(0, 0));
  for (const char* wrong : {"[0.5]", "0.5", "[0, 0, 0]", "[0, \"a\"]"})
    EXPECT_THAT(json_error(with(wrong)), HasSubstr("c.json:1:12: error: expected the jitter in pixels, [x, y], found")) << wrong;
}

TEST_F(CameraFile, SidecarTellsEveryMistakeWithItsPlace) {
  const std::string message = json_error(
      "{\"width\": 0, \"world_to_camera\": [[1,2],[3,4]],\n"
      " \"objects\": {\"a\": {}, \"1\": {}, \"2\": 5, \"4294967295\": {}}}");
  EXPECT_THAT(message, HasSubstr("c.json:1:1: error: the key \"height\" is missing in this object"));
  EXPECT_THAT(message, HasSubstr("c.json:1:1: error: the key \"world_to_pixel\" is missing"));
  EXPECT_THAT(message, HasSubstr("c.json:1:11: error: expected a number of pixels, 1 to 65536, found 0"));
  EXPECT_THAT(message, HasSubstr("c.json:1:33: error: expected a matrix: 4 rows of 4 finite numbers"));
  EXPECT_THAT(message, HasSubstr("c.json:2:14: error: expected an object's index (an integer from 0), found \"a\""));
  EXPECT_THAT(message, HasSubstr("c.json:2:28: error: the key \"object_to_world\" is missing"));
  EXPECT_THAT(message, HasSubstr("c.json:2:37: error: expected an object with object_to_world"));
  EXPECT_THAT(message, HasSubstr("found \"4294967295\""));
}

TEST_F(CameraFile, SidecarMustBeJsonWithFiniteInvertibleMatrices) {
  std::string nan = sidecar_text(4, 3);
  nan.replace(nan.find("[[1,0"), 3, "[[NaN");
  EXPECT_THAT(json_error(nan), HasSubstr("c.json:1:"));
  std::string singular = sidecar_text(4, 3);
  singular.replace(singular.find("[[1,0"), 3, "[[0");
  EXPECT_THAT(json_error(singular), HasSubstr("this matrix cannot be inverted"));
  EXPECT_THAT(json_error("[1]"), HasSubstr("expected an object with world_to_camera"));
  EXPECT_THAT(json_error(""), HasSubstr("c.json"));
  EXPECT_THAT(json_error("{\"width\": 4"), HasSubstr("c.json:1:"));
}

TEST(Matrix, IsInvertibleUnlessItsRowsDepend) {
  EXPECT_TRUE(is_invertible(kIdentity));
  EXPECT_TRUE(is_invertible({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0})) << "needs pivoting";
  EXPECT_TRUE(is_invertible({1e-3, 0, 0, 1e5, 0, 1e-3, 0, 1e5, 0, 0, 1e-3, 1e5, 0, 0, 0, 1})) << "a small scale far away";
  EXPECT_FALSE(is_invertible({1, 2, 3, 4, 2, 4, 6, 8, 0, 0, 1, 0, 0, 0, 0, 1}));
  EXPECT_FALSE(is_invertible(Matrix{}));
}

TEST(Matrix, TimesItsInverseIsOne) {
  const Matrix m{0, 2, 0, 7, -1, 0.5, 3, 0, 0.1, 0, 4, -2, 0, 0.25, 1, 1};
  const Matrix left = product(inverse(m), m), right = product(m, inverse(m));
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(left[i], kIdentity[i], 1e-14);
    EXPECT_NEAR(right[i], kIdentity[i], 1e-14);
  }
  EXPECT_EQ(transposed(m)[12], m[3]);
}

}  // namespace
}  // namespace quell
