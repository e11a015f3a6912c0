#include <gtest/gtest.h>

#include <limits>
#include <ostream>

#include "quell/plugin/registry.h"
#include "tests/core/plugin/valid_pass.h"

namespace quell::test {
namespace {

struct Spoiled {
  const char* name;
  void (*spoil)(ValidPass&);
  const char* message;  // after "pass 'valid': parameter "
};
void PrintTo(const Spoiled& spoiled, std::ostream* out) { *out << spoiled.name; }

class CheckSpoiledParam : public testing::TestWithParam<Spoiled> {};

TEST_P(CheckSpoiledParam, SaysWhatIsWrong) {
  ValidPass pass;
  GetParam().spoil(pass);
  EXPECT_EQ(check(pass.desc), std::string("pass 'valid': parameter ") + GetParam().message);
}

const auto kTestName = [](const testing::TestParamInfo<Spoiled>& test) { return std::string(test.param.name); };
using V = ValidPass;

INSTANTIATE_TEST_SUITE_P(
    Description, CheckSpoiledParam,
    testing::Values(
        Spoiled{"NullName", [](V& v) { v.params[0].name = nullptr; }, "0: its name is not in snake_case"},
        Spoiled{"EmptyName", [](V& v) { v.params[0].name = ""; }, "'': its name is not in snake_case"},
        Spoiled{"SameNames", [](V& v) { v.params[1].name = "sigmas"; }, "'sigmas' is there twice"},
        Spoiled{"NullUnit", [](V& v) { v.params[0].unit = nullptr; }, "'sigmas': its unit or doc is null"},
        Spoiled{"UnknownType", [](V& v) { v.params[0].type = 6; }, "'sigmas': it has the unknown type 6"},
        Spoiled{"MinAboveMax", [](V& v) { v.params[0].min_value = 2; },
                "'sigmas': its least value is above its largest, or not a number"},
        Spoiled{"NanRange", [](V& v) { v.params[0].max_value = std::numeric_limits<double>::quiet_NaN(); },
                "'sigmas': its least value is above its largest, or not a number"},
        Spoiled{"MinCountAboveMax", [](V& v) { v.params[0].min_count = 4; }, "'sigmas': its least count is above its largest"},
        Spoiled{"NoEnumValues", [](V& v) { v.params[1].enum_count = 0; }, "'fetch': an enum needs 1 to 1000 values"},
        Spoiled{"NullEnumValues", [](V& v) { v.params[1].enum_values = nullptr; }, "'fetch': an enum needs 1 to 1000 values"},
        Spoiled{"NullEnumDocs", [](V& v) { v.params[1].enum_docs = nullptr; }, "'fetch': the enum's documentation is null"},
        Spoiled{"UnnamedEnumValue", [](V& v) { v.enum_names[1] = ""; }, "'fetch': value 1 of the enum has no name"},
        Spoiled{"NullEnumDoc", [](V& v) { v.enum_docs[0] = nullptr; }, "'fetch': value 0 of the enum has no documentation"},
        Spoiled{"SameEnumValues", [](V& v) { v.enum_names[1] = "nearest"; },
                "'fetch': the enum's value 'nearest' is there twice"}),
    kTestName);

INSTANTIATE_TEST_SUITE_P(
    Default, CheckSpoiledParam,
    testing::Values(
        Spoiled{"Missing", [](V& v) { v.params[0].default_value = nullptr; }, "'sigmas': it has no default"},
        Spoiled{"OtherType", [](V& v) { v.params[0].default_value = &v.defaults[2]; },
                "'sigmas': its default has another type than itself"},
        Spoiled{"UnknownType", [](V& v) { v.defaults[0].type = 99; }, "'sigmas': its default: a value has the unknown type 99"},
        Spoiled{"NullData", [](V& v) { v.defaults[0].data.doubles = nullptr; }, "'sigmas': its default: a value's data is null"},
        Spoiled{"NullText", [](V& v) { v.text[0] = nullptr; }, "'label': its default: a value's text is null"},
        Spoiled{"AboveRange", [](V& v) { v.numbers[1] = 1.5; }, "'sigmas': its default is outside its range"},
        Spoiled{"BelowRange", [](V& v) { v.numbers[0] = -1; }, "'sigmas': its default is outside its range"},
        Spoiled{"NotANumber", [](V& v) { v.numbers[0] = std::numeric_limits<double>::quiet_NaN(); },
                "'sigmas': its default is outside its range"},
        Spoiled{"NoSuchChoice", [](V& v) { v.choice[0] = 2; }, "'fetch': its default is outside its range"},
        Spoiled{"NegativeChoice", [](V& v) { v.choice[0] = -1; }, "'fetch': its default is outside its range"},
        Spoiled{"TwoForOne", [](V& v) { v.params[0].is_array = 0; }, "'sigmas': its default must be one value"},
        Spoiled{"TooFew", [](V& v) { v.defaults[0].count = 0; }, "'sigmas': its default has 0 values, not 1 to 3 values"},
        Spoiled{"TooMany", [](V& v) { v.params[0].max_count = 1; }, "'sigmas': its default has 2 values, not 1 to 1 values"},
        Spoiled{"AbsurdCount", [](V& v) { v.defaults[0].count = ~0u; },
                "'sigmas': its default: a value claims 4294967295 elements"}),
    kTestName);

}  // namespace
}  // namespace quell::test
