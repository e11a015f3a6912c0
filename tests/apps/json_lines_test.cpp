#include "json_lines.h"

#include <gmock/gmock.h>

#include <limits>
#include <sstream>
#include <thread>

#include "quell/text/json.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

TEST(JsonObject, HoldsMembersOfEveryKind) {
  JsonObject inner;
  inner.number("n", -3).number("large", std::uint64_t{1} << 63);
  EXPECT_EQ(JsonObject()
                .text("t", "a \"b\"\n\\")
                .texts("l", {"x", "y"})
                .flag("f", true)
                .seconds("s", 0.25)
                .object("o", inner)
                .objects("e", {})
                .str(),
            R"({"t":"a \"b\"\n\\","l":["x","y"],"f":true,"s":0.250000,"o":{"n":-3,"large":9223372036854775808},"e":[]})");
}

TEST(JsonObject, NeverHoldsWhatIsNotFinite) {
  using Limits = std::numeric_limits<double>;
  for (const double value : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()})
    EXPECT_EQ(JsonObject().seconds("s", value).str(), R"({"s":null})");
  EXPECT_THAT(JsonObject().seconds("s", Limits::max()).str(), ::testing::StartsWith(R"({"s":17976931)"));
}

class JsonLinesTest : public RunnerTest {};

TEST_F(JsonLinesTest, AreReadableWhileTheFileGrows) {
  JsonLines lines(path("log"), "--log");
  lines.write("first", JsonObject().number("n", 1));
  EXPECT_THAT(read_file(path("log")),
              ::testing::MatchesRegex(
                  R"(\{"event":"first","time":"[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}\.[0-9]{3}Z","n":1\})"
                  "\n"));
  lines.write("second", {});
  EXPECT_THAT(read_file(path("log")), ::testing::ContainsRegex("\n\\{\"event\":\"second\",\"time\":\"[^\"]*\"\\}\n"));
  EXPECT_TRUE(lines.ok());
}

TEST_F(JsonLinesTest, DoNotMixWhatSeveralThreadsWrite) {
  {
    JsonLines lines(path("log"), "--log");
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (int i = 0; i < 100; ++i) lines.write("event", JsonObject().text("text", std::string(200, 'x')));
      });
  }
  std::istringstream log(read_file(path("log")));
  int count = 0;
  for (std::string line; std::getline(log, line); ++count) {
    Diagnostics errors;
    const auto json = parse_json(std::make_shared<SourceText>(SourceText{"log", line}), errors);
    ASSERT_TRUE(json) << errors.render();
  }
  EXPECT_EQ(count, 400);
}

TEST_F(JsonLinesTest, AFullDiskIsNoticed) {
  JsonLines lines("/dev/full", "--log");
  lines.write("event", {});
  EXPECT_FALSE(lines.ok());
}

}  // namespace
}  // namespace quell::app::testing
