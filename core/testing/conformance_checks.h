// The checks behind QUELL_CONFORMANCE_TEST, without a test framework.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "quell/testing/pass_test.h"

namespace quell::conformance {

/// Makes the pass with the parameters to be checked.
using MakePass = std::function<PassTest()>;
/// What was found to break a rule, in words; empty when all is well.
using Violations = std::vector<std::string>;

/// The descriptor is whole: checked as at loading, and every part is documented.
Violations check_description(const MakePass& make);
/// Runs on 1x1, 1xN, Nx1 and odd sizes, writes every pixel of every output whatever memory held before, and makes no NaN from
/// finite inputs.
Violations check_sizes(const MakePass& make);
/// A changed pixel of an input changes nothing outside the radius that the pass declares.
Violations check_radius(const MakePass& make);
/// NaN and infinity, which the runtime keeps away, would not spread beyond the radius nor crash.
Violations check_bad_values(const MakePass& make);
/// The same bits when an output takes over the memory of an input.
Violations check_in_place(const MakePass& make);
/// The same bits for any strides.
Violations check_strides(const MakePass& make);
/// The same bits for any number of threads and any size of chunks.
Violations check_chunks(const MakePass& make);
/// The same bits when a pass that works row by row is run on some rows at a time, of which alone its outputs have memory.
Violations check_rows(const MakePass& make);
/// The same bits for the same inputs and frame number, whatever was computed in between.
Violations check_purity(const MakePass& make);
/// Without its optional inputs, each alone and all at once, it runs, or refuses with a reason before it runs.
Violations check_optional_inputs(const MakePass& make);

}  // namespace quell::conformance
