// All that the results of a run depend on, to tell whether two runs are one.
#pragma once

#include <map>
#include <string>

#include "job.h"
#include "quell/runtime/session.h"

namespace quell::app {

/// By what it is called in a message: "the vector unit" is "avx512".
using RunTraits = std::map<std::string, std::string>;
RunTraits traits_of(const Job& job, const SequenceArguments& sequence, const SessionOptions& options);

/// A line for all that differs: "\n  the vector unit: avx512 now, avx2 in the checkpoint".
std::string list_differences(const RunTraits& now, const RunTraits& then);

}  // namespace quell::app
