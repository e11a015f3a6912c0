#include "tests/core/graph/schema_variants.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "quell/image/port_type.h"
#include "quell/plugin/pass_instance.h"
#include "quell/text/json.h"

namespace quell::test {
namespace {

using Members = std::map<std::string, std::string>;  // values as JSON

std::string object(const Members& members) {
  std::string text;
  for (const auto& [key, value] : members) text += (text.empty() ? "" : ", ") + quote_json(key) + ": " + value;
  return "{ " + text + " }";
}

std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string repeat(const std::string& element, std::uint32_t count) {
  std::string list;
  for (std::uint32_t i = 0; i < count; ++i) list += (i ? ", " : "") + element;
  return "[" + list + "]";
}

class Maker {
 public:
  Maker(const quell_pass_desc& pass, std::vector<Variant>& variants) : pass_(pass), variants_(variants) {
    for (std::uint32_t i = 0; i < pass.input_count; ++i) {
      const quell_port_desc& port = input(i);
      inputs_["in_" + std::string(port.name)] =
          quote_json(name(static_cast<PortType>(std::countr_zero(port.types))));  // the first type that it takes
      sources_[port.name] = port.flags & QUELL_PORT_ARRAY ? "[" + source(i) + "]" : source(i);
    }
  }

  void run() {
    add("as it is", true, {{"in", object(sources_)}});
    for (std::uint32_t i = 0; i < pass_.input_count; ++i) vary_input(input(i), i);
    for (std::uint32_t i = 0; i < pass_.param_count; ++i) vary_param(*QUELL_AT(quell_param_desc, pass_.params, i));
    with_input("an unknown input", false, "no_such_port", "\"in_x\"");
    with_param("an unknown parameter", false, "no_such_param", "1");
    add("an unknown key", false, {{"in", object(sources_)}, {"inputs", "{}"}});
    add("its version", true, {{"in", object(sources_)}, {"version", std::to_string(pass_.version)}});
    add("a newer version", false, {{"in", object(sources_)}, {"version", std::to_string(pass_.version + 1)}});
    add("a version too old", false, {{"in", object(sources_)}, {"version", std::to_string(pass_.oldest_version - 1)}});
  }

 private:
  const quell_port_desc& input(std::uint32_t i) const { return *QUELL_AT(quell_port_desc, pass_.inputs, i); }
  std::string source(std::uint32_t i) const { return quote_json("in_" + std::string(input(i).name)); }

  void add(const std::string& what, bool is_right, Members node) {
    node["pass"] = quote_json(pass_.id);
    const std::string text = object({{"quell", "1"},
                                     {"inputs", object(inputs_)},
                                     {"nodes", object({{"node", object(node)}})},
                                     {"outputs", R"({ "out": "in_x" })"}});
    variants_.push_back({std::string(pass_.id) + ": " + what, text, is_right});
  }
  void with_input(const std::string& what, bool is_right, const std::string& port, const std::string& value) {
    Members sources = sources_;
    sources[port] = value;
    add(what, is_right, {{"in", object(sources)}});
  }
  void with_param(const std::string& what, bool is_right, const std::string& param, const std::string& value) {
    add(what, is_right, {{"in", object(sources_)}, {"params", object({{param, value}})}});
  }

  void vary_input(const quell_port_desc& port, std::uint32_t i) {
    const std::string label = std::string(port.name);
    const bool optional = port.flags & QUELL_PORT_OPTIONAL, is_array = port.flags & QUELL_PORT_ARRAY;
    const auto edge = [&](const std::string& rest) {
      const std::string text = "{ \"from\": " + source(i) + rest + " }";
      return is_array ? "[" + text + "]" : text;
    };
    if (!optional) {
      Members fewer = sources_;
      fewer.erase(port.name);
      add(label + " missing", false, {{"in", object(fewer)}});
    }
    with_input(label + " of none at first", optional, port.name, edge(R"(, "delay": 1, "initial": "none")"));
    with_input(label + " from the frame itself at first", true, port.name,
               edge(R"(, "delay": 2, "initial": { "from": )" + source(i) + " }"));
    with_input(label + " delayed without an initial value", false, port.name, edge(R"(, "delay": 1)"));
    with_input(label + " with an initial value alone", false, port.name, edge(R"(, "initial": "none")"));
    with_input(label + " with an empty constant", false, port.name, edge(R"(, "delay": 1, "initial": { "constant": [] })"));
    with_input(label + " with an unknown key", false, port.name, edge(R"(, "dealy": 1)"));
    with_input(label + " a number", false, port.name, is_array ? "[1]" : "1");
    with_input(label + " with spaces", false, port.name, is_array ? "[\"in x\"]" : "\"in x\"");
    if (!is_array) return with_input(label + " a list", false, port.name, "[" + source(i) + "]");
    with_input(label + " an empty list", optional, port.name, "[]");
    with_input(label + " a list of lists", false, port.name, "[[" + source(i) + "]]");
    with_input(label + " not a list", true, port.name, source(i));
    with_input(label + " not a list, with spaces", false, port.name, "\"in x\"");
    with_input(label + " not a list, but a number", false, port.name, "1");
    with_input(label + " not a list, of none at first", optional, port.name,
               R"({ "from": )" + source(i) + R"(, "delay": 1, "initial": "none" })");
    with_input(label + " not a list, delayed without an initial value", false, port.name,
               R"({ "from": )" + source(i) + R"(, "delay": 1 })");
  }

  void vary_param(const quell_param_desc& param) {
    const std::string label = param.name;
    const std::string standard = to_json(param, default_value(param));
    with_param(label + " by default", true, label, standard);
    with_param(label + " null", false, label, "null");
    with_param(label + (param.is_array ? " not a list" : " a list"), false, label, param.is_array ? "1" : "[" + standard + "]");
    const std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
    const auto value = [&](const std::string& element) {
      return param.is_array ? repeat(element, param.min_count + 1) : element;
    };
    if (param.is_array && param.min_count > 0)
      with_param(label + " too short", false, label, repeat(first_value(param), param.min_count - 1));
    if (param.is_array && param.max_count < most)
      with_param(label + " too long", false, label, repeat(first_value(param), param.max_count + 1));
    if (!param.is_array || param.max_count > param.min_count) vary_element(param, value);
  }

  static std::string first_value(const quell_param_desc& param) {
    if (param.type == QUELL_PARAM_BOOL) return "true";
    if (param.type == QUELL_PARAM_ENUM) return quote_json(param.enum_values[0]);
    const bool is_number = param.type == QUELL_PARAM_INT || param.type == QUELL_PARAM_DOUBLE;
    return is_number ? number(std::max(param.min_value, std::min(param.max_value, 1.0))) : "\"text\"";
  }

  template <class Value>
  void vary_element(const quell_param_desc& param, const Value& value) {
    const std::string label = param.name;
    const bool is_text = param.type == QUELL_PARAM_STRING || param.type == QUELL_PARAM_PATH;
    with_param(label + " of the wrong type", false, label, value(is_text || param.type == QUELL_PARAM_BOOL ? "1" : "true"));
    with_param(label + " an object", false, label, value("{}"));
    if (is_text) with_param(label + " with a zero", false, label, value("\"a\\u0000b\""));
    for (std::uint32_t i = 0; param.type == QUELL_PARAM_ENUM && i < param.enum_count; ++i)
      with_param(label + " " + param.enum_values[i], true, label, value(quote_json(param.enum_values[i])));
    if (param.type == QUELL_PARAM_ENUM) with_param(label + " not in the enum", false, label, value("\"no such value\""));
    if (param.type == QUELL_PARAM_INT) {
      with_param(label + " a fraction", false, label,
                 value(number(std::max(param.min_value, std::min(0.0, param.max_value - 1)) + 0.5)));
      with_param(label + " beyond 64 bits", false, label, value("1e30"));
      vary_bounds(param, value, 1, 0x1p53);
    } else if (param.type == QUELL_PARAM_DOUBLE) {
      vary_bounds(param, value, 0, std::numeric_limits<double>::max());
    }
  }

  // Bounds of the type itself have nothing beyond them that can be written.
  template <class Value>
  void vary_bounds(const quell_param_desc& param, const Value& value, double step, double widest) {
    const std::string label = param.name;
    const double least = param.min_value, most = param.max_value, infinity = std::numeric_limits<double>::infinity();
    if (least > -widest) {
      with_param(label + " at its least", true, label, value(number(least)));
      with_param(label + " below its range", false, label,
                 value(number(step > 0 ? least - step : std::nextafter(least, -infinity))));
    }
    if (most < widest) {
      with_param(label + " at its most", true, label, value(number(most)));
      with_param(label + " above its range", false, label,
                 value(number(step > 0 ? most + step : std::nextafter(most, infinity))));
    }
  }

  const quell_pass_desc& pass_;
  std::vector<Variant>& variants_;
  Members inputs_{{"in_x", "\"color\""}}, sources_;
};

}  // namespace

std::vector<Variant> make_variants(const Registry& passes) {
  std::vector<Variant> variants;
  for (const auto& [id, pass] : passes.passes()) Maker(*pass.desc, variants).run();
  return variants;
}

}  // namespace quell::test
