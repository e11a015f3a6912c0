#include "quell/sdk/params.h"

#include <gtest/gtest.h>

#include "quell/sdk/pass.h"

namespace quell::test {
namespace {

enum class Fetch { nearest, bilinear, bicubic };

/// One parameter of every type, plain and as an array.
struct Everything {
  bool on = true;
  int radius = 8;
  std::int64_t big = std::int64_t{1} << 40;
  float sigma = 0.5f;
  double gain = 0.1;
  Fetch fetch = Fetch::bilinear;
  std::string view = "Film";
  std::filesystem::path config = "a/b.ocio";
  std::vector<int> steps = {1, 2, 4};
  std::vector<double> matrix = {1, 0, 0, 1};
  std::vector<Fetch> fetches = {Fetch::bicubic, Fetch::nearest};
  std::vector<std::string> names = {"x"};
  std::vector<std::filesystem::path> files = {};
  std::vector<bool> flags = {false, true};

  void describe(auto&& field) {
    const auto choices = {Choice{"nearest", "one pixel"}, Choice{"bilinear", "four"}, Choice{"bicubic", "sixteen"}};
    field("on", on, "A switch.");
    field("radius", radius, Range<int>{0, 64}, "px", "Reach.");
    field("big", big, Range<std::int64_t>{}, "", "A large number.");
    field("sigma", sigma, Range<float>{0.25f, 2}, "world unit", "Width.");
    field("gain", gain, Range<double>{-1, 1}, "", "Factor.");
    field("fetch", fetch, Choices{{"nearest", "one pixel"}, {"bilinear", "four"}, {"bicubic", "sixteen"}}, "Sampling.");
    field("view", view, "Name of a view.");
    field("config", config, "A file.");
    field("steps", steps, Range<int>{1, 16}, Length{1, 5}, "px", "Distances.");
    field("matrix", matrix, Range<double>{}, Length{4, 4}, "", "Two by two.");
    field("fetches", fetches, choices, Length{0, 9}, "Samplings.");
    field("names", names, Length{0, 3}, "Names.");
    field("files", files, Length{}, "Files.");
    field("flags", flags, Length{2, 2}, "Switches.");
  }
};

std::vector<quell_param_desc> described(detail::ParamDescriber& describer) {
  Everything everything;
  everything.describe(describer);
  return describer.descriptors();
}

TEST(ParamDescriber, NamesEveryFieldInOrderWithItsType) {
  detail::ParamDescriber describer;
  const auto params = described(describer);
  const std::vector<std::pair<std::string, std::uint32_t>> expected = {
      {"on", QUELL_PARAM_BOOL},     {"radius", QUELL_PARAM_INT},    {"big", QUELL_PARAM_INT},      {"sigma", QUELL_PARAM_DOUBLE},
      {"gain", QUELL_PARAM_DOUBLE}, {"fetch", QUELL_PARAM_ENUM},    {"view", QUELL_PARAM_STRING},  {"config", QUELL_PARAM_PATH},
      {"steps", QUELL_PARAM_INT},   {"matrix", QUELL_PARAM_DOUBLE}, {"fetches", QUELL_PARAM_ENUM}, {"names", QUELL_PARAM_STRING},
      {"files", QUELL_PARAM_PATH},  {"flags", QUELL_PARAM_BOOL}};
  ASSERT_EQ(params.size(), expected.size());
  for (std::size_t i = 0; i < params.size(); ++i) {
    EXPECT_EQ(params[i].name, expected[i].first);
    EXPECT_EQ(params[i].type, expected[i].second) << params[i].name;
    EXPECT_EQ(params[i].is_array, i < 8 ? 0u : 1u) << params[i].name;
    EXPECT_EQ(params[i].default_value->type, params[i].type) << params[i].name;
  }
}

TEST(ParamDescriber, TellsRangesUnitsAndLengths) {
  detail::ParamDescriber describer;
  const auto params = described(describer);
  EXPECT_EQ(params[1].min_value, 0);
  EXPECT_EQ(params[1].max_value, 64);
  EXPECT_STREQ(params[1].unit, "px");
  EXPECT_STREQ(params[1].doc, "Reach.");
  EXPECT_EQ(params[3].min_value, 0.25);
  EXPECT_STREQ(params[0].unit, "");
  EXPECT_EQ(params[1].min_count, 1u);
  EXPECT_EQ(params[8].min_count, 1u);
  EXPECT_EQ(params[8].max_count, 5u);
  EXPECT_EQ(params[12].max_count, std::numeric_limits<std::uint32_t>::max());
}

TEST(ParamDescriber, ListsTheChoicesOfAnEnum) {
  detail::ParamDescriber describer;
  const auto params = described(describer);
  for (const std::size_t i : {std::size_t{5}, std::size_t{10}}) {
    ASSERT_EQ(params[i].enum_count, 3u);
    EXPECT_STREQ(params[i].enum_values[1], "bilinear");
    EXPECT_STREQ(params[i].enum_docs[2], "sixteen");
  }
}

TEST(ParamDescriber, TakesTheInitialValuesAsDefaults) {
  detail::ParamDescriber describer;
  const auto params = described(describer);
  EXPECT_EQ(params[0].default_value->data.bools[0], 1);
  EXPECT_EQ(params[2].default_value->data.ints[0], std::int64_t{1} << 40);
  EXPECT_EQ(params[5].default_value->data.ints[0], 1);
  EXPECT_STREQ(params[7].default_value->data.strings[0], "a/b.ocio");
  EXPECT_EQ(params[8].default_value->count, 3u);
  EXPECT_EQ(params[8].default_value->data.ints[2], 4);
  EXPECT_EQ(params[12].default_value->count, 0u);
}

/// The values of an Everything as the host would pass them.
class Values : public detail::ParamDescriber {
 public:
  explicit Values(Everything everything) {
    everything.describe(static_cast<detail::ParamDescriber&>(*this));
    for (const quell_param_desc& desc : descriptors()) values_.push_back(*desc.default_value);
  }
  const quell_param_value* data() const { return values_.data(); }

 private:
  std::vector<quell_param_value> values_;
};

TEST(ParamReader, ReadsBackEveryType) {
  Everything sent;
  sent.on = false, sent.radius = -3, sent.big = -5, sent.sigma = 1.5f, sent.gain = -0.125, sent.fetch = Fetch::bicubic;
  sent.view = "", sent.config = "c", sent.steps = {}, sent.matrix = {9}, sent.fetches = {Fetch::bilinear};
  sent.names = {"p", "q"}, sent.files = {"f", "g"}, sent.flags = {true};
  const Values values(sent);

  Everything read;
  detail::ParamReader reader(values.data());
  read.describe(reader);
  EXPECT_EQ(read.on, sent.on);
  EXPECT_EQ(read.radius, sent.radius);
  EXPECT_EQ(read.big, sent.big);
  EXPECT_EQ(read.sigma, sent.sigma);
  EXPECT_EQ(read.gain, sent.gain);
  EXPECT_EQ(read.fetch, sent.fetch);
  EXPECT_EQ(read.view, sent.view);
  EXPECT_EQ(read.config, sent.config);
  EXPECT_EQ(read.steps, sent.steps);
  EXPECT_EQ(read.matrix, sent.matrix);
  EXPECT_EQ(read.fetches, sent.fetches);
  EXPECT_EQ(read.names, sent.names);
  EXPECT_EQ(read.files, sent.files);
  EXPECT_EQ(read.flags, sent.flags);
}

// Values of a host that is newer than the plugin are longer than the plugin knows.
TEST(ParamReader, StepsByTheSizeThatTheHostWrote) {
  struct LongerValue {
    quell_param_value known;
    double news;
  };
  const std::int64_t numbers[] = {7, 8};
  LongerValue values[2] = {};
  for (int i = 0; i < 2; ++i) {
    values[i].known = {sizeof(LongerValue), QUELL_PARAM_INT, 1, {}};
    values[i].known.data.ints = &numbers[i];
  }
  int first = 0, second = 0;
  detail::ParamReader reader(&values[0].known);
  reader("first", first), reader("second", second);
  EXPECT_EQ(first, 7);
  EXPECT_EQ(second, 8);
}

}  // namespace
}  // namespace quell::test
