// Every row of layout_rows.h: what it writes is recognized, told, and read as it is meant; and the table in core/README.md.
#include <fstream>
#include <sstream>

#include "quell/sequence/sequence.h"
#include "tests/core/sequence/layout_rows.h"

namespace quell {
namespace {

using test::LayoutRow;
using testing::HasSubstr;

class Layouts : public testing::TestWithParam<LayoutRow> {};

std::string line_of(const std::string& description, const std::string& input) {
  std::istringstream lines(description);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("  " + input + " ")) return line;
  return "no line of " + input + " in: " + description;
}

/// Where a point of the world is seen, in pixels, and the projection's w.
std::vector<double> see(const Matrix& m, const std::array<double, 3>& p) {
  const auto row = [&](std::size_t r) { return m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3]; };
  return {row(0) / row(3), row(1) / row(3), row(3)};
}

TEST_P(Layouts, AreRecognizedAndRead) {
  const LayoutRow& row = GetParam();
  const test::TempFolder folder;
  row.write(folder);
  SequenceOptions options;
  options.wanted = std::vector<std::string>{row.input};
  for (std::string option : row.in) {
    if (const std::size_t at = option.find("FOLDER"); at != std::string::npos) option.replace(at, 6, folder.path().string());
    options.in.push_back(option);
  }
  const auto sequence = Sequence::open(row.sequence.empty() ? folder.path() : folder / row.sequence, options);
  const std::string line = line_of(sequence->describe(), row.input);
  BufferPool pool;
  const Item item = sequence->read(row.input, 1, pool);
  if (item.camera())
    EXPECT_THAT(sequence->warnings(), testing::ElementsAre(HasSubstr(row.told)));
  else if (row.told.empty())
    EXPECT_THAT(line, testing::EndsWith("frames 1"));
  else
    EXPECT_THAT(line, HasSubstr(row.told));
  ASSERT_EQ(item.camera() ? item.camera()->camera().size : sequence->shape(row.input)->size, row.size);
  EXPECT_EQ(sequence->picture_window()->pixel_aspect, row.pixel_aspect);
  std::vector<double> got;
  if (item.camera())
    got = see(item.camera()->camera().world_to_screen, {11, 21, 34});
  else if (item.type() == QUELL_TYPE_ID)
    for (const std::uint32_t id : test::id_values(*item.image())) got.push_back(id);
  else
    for (const float value : test::values(*item.image())) got.push_back(value);
  EXPECT_THAT(got, testing::Pointwise(testing::DoubleNear(1e-6), row.expected));
}

INSTANTIATE_TEST_SUITE_P(Of, Layouts, testing::ValuesIn(test::layout_rows()), [](const auto& row) { return row.param.name; });

TEST(LayoutTable, InTheReadmeIsTheOneOfTheRows) {
  std::ostringstream text;
  text << std::ifstream(std::string(QUELL_SOURCE_DIR) + "/core/README.md").rdbuf();
  const std::string begin = "<!-- layouts: made by layout_test -->\n", end = "<!-- end of layouts -->";
  const std::string readme = text.str();
  const std::size_t first = readme.find(begin), last = readme.find(end);
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(last, std::string::npos);
  EXPECT_EQ(readme.substr(first + begin.size(), last - first - begin.size()), test::layout_table())
      << "put this between the marks in core/README.md:\n"
      << test::layout_table();
}

}  // namespace
}  // namespace quell
