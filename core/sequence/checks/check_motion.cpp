// Motion vectors, compared with what the cameras and the objects' matrices tell.
#include <algorithm>
#include <cmath>

#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/expected_motion.h"
#include "quell/sequence/checks/statistics.h"

namespace quell {
namespace {

// A vector is an average over a pixel or that of one sample in it; where neighbors differ by 2 %, 0.5 px apart that makes 0.01 of
// 10 px. Half precision rounds by 2^-12 of the number. The tolerance is well above both, and well below what tells a wrong
// convention.
constexpr double kTolerance = 0.1;            // px
constexpr double kRelative = 1.0 / (1 << 9);  // of the motion
constexpr double kMoving = 0.5;               // px: less than this says little about sign and unit
constexpr double kEnough = 0.9;               // of the moving pixels: edges are averaged, and some things deform
constexpr double kMost = 0.5;
constexpr double kFewPixels = 0.001;  // of all, and at least 16: what moves has to be more than a few strays
constexpr double kSomeSky = 0.01;

bool agrees(double error, double length) { return error <= kTolerance + kRelative * length; }

/// How one reading of the motion compares with what is expected.
struct Comparison {
  Distribution error;  ///< px, of surfaces that move
  std::size_t moving = 0, agreeing = 0;
  std::size_t standing = 0, standing_agreeing = 0;
  std::size_t sky = 0, sky_agreeing = 0, sky_zero = 0;

  static double ratio(std::size_t part, std::size_t all) {
    return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
  }
  double share() const { return ratio(agreeing, moving); }
  double standing_share() const { return ratio(standing_agreeing, standing); }
  double sky_share() const { return ratio(sky_agreeing, sky); }
};

Comparison compare(const FloatImage& motion, const FloatImage& expected, const Surfaces& surfaces, Image map = {}) {
  Comparison result;
  for (int y = 0; y < motion.height; ++y) {
    for (int x = 0; x < motion.width; ++x) {
      const double ex = expected.at(x, y, 0), ey = expected.at(x, y, 1), mx = motion.at(x, y, 0), my = motion.at(x, y, 1);
      const double error = std::hypot(mx - ex, my - ey), length = std::hypot(ex, ey);
      if (!std::isfinite(error)) continue;
      const std::size_t good = agrees(error, length) ? 1 : 0;
      if (map) map.writable_floats().at(x, y) = static_cast<float>(error);
      if (!surfaces.has(x, y)) {
        ++result.sky, result.sky_agreeing += good, result.sky_zero += mx == 0 && my == 0 ? 1 : 0;
      } else if (length > kMoving) {
        ++result.moving, result.agreeing += good, result.error.add(error);
      } else {
        ++result.standing, result.standing_agreeing += good;
      }
    }
  }
  return result;
}

/// What a reading states of motion; all four are set.
Conventions stated(const Conventions& read_as) {
  Conventions all;
  all.sign = read_as.sign.value_or(MotionSign::previous_minus_current);
  all.unit = read_as.unit.value_or(MotionUnit::pixels);
  all.y = read_as.y.value_or(YDirection::down);
  all.jitter = read_as.jitter.value_or(Jitter::excluded);
  return all;
}

/// Only what differs.
Conventions difference(const Conventions& reading, const Conventions& present) {
  Conventions changed;
  if (reading.sign != present.sign) changed.sign = reading.sign;
  if (reading.unit != present.unit) changed.unit = reading.unit;
  if (reading.y != present.y) changed.y = reading.y;
  if (reading.jitter != present.jitter) changed.jitter = reading.jitter;
  return changed;
}

int count_settings(const Conventions& c) { return (c.sign ? 1 : 0) + (c.unit ? 1 : 0) + (c.y ? 1 : 0) + (c.jitter ? 1 : 0); }

/// All readings but the present one, those that change least first.
std::vector<Conventions> other_readings(const FrameData& frame) {
  const Conventions present = stated(frame.motion->read_as);
  std::vector<Conventions> changes;
  for (const MotionSign sign : {MotionSign::previous_minus_current, MotionSign::current_minus_previous})
    for (const MotionUnit unit : {MotionUnit::pixels, MotionUnit::uv, MotionUnit::ndc})
      for (const YDirection y : {YDirection::down, YDirection::up})
        for (const Jitter jitter : {Jitter::excluded, Jitter::included}) {
          if (jitter != present.jitter && frame.camera->jitter == frame.previous->jitter) continue;
          Conventions reading;
          reading.sign = sign, reading.unit = unit, reading.y = y, reading.jitter = jitter;
          const Conventions change = difference(reading, present);
          if (count_settings(change) > 0) changes.push_back(change);
        }
  std::ranges::stable_sort(changes, {}, count_settings);
  return changes;
}

class MotionCheck {
 public:
  MotionCheck(const FrameData& frame, const Surfaces& surfaces)
      : frame_(frame),
        surfaces_(surfaces),
        expected_(expected_motion(frame, surfaces, frame.motion->image.size())),
        map_(make_error_map(frame.motion->image.size())),
        present_(compare(frame.motion->image.floats(), expected_.floats(), surfaces, map_)) {}

  std::vector<Finding> run() {
    std::vector<Finding> findings{judge_surfaces()};
    const Size size = expected_.size();
    if (static_cast<double>(present_.sky) >= kSomeSky * size.width * size.height) findings.push_back(judge_sky());
    return findings;
  }

 private:
  Comparison read_with(const Conventions& change) const {
    const Image other = reread(*frame_.motion, change.or_else(frame_.motion->read_as), frame_);
    return compare(other.floats(), expected_.floats(), surfaces_);
  }

  bool anything_moves() const {
    const auto all = static_cast<double>(present_.moving + present_.standing);
    return static_cast<double>(present_.moving) >= std::max(16.0, kFewPixels * all);
  }

  Finding judge_surfaces() {
    Finding finding{Verdict::ok, kMotionSubject, ""};
    if (present_.moving + present_.standing == 0) {
      finding.verdict = Verdict::not_tested, finding.text = "no pixel shows a surface";
      return finding;
    }
    finding.figures = {{"p99_px", present_.error.quantile(0.99)},
                       {"median_px", present_.error.median()},
                       {"max_px", present_.error.max()},
                       {"agreeing_share", present_.share()},
                       {"standing_share", present_.standing_share()}};
    finding.errors = map_, finding.large_error = 1, finding.error_unit = "px";
    anything_moves() ? judge_moving(finding) : judge_standing(finding);
    return finding;
  }

  void judge_standing(Finding& finding) const {
    const double share = present_.standing_share();
    if (share >= kEnough) {
      finding.verdict = Verdict::not_tested;
      finding.text = "cannot be told: nothing moves by more than half a pixel between these frames";
      return;
    }
    finding.verdict = share >= kMost ? Verdict::suspicious : Verdict::wrong;
    finding.text = "by the matrices nothing moves by more than half a pixel, but " + percent(1 - share) +
                   " of the vectors say otherwise" + (share >= kMost ? ": what moves deforms, or has no matrix" : "");
  }

  void judge_moving(Finding& finding) const {
    finding.remedy = find_remedy();
    if (present_.share() >= kEnough && !finding.remedy) {
      finding.text = "of what moves, 99 % agree within " + pixels(present_.error.quantile(0.99)) + ", half within " +
                     pixels(present_.error.median()) + " (" + std::to_string(present_.moving) + " pixels)";
      tell_standing(finding);
      tell_ambiguity(finding);
      return;
    }
    const bool wrong = finding.remedy || present_.share() < kMost;
    finding.verdict = wrong ? Verdict::wrong : Verdict::suspicious;
    finding.text = (present_.agreeing > 0 ? "only " : "") + percent(present_.share()) + " of what moves agrees within " +
                   pixels(kTolerance) + ", half within " + pixels(present_.error.median());
    if (finding.remedy)
      finding.text += "; read otherwise, " + percent(read_with(finding.remedy->settings).share()) + " does";
    else if (wrong)
      finding.text +=
          "; no other reading agrees: cameras, matrices or ids may be of other frames, or the vectors lead to the next frame";
    else
      finding.text += "; the rest may deform, have no matrix, or be averaged at edges";
  }

  void tell_standing(Finding& finding) const {
    const double stray = 1 - present_.standing_share();
    if (present_.standing < 16 || stray < 0.01) return;
    finding.text += "; " + percent(stray) + " of what stands still by the matrices moves: it deforms, or has no matrix";
    if (stray > 1 - kMost) finding.verdict = Verdict::suspicious;
  }

  /// Which keys could as well be read otherwise.
  void tell_ambiguity(Finding& finding) const {
    if (!frame_.motion->stored) return;
    std::string keys;
    for (const Conventions& change : other_readings(frame_)) {
      if (count_settings(change) > 1) break;
      const std::string key = change.sign ? "the sign" : change.unit ? "the unit" : change.y ? "whether y points down" : "jitter";
      if (keys.find(key) == std::string::npos && read_with(change).share() >= kEnough) keys += (keys.empty() ? "" : ", ") + key;
    }
    if (!keys.empty()) finding.text += "; these frames do not tell " + keys;
  }

  /// A reading explains clearly more than the present one: twice as much, or it leaves a quarter unexplained. What is blurred at
  /// edges or deforms agrees with no reading, so that two of which one is right never come near each other.
  bool is_better(const Comparison& other) const {
    const double now = present_.share(), then = other.share();
    const bool better = then >= 2 * now || 1 - then <= (1 - now) / 4;
    return then >= kMost && better && (then - now) * static_cast<double>(present_.moving) >= 16;
  }

  std::optional<Remedy> find_remedy() const {
    if (!frame_.motion->stored) return std::nullopt;
    std::optional<Remedy> remedy;
    double best = 0;
    for (const Conventions& change : other_readings(frame_)) {
      const Comparison other = read_with(change);
      if (!is_better(other) || other.share() < best) continue;
      best = other.share() + 0.02;  // a reading that changes more has to be better still
      remedy = Remedy{frame_.motion->name, change};
    }
    return remedy;
  }

  Finding judge_sky() const {
    Finding finding{Verdict::ok, kSkyMotionSubject, ""};
    finding.figures = {{"disagreeing_share", 1 - present_.sky_share()}};
    finding.text = percent(present_.sky_share()) + " is that of points at infinity";
    if (present_.sky_share() >= kEnough) return finding;
    const bool none = Comparison::ratio(present_.sky_zero, present_.sky) >= kEnough;
    // A wrong convention is told of the surfaces; a background without motion is usual, and harms only what is seen there.
    finding.verdict = none ? Verdict::ok : Verdict::suspicious;
    finding.text = none ? "there is none: the background is not followed while the camera turns"
                        : "only " + finding.text + "; the background's history will be looked for in the wrong place";
    return finding;
  }

  const FrameData& frame_;
  const Surfaces& surfaces_;
  Image expected_, map_;
  Comparison present_;
};

const char* reason_not_to(const FrameData& frame, const Surfaces& surfaces) {
  const Size size = frame.motion->image.size();
  if (!frame.camera) return "there is no camera";
  if (!frame.previous) return "there is no camera of the frame before";
  if (frame.camera->size != size || frame.previous->size != size) return "a camera is of another size";
  if (!surfaces.has_points()) return "there are neither positions that land on their pixels, nor depth";
  return nullptr;
}

}  // namespace

std::vector<Finding> check_motion(const FrameData& frame) {
  if (!frame.motion) return {};
  const Surfaces surfaces(frame, frame.motion->image.size());
  if (const char* reason = reason_not_to(frame, surfaces)) return {Finding{Verdict::not_tested, kMotionSubject, reason}};
  return MotionCheck(frame, surfaces).run();
}

}  // namespace quell
