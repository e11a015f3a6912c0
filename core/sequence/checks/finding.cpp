#include "quell/sequence/checks/finding.h"

#include <algorithm>

namespace quell {

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::not_tested:
      return "not tested";
    case Verdict::ok:
      return "ok";
    case Verdict::suspicious:
      return "suspicious";
    case Verdict::wrong:
      return "WRONG";
  }
  return "";
}

std::optional<double> figure(const Finding& finding, std::string_view name) {
  const auto found =
      std::find_if(finding.figures.begin(), finding.figures.end(), [&](const Figure& f) { return f.name == name; });
  if (found == finding.figures.end()) return std::nullopt;
  return found->value;
}

std::vector<Finding> worst_of(const std::vector<Finding>& findings) {
  const auto alarm = [](const Finding& finding) {
    return std::pair{finding.verdict, finding.figures.empty() ? 0.0 : finding.figures.front().value};
  };
  std::vector<Finding> worst;
  for (const Finding& finding : findings) {
    const auto same = std::find_if(worst.begin(), worst.end(), [&](const Finding& w) { return w.subject == finding.subject; });
    if (same == worst.end())
      worst.push_back(finding);
    else if (alarm(*same) < alarm(finding))
      *same = finding;
  }
  return worst;
}

}  // namespace quell
