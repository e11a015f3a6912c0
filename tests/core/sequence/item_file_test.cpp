// What a run keeps comes back bit for bit.
#include "quell/sequence/item_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include "quell/text/error.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

class ItemFile : public testing::Test {
 protected:
  std::filesystem::path file(PortType type) { return folder / ("kept" + std::string(item_extension(type))); }
  Item through_file(const Item& item) {
    write_item(item, 7, file(item.type()));
    return read_item(file(item.type()), item.type(), pool);
  }
  test::TempFolder folder;
  BufferPool pool;
};

// Any 32 bits, but for NaN of the signaling kind, which loading a float may make quiet.
std::uint32_t any_bits(std::mt19937& engine) {
  const std::uint32_t bits = engine();
  const bool is_nan = (bits & 0x7f800000U) == 0x7f800000U && (bits & 0x7fffffU) != 0;
  return is_nan ? bits | 0x400000U : bits;
}

TEST_F(ItemFile, KeepsEveryBitOfImagesOfEveryType) {
  std::mt19937 engine(1);
  for (const PortType type :
       {QUELL_TYPE_COLOR, QUELL_TYPE_ALBEDO, QUELL_TYPE_NORMAL, QUELL_TYPE_POSITION, QUELL_TYPE_DEPTH, QUELL_TYPE_MOTION,
        QUELL_TYPE_MOMENTS, QUELL_TYPE_VARIANCE, QUELL_TYPE_SCALAR, QUELL_TYPE_MASK, QUELL_TYPE_ALPHA}) {
    Image image(type, {37, 71}, pool);
    const FloatOutput out = image.writable_floats();
    for (int c = 0; c < out.channels; ++c)
      for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) out.at(x, y, c) = std::bit_cast<float>(any_bits(engine));
    const Item back = through_file(image);
    ASSERT_EQ(back.type(), type);
    ASSERT_EQ(back.image()->size(), image.size());
    for (int c = 0; c < out.channels; ++c)
      for (int y = 0; y < out.height; ++y)
        EXPECT_EQ(std::memcmp(back.image()->floats().row(y, c), image.floats().row(y, c), 37 * sizeof(float)), 0)
            << name(type) << ", plane " << c << ", row " << y;
  }
}

TEST_F(ItemFile, KeepsIds) {
  Image image(QUELL_TYPE_ID, {5, 3}, pool);
  for (int x = 0; x < 5; ++x)
    for (int y = 0; y < 3; ++y) image.writable_ids().at(x, y) = x == 4 ? 0xffffffffU : 0x01000001U * static_cast<unsigned>(x + 1);
  const Item back = through_file(image);
  for (int y = 0; y < 3; ++y) EXPECT_EQ(std::memcmp(back.image()->ids().row(y), image.ids().row(y), 5 * sizeof(int)), 0);
}

TEST_F(ItemFile, KeepsValues) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Values values = {0.0, -0.0, 1.0 / 3, -1e-320, 1e308, kInfinity, -kInfinity, std::nan(""), 0.1};
  const Item back = through_file(values);
  ASSERT_EQ(back.values()->size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>((*back.values())[i]), std::bit_cast<std::uint64_t>(values[i])) << values[i];
  EXPECT_EQ(through_file(Values()).values()->size(), 0U);
}

TEST_F(ItemFile, KeepsCameras) {
  Camera camera;
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> number(-3, 3);
  for (double& element : camera.world_to_camera) element = number(engine);
  for (double& element : camera.world_to_screen) element = number(engine) * 1e-3;
  camera.world_to_screen[3] = -0.0;
  camera.size = {64, 48};
  camera.jitter = {0.1, -0.0};
  camera.object_to_world[3][7] = 1.0 / 7;
  camera.object_to_world[0xfffffffeU][1] = -0.0;
  const Camera back = through_file(camera).camera()->camera();
  const auto bits = [](const auto& numbers) {
    std::vector<std::uint64_t> list;
    for (const double element : numbers) list.push_back(std::bit_cast<std::uint64_t>(element));
    return list;
  };
  EXPECT_EQ(bits(back.world_to_camera), bits(camera.world_to_camera));
  EXPECT_EQ(bits(back.world_to_screen), bits(camera.world_to_screen));
  EXPECT_EQ(bits(back.jitter), bits(camera.jitter));
  EXPECT_EQ(back.size, camera.size);
  ASSERT_EQ(back.object_to_world.size(), 2U);
  for (const auto& [id, matrix] : camera.object_to_world) EXPECT_EQ(bits(back.object_to_world.at(id)), bits(matrix)) << id;
}

TEST_F(ItemFile, RefusesWhatIsNoSuchItem) {
  write_item(Image(QUELL_TYPE_DEPTH, {4, 4}, pool), 1, file(QUELL_TYPE_DEPTH));
  EXPECT_THROW(read_item(file(QUELL_TYPE_DEPTH), QUELL_TYPE_COLOR, pool), Error);
  EXPECT_THROW(read_item(folder / "none.exr", QUELL_TYPE_COLOR, pool), Error);
  std::filesystem::resize_file(file(QUELL_TYPE_DEPTH), 200);
  EXPECT_THROW(read_item(file(QUELL_TYPE_DEPTH), QUELL_TYPE_DEPTH, pool), Error);
  for (const char* text : {"", "{}", "[]", R"({"values": [1]})", R"({"values": ["x"]})", R"({"values": ["1p"]})"}) {
    std::ofstream(file(QUELL_TYPE_VALUE)) << text;
    EXPECT_THROW(read_item(file(QUELL_TYPE_VALUE), QUELL_TYPE_VALUE, pool), Error) << text;
  }
}

}  // namespace
}  // namespace quell
