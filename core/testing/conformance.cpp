#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "quell/plugin/registry.h"
#include "quell/testing/conformance_checks.h"
#include "quell/testing/synthetic.h"
#include "quell/text/error.h"

namespace quell::conformance {
namespace {

constexpr Size kOddSize{37, 19};

PortType first_type(const quell_port_desc& port) {
  for (std::uint32_t type = 0; type < QUELL_TYPE_COUNT; ++type)
    if (port.types & QUELL_TYPE_BIT(type)) return static_cast<PortType>(type);
  return QUELL_TYPE_COLOR;
}

std::vector<const quell_port_desc*> ports(const quell_port_desc* first, std::uint32_t count) {
  std::vector<const quell_port_desc*> list;
  for (std::uint32_t i = 0; i < count; ++i) list.push_back(QUELL_AT(quell_port_desc, first, i));
  return list;
}
std::vector<const quell_port_desc*> inputs(const PassTest& pass) { return ports(pass.desc().inputs, pass.desc().input_count); }
std::vector<const quell_port_desc*> outputs(const PassTest& pass) { return ports(pass.desc().outputs, pass.desc().output_count); }
const quell_port_desc& input_port(const PassTest& pass, std::string_view name) {
  const auto list = inputs(pass);
  return **std::ranges::find_if(list, [&](const quell_port_desc* port) { return port->name == name; });
}
int items_of(const quell_port_desc& port) { return port.flags & QUELL_PORT_ARRAY ? 2 : 1; }
bool carries_image(const quell_port_desc& port) { return is_image(first_type(port)); }

// Each port sees the scene a little differently, so that `camera` and `previous_camera` are not the same.
Item made_up(const quell_port_desc& port, Size size, std::uint32_t seed, int spare_lines = 0) {
  const std::string_view name = port.name;
  const std::uint32_t earlier = name.starts_with("previous") || name.starts_with("history") ? 1 : 0;
  return synthetic(first_type(port), size, seed + earlier, spare_lines);
}

void connect(PassTest& pass, Size size, std::uint32_t seed = 0, int spare_lines = 0) {
  for (const quell_port_desc* port : inputs(pass)) {
    pass.disconnect(port->name);
    for (int i = 0; i < items_of(*port); ++i)
      pass.input(port->name, made_up(*port, size, seed + 10 * static_cast<std::uint32_t>(i), spare_lines));
  }
}

// Everything that the pass has computed, by "port[item]".
using Results = std::vector<std::pair<std::string, Item>>;

Results results(PassTest& pass) {
  Results all;
  for (const quell_port_desc* port : outputs(pass))
    for (int i = 0; i < items_of(*port); ++i)
      all.emplace_back(std::string(port->name) + "[" + std::to_string(i) + "]", pass.output_item(port->name, i));
  return all;
}
Results run(PassTest& pass) {
  pass.run();
  return results(pass);
}

std::string at(int x, int y) { return "(" + std::to_string(x) + ", " + std::to_string(y) + ")"; }

// The bits of a pixel's plane, whatever the format.
std::uint32_t bits(const Image& image, int x, int y, int c) {
  const quell_image raw = image.raw();
  std::uint32_t value = 0;
  std::memcpy(&value, static_cast<const float*>(raw.data) + c * raw.plane_stride + y * raw.row_stride + x, sizeof(value));
  return value;
}

// Calls found(x, y) for every pixel that differs, and stops when it returns true.
template <class Found>
void find_difference(const Image& a, const Image& b, const Found& found) {
  for (int c = 0; c < a.channels(); ++c)
    for (int y = 0; y < a.height(); ++y)
      for (int x = 0; x < a.width(); ++x)
        if (bits(a, x, y, c) != bits(b, x, y, c) && found(x, y)) return;
}

void expect_same(const Results& want, const Results& got, const std::string& when, Violations& violations) {
  for (std::size_t i = 0; i < want.size(); ++i) {
    const Image* a = want[i].second.image();
    const Image* b = got[i].second.image();
    if (!a) {
      if (want[i].second.values() && *want[i].second.values() != *got[i].second.values())
        violations.push_back(want[i].first + " has other values " + when);
      continue;
    }
    if (a->size() != b->size()) {
      violations.push_back(want[i].first + " has another size " + when);
      continue;
    }
    find_difference(*a, *b, [&](int x, int y) {
      violations.push_back(want[i].first + " differs at " + at(x, y) + " " + when);
      return true;
    });
  }
}

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

// Runs body and turns what it throws into a violation.
template <class Body>
void contained(Violations& violations, const std::string& when, const Body& body) {
  try {
    body();
  } catch (const std::exception& error) { violations.push_back("throws " + when + ": " + error.what()); }
}

std::string text(Size size) { return "on " + std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels"; }

void expect_finite(const Results& all, Size size, Violations& violations) {
  for (const auto& [name, item] : all) {
    if (!item.image() || info(item.image()->type()).format != QUELL_FORMAT_F32) continue;
    const FloatImage image = item.image()->floats();
    for (int i = 0; i < image.channels * image.width * image.height; ++i) {
      const int x = i % image.width, y = i / image.width % image.height, c = i / image.width / image.height;
      if (std::isfinite(image.at(x, y, c))) continue;
      violations.push_back(name + " is not written, or not finite, at " + at(x, y) + " " + text(size));
      break;
    }
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
        pass.input(port->name, change(made_up(*port, size, 0), x, y));
        expect_local(before, run(pass.next_frame(0)), x, y, reach, when, violations);
      });
    }
  }
}

}  // namespace

Violations check_description(const MakePass& make) {
  const PassTest pass = make();
  const quell_pass_desc& desc = pass.desc();
  Violations violations;
  if (std::string wrong = quell::check(desc); !wrong.empty()) violations.push_back(std::move(wrong));
  const auto documented = [&](const char* text_of, const std::string& what) {
    if (!text_of || !*text_of) violations.push_back(what + " is not documented");
  };
  documented(desc.summary, "the summary");
  documented(desc.source, "the source (paper and equations)");
  for (const quell_port_desc* port : inputs(pass)) documented(port->doc, std::string("input '") + port->name + "'");
  for (const quell_port_desc* port : outputs(pass)) documented(port->doc, std::string("output '") + port->name + "'");
  for (std::uint32_t i = 0; i < desc.param_count; ++i) {
    const quell_param_desc& param = *QUELL_AT(quell_param_desc, desc.params, i);
    documented(param.doc, std::string("parameter '") + param.name + "'");
    for (std::uint32_t e = 0; e < param.enum_count; ++e)
      documented(param.enum_docs ? param.enum_docs[e] : nullptr,
                 std::string("value '") + param.enum_values[e] + "' of '" + param.name + "'");
  }
  return violations;
}

Violations check_sizes(const MakePass& make) {
  Violations violations;
  for (const Size size : {Size{1, 1}, Size{1, 7}, Size{7, 1}, Size{3, 5}, Size{16, 2}, Size{17, 9}, Size{33, 8}, Size{65, 3}})
    contained(violations, text(size), [&] {
      PassTest pass = make();
      connect(pass, size);
      expect_finite(run(pass), size, violations);
    });
  return violations;
}

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

Violations check_in_place(const MakePass& make) {
  Violations violations;
  PassTest pass = make();
  connect(pass, kOddSize);
  const Results want = run(pass.next_frame(0));
  PassTest moving = make();
  moving.in_place();
  for (const quell_port_desc* output : outputs(pass)) {
    connect(moving, kOddSize);
    const std::string source = moving.in_place_of(output->name);
    if (source.empty()) continue;
    contained(violations, "in place", [&] {
      Image image = *made_up(input_port(moving, source), kOddSize, 0).image();
      const void* memory = image.buffer().data();
      moving.disconnect(source).input(source, std::move(image));
      const Results got = run(moving.next_frame(0));
      expect_same(want, got, "when '" + std::string(output->name) + "' takes over the memory of '" + source + "'", violations);
      if (moving.output_item(output->name).image()->buffer().data() != memory)
        violations.push_back("'" + std::string(output->name) + "' could not take over the memory of '" + source + "'");
    });
  }
  return violations;
}

Violations check_strides(const MakePass& make) {
  Violations violations;
  contained(violations, "with other strides", [&] {
    PassTest pass = make();
    connect(pass, kOddSize);
    const Results want = run(pass.next_frame(0));
    for (const quell_port_desc* port : inputs(pass)) {
      connect(pass, kOddSize);
      pass.disconnect(port->name);
      for (int i = 0; i < items_of(*port); ++i)
        pass.input(port->name, made_up(*port, kOddSize, 10 * static_cast<std::uint32_t>(i), 3));
      expect_same(want, run(pass.next_frame(0)),
                  std::string("when the rows and planes of '") + port->name + "' lie farther apart", violations);
    }
  });
  return violations;
}

Violations check_chunks(const MakePass& make) {
  Violations violations;
  contained(violations, "with other chunks", [&] {
    PassTest pass = make();
    connect(pass, kOddSize);
    const Results want = run(pass.next_frame(0));
    for (const int grain : {1, 3, 1 << 20}) {
      pass.grain(grain);
      expect_same(want, run(pass.next_frame(0)), "with chunks of " + std::to_string(grain) + " rows", violations);
    }
    pass.grain(0).threads(4);
    expect_same(want, run(pass.next_frame(0)), "with 4 threads", violations);
  });
  return violations;
}

Violations check_purity(const MakePass& make) {
  Violations violations;
  contained(violations, "when it runs again", [&] {
    PassTest pass = make();
    connect(pass, kOddSize, 0);
    const Results want = run(pass.next_frame(5));
    connect(pass, kOddSize, 3);
    run(pass.next_frame(6));
    connect(pass, kOddSize, 0);
    expect_same(want, run(pass.next_frame(5)), "when the same frame is computed again after another one", violations);
  });
  return violations;
}

Violations check_optional_inputs(const MakePass& make) {
  Violations violations;
  const auto try_without = [&](const std::vector<std::string>& absent, const std::string& when) {
    PassTest pass = make();
    connect(pass, kOddSize);
    for (const std::string& port : absent) pass.disconnect(port);
    try {
      expect_finite(run(pass), kOddSize, violations);
    } catch (const Error& error) {
      if (error.fault() != Fault::usage)
        violations.push_back("fails " + when + " instead of refusing before it runs: " + error.what());
    } catch (const std::exception& error) { violations.push_back("throws " + when + ": " + error.what()); }
  };
  std::vector<std::string> all;
  for (const quell_port_desc* port : inputs(make()))
    if (port->flags & QUELL_PORT_OPTIONAL) all.emplace_back(port->name);
  for (const std::string& port : all) try_without({port}, "without '" + port + "'");
  if (all.size() > 1) try_without(all, "without any optional input");
  return violations;
}

}  // namespace quell::conformance
