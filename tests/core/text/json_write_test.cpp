// JSON that is written is laid out for people, and reads back as what it was.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "quell/text/json_write.h"

namespace quell {
namespace {

std::string written(double value) { return write_json(make_json(value)); }

Json read_back(const std::string& text) {
  Diagnostics errors;
  std::optional<Json> json = parse_json(std::make_shared<SourceText>(SourceText{"written", text}), errors);
  EXPECT_EQ(errors.render(), "") << text;
  return json.value_or(Json());
}

TEST(JsonWriting, KeepsSmallValuesInOneLineAndBreaksLargeOnes) {
  const Json small = JsonMembers().add("a", 1).add("b", std::vector<std::string>{"x", "y"}).take();
  EXPECT_EQ(write_json(small), "{ \"a\": 1, \"b\": [\"x\", \"y\"] }\n");
  EXPECT_EQ(write_json(small, 24), "{\n  \"a\": 1,\n  \"b\": [\"x\", \"y\"]\n}\n");
  EXPECT_EQ(write_json(small, 8), "{\n  \"a\": 1,\n  \"b\": [\n    \"x\",\n    \"y\"\n  ]\n}\n");
  EXPECT_EQ(write_json(make_object()), "{}\n");
  EXPECT_EQ(write_json(make_json(std::vector<Json>())), "[]\n");
}

// The comma that follows counts, too.
TEST(JsonWriting, KeepsLinesWithinTheColumns) {
  const Json list = make_json(std::vector<Json>{make_json(std::vector<Json>{make_json(123)}), make_json(4)});
  EXPECT_EQ(write_json(list, 8), "[\n  [123],\n  4\n]\n");
  EXPECT_EQ(write_json(list, 7), "[\n  [\n    123\n  ],\n  4\n]\n");
}

TEST(JsonWriting, WritesNumbersThatReadBackAsTheSame) {
  for (const double value : {0.1, -2.5, 1e-300, 3.4028234663852886e38, 1e22, 123456789.0, 0x1p53, -0x1p63})
    EXPECT_EQ(read_back(written(value)).number, value);
  EXPECT_EQ(written(16), "16\n");
  EXPECT_EQ(written(std::numeric_limits<double>::infinity()), "null\n");
  EXPECT_EQ(written(std::nan("")), "null\n");
  for (const std::int64_t value : {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()})
    EXPECT_EQ(read_back(write_json(make_json(value))).integer, value);
}

TEST(JsonWriting, KeepsEveryCharacterAndTheOrderOfKeys) {
  const std::string odd = "quote \" backslash \\ line\n tab\t zero " + std::string(1, '\0') + " ä €";
  const Json json = read_back(write_json(JsonMembers().add("z", odd).add(odd, true).add("a", "plain").take()));
  ASSERT_EQ(json.members.size(), 3u);
  EXPECT_EQ(json.members[0].value.string, odd);
  EXPECT_EQ(json.members[1].key, odd);
  EXPECT_TRUE(json.members[1].value.boolean);
  EXPECT_EQ(json.members[2].key, "a");
}

}  // namespace
}  // namespace quell
