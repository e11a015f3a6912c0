#include "quell/runtime/sanitize.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class Sanitize : public ::testing::Test {
 protected:
  BufferPool pool;
  std::unique_ptr<Executor> executor = make_executor(2);
};

TEST_F(Sanitize, CountsAndReplacesWhatIsNotFinite) {
  Image image = flat_color({33, 5}, 2.0F, pool);
  image.writable_floats().at(32, 4, 2) = kNan;
  image.writable_floats().at(0, 0, 0) = kInfinity;
  image.writable_floats().at(1, 0, 0) = -kInfinity;
  image.writable_floats().at(2, 0, 0) = std::numeric_limits<float>::max();
  Item item = image;
  EXPECT_EQ(sanitize(item, *executor, pool), 3);
  EXPECT_EQ(item.image()->floats().at(32, 4, 2), 0.0F);
  EXPECT_EQ(item.image()->floats().at(0, 0, 0), 0.0F);
  EXPECT_EQ(item.image()->floats().at(2, 0, 0), std::numeric_limits<float>::max());
  EXPECT_EQ(item.image()->floats().at(5, 3, 1), 2.0F);
  EXPECT_EQ(image.floats().at(0, 0, 0), kInfinity) << "who else holds the image keeps it as it was";
}

TEST_F(Sanitize, MendsWhatNobodyElseHoldsInItsPlace) {
  Image image = flat_color({33, 5}, 2.0F, pool);
  image.writable_floats().at(32, 4, 2) = kNan;
  const void* pixels = image.buffer().data();
  Item item = std::move(image);
  EXPECT_EQ(sanitize(item, *executor, pool), 1);
  EXPECT_EQ(item.image()->buffer().data(), pixels);
  EXPECT_EQ(item.image()->floats().at(32, 4, 2), 0.0F);
  EXPECT_EQ(item.image()->floats().at(31, 4, 2), 2.0F);
  EXPECT_EQ(pool.usage().allocated, 1U);
}

TEST_F(Sanitize, LeavesNumbersThatSomebodyElseHoldsAsTheyWere) {
  Values mine{kInfinity, 1};
  Item item = mine;
  EXPECT_EQ(sanitize(item, *executor, pool), 1);
  EXPECT_EQ(*item.values(), (Values{0, 1}));
  EXPECT_EQ(mine[0], kInfinity);

  const double* place = mine.data();
  item = std::move(mine);
  EXPECT_EQ(sanitize(item, *executor, pool), 1);
  EXPECT_EQ(item.values()->data(), place);
  EXPECT_EQ(*item.values(), (Values{0, 1}));
}

TEST_F(Sanitize, HeedsStridesThatAreLargerThanUsual) {
  Image image(QUELL_TYPE_COLOR, {5, 300}, pool, 3);
  const FloatOutput pixels = image.writable_floats();
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 300; ++y)
      for (int x = 0; x < 5; ++x) pixels.at(x, y, c) = static_cast<float>(1000 * c + y);
  pixels.at(4, 299, 2) = kNan;
  Item item = image;
  EXPECT_EQ(sanitize(item, *executor, pool), 1);
  const FloatImage clean = item.image()->floats();
  EXPECT_EQ(clean.at(4, 299, 2), 0.0F);
  EXPECT_EQ(clean.at(3, 299, 2), 2299.0F);
  EXPECT_EQ(clean.at(0, 17, 1), 1017.0F);
}

TEST_F(Sanitize, TakesADepthThatIsNotFiniteForNoSurface) {
  Image depth(QUELL_TYPE_DEPTH, {2, 1}, pool);
  depth.writable_floats().at(0, 0) = kInfinity;
  depth.writable_floats().at(1, 0) = 3.0F;
  Item item = depth;
  EXPECT_EQ(sanitize(item, *executor, pool), 1);
  EXPECT_EQ(item.image()->floats().at(0, 0), 1e10F);
  EXPECT_EQ(item.image()->floats().at(1, 0), 3.0F);
}

TEST_F(Sanitize, ReplacesNumbersThatAreNotFinite) {
  Item item = Values{1e300, static_cast<double>(kNan), -2, static_cast<double>(kInfinity)};
  EXPECT_EQ(sanitize(item, *executor, pool), 2);
  EXPECT_EQ(*item.values(), (Values{1e300, 0, -2, 0}));
}

TEST_F(Sanitize, LeavesFiniteImagesAndEverythingElseAlone) {
  Image image = flat_color({4, 4}, 1.0F, pool);
  const void* pixels = image.buffer().data();
  Item item = std::move(image);
  EXPECT_EQ(sanitize(item, *executor, pool), 0);
  EXPECT_EQ(item.image()->buffer().data(), pixels);
  Item camera = Camera();
  EXPECT_EQ(sanitize(camera, *executor, pool), 0);
  Item nothing;
  EXPECT_EQ(sanitize(nothing, *executor, pool), 0);
}

}  // namespace
}  // namespace quell
