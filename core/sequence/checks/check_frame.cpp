// All checks of a frame, in an order in which each may rely on what those before it found.
#include <algorithm>

#include "quell/sequence/checks/checks.h"

namespace quell {
namespace {

void append(std::vector<Finding>& all, std::vector<Finding> more) { std::ranges::move(more, std::back_inserter(all)); }

}  // namespace

void apply(const Remedy& remedy, FrameData& frame) {
  for (auto* image : {&frame.normal, &frame.position, &frame.depth, &frame.motion}) {
    if (!*image || (*image)->name != remedy.input) continue;
    (*image)->read_as = remedy.settings.or_else((*image)->read_as);
    (*image)->image = reread(**image, (*image)->read_as, frame);
  }
}

std::vector<Finding> check_frame(const FrameData& given) {
  FrameData frame = given;
  std::vector<Finding> all;
  for (const auto check : {check_finite, check_sizes, check_color, check_camera}) append(all, check(frame));
  for (Finding& finding : check_positions(frame)) {
    if (finding.remedy) apply(*finding.remedy, frame);
    if (finding.verdict == Verdict::wrong && !finding.remedy) frame.position.reset();  // nothing can be told by them
    all.push_back(std::move(finding));
  }
  for (Finding& finding : check_depth(frame)) {
    if (finding.remedy) apply(*finding.remedy, frame);
    all.push_back(std::move(finding));
  }
  for (const auto check : {check_ids, check_motion, check_normals}) append(all, check(frame));
  for (Finding& finding : all) finding.frame = frame.frame, finding.frame_matters = true;
  return all;
}

}  // namespace quell
