#include "quell/plugin/registry.h"

namespace quell {

std::string check(const quell_pass_desc& desc) {
  if (desc.struct_size < sizeof(desc)) return "the descriptor of a pass is too small";
  if (!desc.id) return "a pass has no id";
  if (!desc.create || !desc.destroy || !desc.infer || !desc.process)
    return "pass '" + std::string(desc.id) + "' lacks a function";
  return {};
}

}  // namespace quell
