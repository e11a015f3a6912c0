// Whether a pass's answer to infer can be worked with. Private to this box.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quell/sdk/abi.h"

namespace quell {

/// Remembers the question, and then judges the answer.
class InferenceCheck {
 public:
  InferenceCheck(const quell_pass_desc& desc, const quell_inference& question);
  /// What is wrong with the answer, in a sentence; empty when nothing is.
  std::string find_fault(const quell_inference& answer) const;

 private:
  std::string fault_in_output(const quell_inference& answer, std::uint32_t port) const;
  std::string fault_in_place(const quell_inference& answer, std::uint32_t port) const;
  const quell_pass_desc& desc_;
  std::vector<quell_port_shape> outputs_;  // of the question
};

}  // namespace quell
