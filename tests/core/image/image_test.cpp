#include "quell/image/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdint>

#include "quell/image/item.h"
#include "quell/text/error.h"

namespace quell {
namespace {

TEST(PortTypes, AreFoundByTheirNames) {
  for (std::uint32_t i = 0; i < QUELL_TYPE_COUNT; ++i) {
    const auto type = static_cast<PortType>(i);
    EXPECT_EQ(port_type(name(type)), type);
  }
  EXPECT_FALSE(port_type("colour"));
}

TEST(PortTypes, AreListedForPeople) {
  EXPECT_EQ(describe(kColor), "color");
  EXPECT_EQ(describe(kColor | kAlbedo), "color or albedo");
  EXPECT_EQ(describe(kColor | kAlbedo | kMask), "color, albedo or mask");
  EXPECT_EQ(describe(kAnyImage), "any image");
}

// Design: rows on 64-byte boundaries, and a whole vector may be loaded from the last pixel on.
TEST(Image, HasAlignedRowsWithRoomForAVectorPastTheLastPixel) {
  BufferPool pool;
  for (const int width : {1, 15, 16, 17, 33, 512}) {
    Image image(QUELL_TYPE_COLOR, {width, 3}, pool);
    const FloatOutput view = image.writable_floats();
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < 3; ++y) {
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(view.row(y, c)) % 64, 0U);
        const auto* end = reinterpret_cast<const char*>(view.row(y, c) + width - 1) + 64;
        EXPECT_LE(end, static_cast<const char*>(image.buffer().data()) + image.bytes());
      }
    EXPECT_EQ(image.bytes(), Image::bytes_needed(QUELL_TYPE_COLOR, {width, 3}));
  }
}

TEST(Image, KeepsPlanesApart) {
  BufferPool pool;
  Image image(QUELL_TYPE_MOTION, {3, 2}, pool);
  const FloatOutput view = image.writable_floats();
  for (int c = 0; c < 2; ++c)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x) view.at(x, y, c) = static_cast<float>(100 * c + 10 * y + x);
  EXPECT_EQ(image.floats().at(2, 1, 0), 12.0F);
  EXPECT_EQ(image.floats().at(0, 0, 1), 100.0F);
  const quell_image raw = image.raw();
  EXPECT_EQ(static_cast<const float*>(raw.data)[raw.plane_stride + raw.row_stride + 2], 112.0F);
}

TEST(Image, RefusesSizesThatOnlyABrokenHeaderHas) {
  BufferPool pool;
  for (const Size size : {Size{0, 4}, Size{4, 0}, Size{-1, 4}, Size{Image::kMaxSize + 1, 1}, Size{1, 1 << 30}})
    EXPECT_THROW(Image(QUELL_TYPE_COLOR, size, pool), Error) << size.width << " x " << size.height;
  EXPECT_EQ(pool.usage().allocated, 0U);
}

TEST(Image, SaysWhichSizesArePossible) {
  BufferPool pool;
  try {
    Image(QUELL_TYPE_COLOR, {0, 4}, pool);
    FAIL();
  } catch (const Error& error) { EXPECT_STREQ(error.what(), "an image of 0 x 4 pixels; sides from 1 to 65536 are possible"); }
}

TEST(Image, RefusesWhatTheMachineCannotHold) {
  BufferPool pool;
  const Size largest{Image::kMaxSize, Image::kMaxSize};
  const auto memory = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  if (memory > Image::bytes_needed(QUELL_TYPE_COLOR, largest)) GTEST_SKIP() << "this machine could hold the largest image";
  EXPECT_THAT([&] { Image(QUELL_TYPE_COLOR, largest, pool); },
              ::testing::ThrowsMessage<Error>(
                  ::testing::StartsWith("an image of 65536 x 65536 pixels takes 48.0 GiB; this machine has ")));
  EXPECT_EQ(pool.usage().allocated, 0U);
}

TEST(Image, SharesItsPixelsWithACopyOfAnotherType) {
  BufferPool pool;
  Image color(QUELL_TYPE_COLOR, {2, 2}, pool);
  color.writable_floats().at(1, 1, 2) = 5.0F;
  const Image albedo = color.as(QUELL_TYPE_ALBEDO);
  EXPECT_EQ(albedo.type(), QUELL_TYPE_ALBEDO);
  EXPECT_EQ(albedo.floats().at(1, 1, 2), 5.0F);
  EXPECT_FALSE(color.buffer().unique());
}

TEST(Item, KnowsWhatItHolds) {
  BufferPool pool;
  const Item nothing;
  EXPECT_FALSE(nothing);
  EXPECT_EQ(Item(Image(QUELL_TYPE_DEPTH, {2, 2}, pool)).type(), QUELL_TYPE_DEPTH);
  EXPECT_EQ(Item(Camera()).type(), QUELL_TYPE_CAMERA);
  const Item values(Values{1, 2, 3});
  EXPECT_EQ(values.type(), QUELL_TYPE_VALUE);
  EXPECT_EQ(shape_of(values).value_count, 3U);
  EXPECT_EQ(values.image(), nullptr);
}

TEST(Values, AreSharedByCopies) {
  BufferPool pool;
  Values values(3, pool);
  EXPECT_EQ(values, (Values{0, 0, 0}));
  values.writable()[1] = 2;
  const Item item = values;
  EXPECT_EQ(item.values()->data(), values.data());
  EXPECT_FALSE(values.buffer().unique());
  EXPECT_EQ(values.raw().data[1], 2);
  EXPECT_EQ(values.raw().count, 3U);
}

TEST(Values, CanBeCutShort) {
  const Values values{1, 2, 3};
  EXPECT_EQ(values.first(2), (Values{1, 2}));
  EXPECT_EQ(values.first(7), values);
  EXPECT_EQ(values.first(0), Values());
  EXPECT_EQ(values.first(0).raw().count, 0U);
}

TEST(Values, MayBeEmpty) {
  BufferPool pool;
  const Item none = Values(0, pool);
  EXPECT_EQ(none.type(), QUELL_TYPE_VALUE);
  EXPECT_EQ(none.values()->size(), 0U);
  EXPECT_EQ(none.values()->begin(), none.values()->end());
  EXPECT_EQ(pool.usage().allocated, 0U);
}

TEST(CameraRecord, ListsObjectsByAscendingId) {
  Camera camera;
  camera.object_to_world[7] = {7};
  camera.object_to_world[3] = {3};
  const CameraRecord record(camera);
  ASSERT_EQ(record.raw().object_count, 2U);
  EXPECT_EQ(record.raw().object_ids[0], 3U);
  EXPECT_EQ(record.raw().object_ids[1], 7U);
  EXPECT_EQ(record.raw().object_to_world[16], 7.0);
}

}  // namespace
}  // namespace quell
