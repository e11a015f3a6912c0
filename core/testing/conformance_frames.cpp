#include "quell/testing/conformance_frames.h"

#include <cmath>
#include <cstring>

#include "quell/testing/synthetic.h"

namespace quell::conformance {
namespace {

std::vector<const quell_port_desc*> ports(const quell_port_desc* first, std::uint32_t count) {
  std::vector<const quell_port_desc*> list;
  for (std::uint32_t i = 0; i < count; ++i) list.push_back(QUELL_AT(quell_port_desc, first, i));
  return list;
}

Results results(PassTest& pass) {
  Results all;
  for (const quell_port_desc* port : outputs(pass))
    for (int i = 0; i < items_of(*port); ++i)
      all.emplace_back(std::string(port->name) + "[" + std::to_string(i) + "]", pass.output_item(port->name, i));
  return all;
}

// The bits of a pixel's plane, whatever the format.
std::uint32_t bits(const Image& image, int x, int y, int c) {
  const quell_image raw = image.raw();
  std::uint32_t value = 0;
  std::memcpy(&value, static_cast<const float*>(raw.data) + c * raw.plane_stride + y * raw.row_stride + x, sizeof(value));
  return value;
}

}  // namespace

PortType first_type(const quell_port_desc& port) {
  for (std::uint32_t type = 0; type < QUELL_TYPE_COUNT; ++type)
    if (port.types & QUELL_TYPE_BIT(type)) return static_cast<PortType>(type);
  return QUELL_TYPE_COLOR;
}

std::vector<const quell_port_desc*> inputs(const PassTest& pass) { return ports(pass.desc().inputs, pass.desc().input_count); }
std::vector<const quell_port_desc*> outputs(const PassTest& pass) { return ports(pass.desc().outputs, pass.desc().output_count); }

Item made_up(const quell_port_desc& port, Size size, std::uint32_t seed, int spare_lines) {
  const std::string_view name = port.name;
  const std::uint32_t earlier = name.starts_with("previous") || name.starts_with("history") ? 1 : 0;
  return synthetic(first_type(port), size, seed + earlier, spare_lines);
}

void connect(PassTest& pass, Size size, std::uint32_t seed) {
  for (const quell_port_desc* port : inputs(pass)) connect_port(pass, *port, size, seed);
}

void connect_port(PassTest& pass, const quell_port_desc& port, Size size, std::uint32_t seed, int spare_lines,
                  const std::function<Item(const Item&)>& change) {
  pass.disconnect(port.name);
  for (int i = 0; i < items_of(port); ++i) {
    const Item item = made_up(port, size, seed + 10 * static_cast<std::uint32_t>(i), spare_lines);
    pass.input(port.name, change && i == 0 ? change(item) : item);
  }
}

Results run(PassTest& pass) {
  pass.run();
  return results(pass);
}

void find_difference(const Image& a, const Image& b, const std::function<bool(int, int)>& found) {
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

std::string at(int x, int y) { return "(" + std::to_string(x) + ", " + std::to_string(y) + ")"; }

std::string text(Size size) { return "on " + std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels"; }

}  // namespace quell::conformance
