// Parameter values as they cross the plugin interface. Private to this box.
#pragma once

#include <vector>

#include "quell/plugin/pass_instance.h"

namespace quell {

/// The C array for a pass's create. Points into `values`, which must outlive it.
class RawParams {
 public:
  RawParams(const quell_pass_desc& desc, const std::vector<ParamValue>& values);
  const quell_param_value* data() const { return raw_.data(); }

 private:
  std::vector<std::vector<const char*>> strings_;
  std::vector<quell_param_value> raw_;
};

}  // namespace quell
