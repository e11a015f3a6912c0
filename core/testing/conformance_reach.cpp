// How far a change of one pixel may reach.
#include <algorithm>
#include <cstdlib>
#include <limits>

#include "quell/testing/conformance_frames.h"
#include "quell/testing/synthetic.h"

namespace quell::conformance {
namespace {

// Pixels farther than `radius` from (x, y) must not have changed.
void expect_local(const Results& before, const Results& after, int x, int y, int radius, const std::string& when,
                  Violations& violations) {
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Image* a = before[i].second.image();
    const Image* b = after[i].second.image();
    if (!a || a->size() != b->size()) continue;
    find_difference(*a, *b, [&](int px, int py) {
      const int distance = std::max(std::abs(px - x), std::abs(py - y));
      if (distance <= radius) return false;
      violations.push_back(before[i].first + " changes at " + at(px, py) + ", " + std::to_string(distance) + " pixels away, " +
                           when + "; the declared radius is " + std::to_string(radius));
      return true;
    });
  }
}

template <class Change>
void check_changes(const MakePass& make, const std::string& what, bool floats_only, bool also_unbounded, const Change& change,
                   Violations& violations) {
  PassTest pass = make();
  connect(pass, kOddSize);
  for (const quell_port_desc* port : inputs(pass)) {
    if (!carries_image(*port) || (floats_only && first_type(*port) == QUELL_TYPE_ID)) continue;
    connect(pass, kOddSize);
    const int declared = pass.radius(port->name);
    if (declared < 0 && !also_unbounded) continue;
    const int reach = declared < 0 ? std::numeric_limits<int>::max() : declared;
    const int margin = declared < 0 ? 0 : declared;
    const Size size{2 * margin + 9, 2 * margin + 7};
    for (const auto& [x, y] : {std::pair(margin + 4, margin + 3), std::pair(0, 0), std::pair(size.width - 1, size.height - 1)}) {
      const std::string when = "when " + what + " of '" + port->name + "' at " + at(x, y);
      contained(violations, when, [&] {
        connect(pass, size);
        const Results before = run(pass.next_frame(0));
        connect_port(pass, *port, size, 0, 0, [&, px = x, py = y](const Item& item) { return change(item, px, py); });
        expect_local(before, run(pass.next_frame(0)), x, y, reach, when, violations);
      });
    }
  }
}

}  // namespace

Violations check_radius(const MakePass& make) {
  Violations violations;
  check_changes(
      make, "another value is put into a pixel", false, false,
      [](const Item& item, int x, int y) { return with_other_pixel(item, x, y); }, violations);
  return violations;
}

Violations check_bad_values(const MakePass& make) {
  Violations violations;
  check_changes(
      make, "NaN and infinity are put into a pixel", true, true,
      [](const Item& item, int x, int y) { return with_bad_pixel(item, x, y); }, violations);
  return violations;
}

}  // namespace quell::conformance
