#include <gtest/gtest.h>

#include <limits>

#include "quell/plugin/pass_instance.h"
#include "tests/core/plugin/valid_pass.h"

namespace quell::test {
namespace {

quell_param_desc plain(quell_param_type type) { return {sizeof(quell_param_desc), static_cast<std::uint32_t>(type)}; }
quell_param_desc list(quell_param_type type) {
  quell_param_desc desc = plain(type);
  desc.is_array = 1;
  return desc;
}

TEST(DefaultValue, CopiesWhatTheDescriptorPointsTo) {
  ValidPass pass;
  const ParamValue sigmas = default_value(pass.params[0]);
  pass.numbers[0] = 0;
  EXPECT_EQ(std::get<std::vector<double>>(sigmas.elements), (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(std::get<std::vector<std::int64_t>>(default_value(pass.params[1]).elements), std::vector<std::int64_t>{1});
  EXPECT_EQ(std::get<std::vector<std::string>>(default_value(pass.params[2]).elements), std::vector<std::string>{"here"});
}

TEST(ToJson, WritesEachTypeAsAPersonWould) {
  EXPECT_EQ(to_json(plain(QUELL_PARAM_BOOL), {std::vector<std::uint8_t>{1}}), "true");
  EXPECT_EQ(to_json(plain(QUELL_PARAM_INT), {std::vector<std::int64_t>{-12}}), "-12");
  EXPECT_EQ(to_json(plain(QUELL_PARAM_DOUBLE), {std::vector<double>{0.8}}), "0.8");
  EXPECT_EQ(to_json(plain(QUELL_PARAM_DOUBLE), {std::vector<double>{4}}), "4");
  EXPECT_EQ(to_json(plain(QUELL_PARAM_DOUBLE), {std::vector<double>{1e-12}}), "1e-12");
  EXPECT_EQ(to_json(plain(QUELL_PARAM_PATH), {std::vector<std::string>{"a/b.ocio"}}), "\"a/b.ocio\"");
  const ValidPass pass;
  EXPECT_EQ(to_json(pass.params[1], default_value(pass.params[1])), "\"bilinear\"");
}

TEST(ToJson, WritesArraysAsLists) {
  EXPECT_EQ(to_json(list(QUELL_PARAM_INT), {std::vector<std::int64_t>{1, 2}}), "[1, 2]");
  EXPECT_EQ(to_json(list(QUELL_PARAM_STRING), {std::vector<std::string>{}}), "[]");
  EXPECT_EQ(to_json(list(QUELL_PARAM_BOOL), {std::vector<std::uint8_t>{0}}), "[false]");
}

TEST(ToJson, EscapesText) {
  EXPECT_EQ(to_json(plain(QUELL_PARAM_STRING), {std::vector<std::string>{"a\"b\\c\nd\te\x01\x1f"}}),
            R"("a\"b\\c\nd\te\u0001\u001f")");
}

TEST(ToJson, KeepsEveryBitOfANumber) {
  const double third = 1.0 / 3;
  EXPECT_EQ(std::stod(to_json(plain(QUELL_PARAM_DOUBLE), {std::vector<double>{third}})), third);
  const double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(std::stod(to_json(plain(QUELL_PARAM_DOUBLE), {std::vector<double>{largest}})), largest);
}

// What create receives, compared with what went in: a copy is taken there, since the array lives no longer than the call.
std::vector<double> seen_doubles;
std::vector<std::int64_t> seen_ints;
std::vector<std::string> seen_texts;

TEST(PassInstance, HandsEveryParameterToCreateInTheDescriptorsOrder) {
  ValidPass pass;
  pass.desc.create = [](const quell_host*, const quell_param_value* values, void** instance) {
    const quell_param_value& second = *QUELL_AT(quell_param_value, values, 1);
    const quell_param_value& third = *QUELL_AT(quell_param_value, values, 2);
    seen_doubles.assign(values->data.doubles, values->data.doubles + values->count);
    seen_ints.assign(second.data.ints, second.data.ints + second.count);
    seen_texts.assign(third.data.strings, third.data.strings + third.count);
    *instance = &seen_texts;
    return QUELL_OK;
  };
  const PassInstance instance(
      pass.desc, {{std::vector<double>{1, 2, 3}}, {std::vector<std::int64_t>{0}}, {std::vector<std::string>{"text"}}});
  EXPECT_EQ(seen_doubles, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(seen_ints, std::vector<std::int64_t>{0});
  EXPECT_EQ(seen_texts, std::vector<std::string>{"text"});
}

}  // namespace
}  // namespace quell::test
