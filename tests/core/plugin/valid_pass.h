// A descriptor with nothing wrong, whose every piece a test can spoil.
#pragma once

#include <array>

#include "quell/sdk/abi.h"

namespace quell::test {

struct ValidPass {
  std::array<double, 2> numbers{0.25, 0.75};
  std::array<std::int64_t, 1> choice{1};
  std::array<const char*, 1> text{"here"};
  std::array<const char*, 2> enum_names{"nearest", "bilinear"};
  std::array<const char*, 2> enum_docs{"one pixel", "four pixels"};
  std::array<quell_param_value, 3> defaults{};
  std::array<quell_param_desc, 3> params{};
  std::array<quell_port_desc, 2> inputs{};
  std::array<quell_port_desc, 2> outputs{};
  std::array<quell_change, 1> changes{};
  quell_pass_desc desc{};

  ValidPass() {
    describe_params();
    const quell_param_value* former = defaults.data();
    inputs[0] = {sizeof(quell_port_desc), 0, "color", QUELL_TYPE_BIT(QUELL_TYPE_COLOR), -1, ""};
    inputs[1] = {sizeof(quell_port_desc), QUELL_PORT_ARRAY | QUELL_PORT_OPTIONAL, "extra", 3, -1, ""};
    outputs[0] = {sizeof(quell_port_desc), 0, "color", 0, 0, ""};
    outputs[1] = {sizeof(quell_port_desc), QUELL_PORT_ARRAY, "extra", 0, 1, ""};
    changes[0] = {sizeof(quell_change), 2, "sigmas", nullptr, former};
    desc = {sizeof(desc),
            3,
            2,
            "valid",
            "",
            "",
            "",
            inputs.data(),
            2,
            outputs.data(),
            2,
            params.data(),
            3,
            changes.data(),
            1,
            [](const quell_host*, const quell_param_value*, void** instance) {
              static int something;
              return *instance = &something, QUELL_OK;
            },
            [](void*) {},
            [](const void*, const quell_host*, quell_inference*) { return QUELL_OK; },
            [](const void*, const quell_host*, const quell_exec*) { return QUELL_OK; }};
  }
  ValidPass(const ValidPass&) = delete;
  ValidPass& operator=(const ValidPass&) = delete;

 private:
  void describe_params() {
    defaults[0] = {sizeof(quell_param_value), QUELL_PARAM_DOUBLE, 2, {}};
    defaults[0].data.doubles = numbers.data();
    defaults[1] = {sizeof(quell_param_value), QUELL_PARAM_ENUM, 1, {}};
    defaults[1].data.ints = choice.data();
    defaults[2] = {sizeof(quell_param_value), QUELL_PARAM_STRING, 1, {}};
    defaults[2].data.strings = text.data();
    params[0] = {
        sizeof(quell_param_desc), QUELL_PARAM_DOUBLE, "sigmas", "px", "", 1, 1, 3, 0, 1, nullptr, nullptr, 0, &defaults[0]};
    params[1] = {sizeof(quell_param_desc), QUELL_PARAM_ENUM, "fetch", "",          "", 0, 1, 1, 0, 0,
                 enum_names.data(),        enum_docs.data(), 2,       &defaults[1]};
    params[2] = {sizeof(quell_param_desc), QUELL_PARAM_STRING, "label", "", "", 0, 1, 1, 0, 0, nullptr, nullptr, 0, &defaults[2]};
  }
};

}  // namespace quell::test
