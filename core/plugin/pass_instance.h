// A pass with its parameters set: the C interface's create, infer, process and destroy, with errors as exceptions.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "quell/sdk/abi.h"
#include "quell/text/error.h"

namespace quell {

/// One parameter's value. Plain parameters have one element; enums are held as indices, paths as text.
struct ParamValue {
  std::variant<std::vector<std::uint8_t>, std::vector<std::int64_t>, std::vector<double>, std::vector<std::string>> elements;
};

/// The default of a parameter.
ParamValue default_value(const quell_param_desc& desc);
/// As a person would write it in a graph: `0.8`, `"bilinear"`, `[1, 2]`.
std::string to_json(const quell_param_desc& desc, const ParamValue& value);

/// Thread-safe after construction.
class PassInstance {
 public:
  /// `values` has one entry for each parameter of the descriptor, within type and range. Throws Error(usage) with the pass's own
  /// words when it refuses them.
  PassInstance(const quell_pass_desc& desc, std::vector<ParamValue> values);
  ~PassInstance();
  PassInstance(const PassInstance&) = delete;
  PassInstance& operator=(const PassInstance&) = delete;

  const quell_pass_desc& desc() const { return desc_; }
  const std::vector<ParamValue>& values() const { return values_; }
  /// Throws Error(usage) with the pass's words when it cannot work with these shapes, Error(plugin) when its answer is not valid.
  void infer(quell_inference& inference) const;
  /// The status is the pass's; its message went to host.set_error. An exception that a plugin lets through, although it must not,
  /// becomes QUELL_FAILED with a message.
  quell_status process(const quell_host& host, const quell_exec& exec) const;

 private:
  const quell_pass_desc& desc_;
  std::vector<ParamValue> values_;
  void* instance_ = nullptr;
};

}  // namespace quell
