// Object ids: integers, with matrices, and a background that other inputs know as such.
#include <cmath>
#include <map>
#include <set>

#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/geometry.h"
#include "quell/sequence/checks/statistics.h"

namespace quell {
namespace {

constexpr double kDiffering = 0.02;  // share of the pixels in which background may differ: edges of averaged inputs do
constexpr double kEnough = 0.9;

std::string count(std::size_t n, const std::string& noun) { return std::to_string(n) + " " + noun + (n == 1 ? "" : "s"); }

Finding tell_fractions(const CheckedImage& id) {
  const FloatImage stored = id.stored.floats();
  std::size_t fractions = 0;
  std::string example;
  for (int y = 0; y < stored.height; ++y) {
    for (int x = 0; x < stored.width; ++x) {
      const float value = stored.at(x, y);
      if (value == std::floor(value)) continue;
      if (fractions++ == 0) example = "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") holds " + short_number(value);
    }
  }
  if (fractions == 0) return {Verdict::wrong, kIdSubject, "they cannot be read: some are no object's index"};
  return {
      Verdict::wrong, kIdSubject,
      count(fractions, "pixel") + (fractions == 1 ? " holds" : " hold") + " no integer: " + example +
          "; ids that are averaged over a pixel cannot be used, render them without a pixel filter or choose another channel"};
}

Finding check_objects(const FrameData& frame) {
  if (!frame.id->image) return tell_fractions(*frame.id);
  const IdImage ids = frame.id->image.ids();
  std::set<std::uint32_t> objects;
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x)
      if (ids.at(x, y) != QUELL_NO_ID) objects.insert(ids.at(x, y));
  Finding finding{Verdict::ok, kIdSubject, count(objects.size(), "object") + " in view"};
  if (objects.empty()) finding.verdict = Verdict::suspicious;
  if (!frame.camera || objects.empty()) return finding;
  std::size_t without = 0;
  for (const std::uint32_t object : objects) without += frame.camera->object_to_world.contains(object) ? 0 : 1;
  finding.figures = {{"without_matrix", static_cast<double>(without)}, {"objects", static_cast<double>(objects.size())}};
  if (without == 0)
    finding.text += ", each with a matrix";
  else if (frame.camera->object_to_world.empty())
    finding.text += "; the camera has no matrices of objects, so that all stand still";
  else
    finding.text += "; " + std::to_string(without) + " of them have no matrix, and are taken to stand still";
  if (without == objects.size() && !frame.camera->object_to_world.empty()) finding.verdict = Verdict::suspicious;
  return finding;
}

/// Where ids and the other inputs see background.
struct Background {
  std::size_t pixels = 0;
  std::size_t by_id = 0, by_others = 0, by_both = 0;
  std::map<float, std::size_t> stored;  ///< what the file holds where the others see background
  std::map<float, std::size_t> of_surfaces;

  double share(std::size_t n) const { return static_cast<double>(n) / static_cast<double>(pixels); }
  std::size_t differing() const { return by_id + by_others - 2 * by_both; }
};

Background look_at(const CheckedImage& id, const Surfaces& others) {
  Background result;
  const IdImage ids = id.image.ids();
  for (int y = 0; y < ids.height; ++y) {
    for (int x = 0; x < ids.width; ++x) {
      const bool by_id = ids.at(x, y) == QUELL_NO_ID, by_others = !others.has(x, y);
      ++result.pixels, result.by_id += by_id, result.by_others += by_others, result.by_both += by_id && by_others;
      if (id.stored) ++(by_others ? result.stored : result.of_surfaces)[id.stored.floats().at(x, y)];
    }
  }
  return result;
}

/// The value that stands where the other inputs see background, and nearly nowhere else.
std::optional<float> find_value(const Background& background) {
  for (const auto& [value, pixels] : background.stored) {
    if (static_cast<double>(pixels) < kEnough * static_cast<double>(background.by_others)) continue;
    const auto elsewhere = background.of_surfaces.find(value);
    if (elsewhere != background.of_surfaces.end() && elsewhere->second * 10 > pixels) continue;
    return value;
  }
  return std::nullopt;
}

void judge(Finding& finding, const FrameData& frame, const Background& background) {
  const auto value = find_value(background);
  if (background.share(background.by_others) > kDiffering && value) {
    finding.verdict = Verdict::wrong;
    finding.text = "where " + std::string(frame.depth ? "depth" : "position") + " has no surface, the id is " +
                   short_number(*value) + ", which is read as " +
                   (background.by_both * 2 > background.by_others ? "background among others" : "an object");
    finding.remedy = Remedy{frame.id->name, {}};
    finding.remedy->settings.background = static_cast<std::int64_t>(*value);
    return;
  }
  finding.text = percent(background.share(background.differing())) +
                 " of the pixels are background by the ids or by the other inputs, not by both";
  finding.verdict = Verdict::suspicious;
  // Depth that is there makes a surface; positions alone might be those of a sky.
  const bool objects_lost = background.by_both * 2 < background.by_id && background.by_others * 2 < background.by_id;
  if (!objects_lost || background.of_surfaces.contains(-1) || !frame.id->stored) return;
  finding.text = percent(background.share(background.by_id - background.by_both)) +
                 " of the pixels are background by the ids, though there are surfaces: an object has the background's number";
  finding.verdict = frame.depth ? Verdict::wrong : Verdict::suspicious;
  finding.remedy = Remedy{frame.id->name, {}};
  finding.remedy->settings.background = -1;
}

Finding check_background(const FrameData& frame) {
  FrameData without = frame;
  without.id.reset();
  const Surfaces others(without, frame.id->image.size());
  if (!others.known())
    return {Verdict::not_tested, kBackgroundSubject, "neither depth nor positions tell where there is no surface"};
  const Background background = look_at(*frame.id, others);
  const std::string share = percent(background.share(background.by_id));
  Finding finding{Verdict::ok, kBackgroundSubject,
                  background.by_id + background.by_others == 0
                      ? "every pixel shows a surface"
                      : share + " of the pixels, where the other inputs have no surface, either"};
  finding.figures = {{"differing_share", background.share(background.differing())}};
  if (background.share(background.differing()) > kDiffering) judge(finding, frame, background);
  return finding;
}

}  // namespace

std::vector<Finding> check_ids(const FrameData& frame) {
  if (!frame.id) return {};
  std::vector<Finding> findings{check_objects(frame)};
  if (frame.id->image) findings.push_back(check_background(frame));
  return findings;
}

}  // namespace quell
