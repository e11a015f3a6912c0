#include <gtest/gtest.h>

#include <limits>
#include <ostream>

#include "quell/plugin/registry.h"
#include "tests/core/plugin/valid_pass.h"

namespace quell::test {
namespace {

TEST(CheckPass, FindsNothingWrongWithAValidPass) { EXPECT_EQ(check(ValidPass().desc), ""); }

struct Spoiled {
  const char* name;
  void (*spoil)(ValidPass&);
  const char* message;
};
void PrintTo(const Spoiled& spoiled, std::ostream* out) { *out << spoiled.name; }

class CheckSpoiledPass : public testing::TestWithParam<Spoiled> {};

TEST_P(CheckSpoiledPass, SaysWhatIsWrong) {
  ValidPass pass;
  GetParam().spoil(pass);
  EXPECT_EQ(check(pass.desc), GetParam().message);
}

const auto kTestName = [](const testing::TestParamInfo<Spoiled>& test) { return std::string(test.param.name); };
using V = ValidPass;

INSTANTIATE_TEST_SUITE_P(
    Pass, CheckSpoiledPass,
    testing::Values(
        Spoiled{"SmallStruct", [](V& v) { v.desc.struct_size = 8; },
                "the descriptor of a pass has the struct_size 8 instead of 144"},
        Spoiled{"GarbageStruct", [](V& v) { v.desc.struct_size = 0xdeadbeef; },
                "the descriptor of a pass has the struct_size 3735928559 instead of 144"},
        Spoiled{"NullId", [](V& v) { v.desc.id = nullptr; }, "a pass has no id"},
        Spoiled{"EmptyId", [](V& v) { v.desc.id = ""; }, "the id of the pass '' is not in snake_case"},
        Spoiled{"CapitalId", [](V& v) { v.desc.id = "Valid"; }, "the id of the pass 'Valid' is not in snake_case"},
        Spoiled{"DottedId", [](V& v) { v.desc.id = "a.b"; }, "the id of the pass 'a.b' is not in snake_case"},
        Spoiled{"NullSummary", [](V& v) { v.desc.summary = nullptr; }, "pass 'valid': its summary, doc or source is null"},
        Spoiled{"NullSource", [](V& v) { v.desc.source = nullptr; }, "pass 'valid': its summary, doc or source is null"},
        Spoiled{"Version0", [](V& v) { v.desc.version = 0; }, "pass 'valid': its version is 0; versions count from 1"},
        Spoiled{"OldestVersion0", [](V& v) { v.desc.oldest_version = 0; },
                "pass 'valid': its oldest version is 0, not one of 1 to 3"},
        Spoiled{"OldestAboveVersion", [](V& v) { v.desc.oldest_version = 4; },
                "pass 'valid': its oldest version is 4, not one of 1 to 3"},
        Spoiled{"NoCreate", [](V& v) { v.desc.create = nullptr; }, "pass 'valid': its function create is null"},
        Spoiled{"NoDestroy", [](V& v) { v.desc.destroy = nullptr; }, "pass 'valid': its function destroy is null"},
        Spoiled{"NoInfer", [](V& v) { v.desc.infer = nullptr; }, "pass 'valid': its function infer is null"},
        Spoiled{"NoProcess", [](V& v) { v.desc.process = nullptr; }, "pass 'valid': its function process is null"},
        Spoiled{"NoOutputs", [](V& v) { v.desc.output_count = 0; }, "pass 'valid': it has no outputs"},
        Spoiled{"ManyInputs", [](V& v) { v.desc.input_count = 1001; }, "pass 'valid': it claims to have 1001 inputs"},
        Spoiled{"NullOutputs", [](V& v) { v.desc.outputs = nullptr; }, "pass 'valid': its array of outputs is null"},
        Spoiled{"NullParams", [](V& v) { v.desc.params = nullptr; }, "pass 'valid': its array of params is null"},
        Spoiled{"ManyChanges", [](V& v) { v.desc.change_count = ~0u; }, "pass 'valid': it claims to have 4294967295 changes"}),
    kTestName);

INSTANTIATE_TEST_SUITE_P(
    Port, CheckSpoiledPass,
    testing::Values(
        Spoiled{"SmallStruct", [](V& v) { v.inputs[0].struct_size = 8; },
                "pass 'valid': its array of inputs has the struct_size 8 instead of 32"},
        Spoiled{"UnequalStructs", [](V& v) { v.outputs[1].struct_size = 7; },
                "pass 'valid': its array of outputs has the struct_size 7 instead of 32"},
        Spoiled{"NullName", [](V& v) { v.inputs[1].name = nullptr; }, "pass 'valid': input 1: its name is not in snake_case"},
        Spoiled{"NameOfDigits", [](V& v) { v.inputs[1].name = "2x"; }, "pass 'valid': input '2x': its name is not in snake_case"},
        Spoiled{"NullDoc", [](V& v) { v.inputs[0].doc = nullptr; }, "pass 'valid': input 'color': its doc is null"},
        Spoiled{"SameNames", [](V& v) { v.inputs[1].name = "color"; }, "pass 'valid': input 'color' is there twice"},
        Spoiled{"NoType", [](V& v) { v.inputs[0].types = 0; }, "pass 'valid': input 'color': it accepts no type"},
        Spoiled{"UnknownType", [](V& v) { v.inputs[0].types = 1u << QUELL_TYPE_COUNT; },
                "pass 'valid': input 'color': it has a type that is not known"},
        Spoiled{"UnknownFlag", [](V& v) { v.inputs[0].flags = 8; },
                "pass 'valid': input 'color': it has a flag that is not known"},
        Spoiled{"InputSameAs", [](V& v) { v.inputs[1].same_as = 0; },
                "pass 'valid': input 'extra': only an output may be of the same type as an input"},
        Spoiled{"SameAsBeyondInputs", [](V& v) { v.outputs[0].same_as = 2; },
                "pass 'valid': output 'color': its same_as names no input"},
        Spoiled{"SameAsBelowMinusOne", [](V& v) { v.outputs[0].same_as = -2; },
                "pass 'valid': output 'color': its same_as names no input"},
        Spoiled{"ArrayFromPlainInput", [](V& v) { v.outputs[1].same_as = 0; },
                "pass 'valid': output 'extra': it and the input that same_as names must both be arrays, or neither"},
        Spoiled{"PlainFromArrayInput", [](V& v) { v.outputs[0].same_as = 1; },
                "pass 'valid': output 'color': it and the input that same_as names must both be arrays, or neither"},
        Spoiled{"ArrayWithoutSameAs", [](V& v) { v.outputs[1].same_as = -1, v.outputs[1].types = 1; },
                "pass 'valid': output 'extra': an output that is an array needs a same_as input"},
        Spoiled{"OutputOfTwoTypes", [](V& v) { v.outputs[0].same_as = -1, v.outputs[0].types = 3; },
                "pass 'valid': output 'color': an output has exactly one type, or a same_as input"},
        Spoiled{"OutputOfNoType", [](V& v) { v.outputs[0].same_as = -1; },
                "pass 'valid': output 'color': an output has exactly one type, or a same_as input"},
        Spoiled{"CameraOutput", [](V& v) { v.outputs[0].same_as = -1, v.outputs[0].types = QUELL_TYPE_BIT(QUELL_TYPE_CAMERA); },
                "pass 'valid': output 'color': an output cannot be a camera: the interface has no place to write one"},
        Spoiled{"SameAsCamera", [](V& v) { v.inputs[0].types |= QUELL_TYPE_BIT(QUELL_TYPE_CAMERA); },
                "pass 'valid': output 'color': an output cannot be a camera: the interface has no place to write one"},
        Spoiled{"OptionalOutput", [](V& v) { v.outputs[0].flags = QUELL_PORT_OPTIONAL; },
                "pass 'valid': output 'color': an output cannot be optional"},
        Spoiled{"OutputOfAnySize", [](V& v) { v.outputs[0].flags = QUELL_PORT_ANY_SIZE; },
                "pass 'valid': output 'color': an output cannot be of any size: infer says which it has"}),
    kTestName);

INSTANTIATE_TEST_SUITE_P(
    Change, CheckSpoiledPass,
    testing::Values(Spoiled{"NullParam", [](V& v) { v.changes[0].param = nullptr; }, "pass 'valid': change 0 names no parameter"},
                    Spoiled{"UnknownParam", [](V& v) { v.changes[0].param = "sigma"; },
                            "pass 'valid': change 0 (version 2): there is no parameter 'sigma'"},
                    Spoiled{"RenamedToUnknown", [](V& v) { v.changes[0].renamed_to = "sigma"; },
                            "pass 'valid': change 0 (version 2): there is no parameter 'sigma'"},
                    Spoiled{"VersionAbove", [](V& v) { v.changes[0].version = 4; },
                            "pass 'valid': change 0 (version 4): its version must be one of 2 to the pass's own, 3"},
                    Spoiled{"Version1", [](V& v) { v.changes[0].version = 1; },
                            "pass 'valid': change 0 (version 1): its version must be one of 2 to the pass's own, 3"},
                    Spoiled{"UnreadableFormerDefault",
                            [](V& v) {
                              v.defaults[0].struct_size = 3;
                              v.params[0].default_value = &v.defaults[1];
                              v.params[0] = v.params[1];
                              v.params[0].name = "sigmas";
                            },
                            "pass 'valid': change 0 (version 2): a value has the struct_size 3 instead of 24"}),
    kTestName);

}  // namespace
}  // namespace quell::test
