#include "tests/core/sequence/convention_rows.h"

#include "quell/sequence/sequence.h"

namespace quell {
namespace {

class ConventionRows : public testing::Test {
 protected:
  /// The pixel (0, 0) of frame 2, read with these settings.
  std::vector<float> read(const test::ConventionRow& row, const std::string& settings) {
    const std::string file = row.input + ".0002." + row.extension;
    row.write(folder_ / file);
    test::make_text(folder_ / "frame.0001.json", test::convention_camera() + ", \"jitter\": [0.25, -0.5]}");
    test::make_text(folder_ / "frame.0002.json", test::convention_camera() + "}");
    const std::string pattern = (folder_ / (row.input + ".####." + row.extension)).string();
    const auto sequence = Sequence::open({}, {{row.input + "=" + pattern + (settings.empty() ? "" : ":" + settings),
                                               "camera=" + (folder_ / "frame.####.json").string()},
                                              {}});
    const Item item = sequence->read(row.input, 2, pool_);
    std::vector<float> pixel;
    for (int c = 0; c < item.image()->channels(); ++c) pixel.push_back(item.image()->floats().at(0, 0, c));
    return pixel;
  }
  static bool is_near(const std::vector<float>& got, const std::vector<double>& expected) {
    for (std::size_t i = 0; i < got.size(); ++i)  // 1e-4: 8 bit normals are told to 4 digits
      if (std::abs(got[i] - expected[i]) > 1e-4 * std::max(1.0, std::abs(expected[i]))) return false;
    return true;
  }
  test::TempFolder folder_;
  BufferPool pool_;
};

TEST_F(ConventionRows, EveryFileIsReadAsItsWriterMeantIt) {
  for (const test::ConventionRow& row : test::convention_rows()) {
    const auto got = read(row, row.convention);
    ASSERT_EQ(got.size(), row.expected.size());
    EXPECT_TRUE(is_near(got, row.expected)) << row.input << " " << row.convention << " by " << row.writer << ": "
                                            << testing::PrintToString(got);
  }
}

TEST_F(ConventionRows, TheOtherSideOfEachConventionWouldGiveOtherNumbers) {
  for (const test::ConventionRow& row : test::convention_rows())
    EXPECT_FALSE(is_near(read(row, row.wrong), row.expected)) << row.input << " " << row.wrong;
}

TEST_F(ConventionRows, TheTableInTheReadmeIsMadeFromThem) {
  const std::string readme = test::read_bytes(std::filesystem::path(QUELL_SOURCE_DIR) / "core/README.md");
  const std::string begin = "<!-- conventions: made by convention_rows_test -->\n", end = "<!-- end of conventions -->";
  const std::size_t first = readme.find(begin), last = readme.find(end);
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(last, std::string::npos);
  EXPECT_EQ(readme.substr(first + begin.size(), last - first - begin.size()), test::convention_table())
      << "put this between the marks in core/README.md:\n"
      << test::convention_table();
}

}  // namespace
}  // namespace quell
