// What the conformance checks share: a pass run on made-up frames, and its results compared. Private to this box.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "quell/testing/conformance_checks.h"

namespace quell::conformance {

inline constexpr Size kOddSize{37, 19};

/// The first of the types that a port accepts.
PortType first_type(const quell_port_desc& port);
inline bool carries_image(const quell_port_desc& port) { return is_image(first_type(port)); }
/// How many items the checks give a port: two to an array.
inline int items_of(const quell_port_desc& port) { return port.flags & QUELL_PORT_ARRAY ? 2 : 1; }
std::vector<const quell_port_desc*> inputs(const PassTest& pass);
std::vector<const quell_port_desc*> outputs(const PassTest& pass);

/// A made-up item for a port. Each port sees the scene a little differently, so that `camera` and `previous_camera` are not the
/// same.
Item made_up(const quell_port_desc& port, Size size, std::uint32_t seed, int spare_lines = 0);
/// Gives every input made-up items.
void connect(PassTest& pass, Size size, std::uint32_t seed = 0);
/// Gives an input made-up items, with `spare_lines` cache lines more to each row. `change` may make another of the first item.
void connect_port(PassTest& pass, const quell_port_desc& port, Size size, std::uint32_t seed = 0, int spare_lines = 0,
                  const std::function<Item(const Item&)>& change = {});

/// Everything that the pass has computed, by "port[item]".
using Results = std::vector<std::pair<std::string, Item>>;
Results run(PassTest& pass);

/// Calls found(x, y) for every pixel whose bits differ, and stops when it returns true. Both are of one size.
void find_difference(const Image& a, const Image& b, const std::function<bool(int x, int y)>& found);
void expect_same(const Results& want, const Results& got, const std::string& when, Violations& violations);
void expect_finite(const Results& all, Size size, Violations& violations);

std::string at(int x, int y);
/// "on 37 x 19 pixels"
std::string text(Size size);

/// Runs body and turns what it throws into a violation.
template <class Body>
void contained(Violations& violations, const std::string& when, const Body& body) {
  try {
    body();
  } catch (const std::exception& error) { violations.push_back("throws " + when + ": " + error.what()); }
}

}  // namespace quell::conformance
