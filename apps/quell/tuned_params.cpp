#include "tuned_params.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "quell/text/diagnostic.h"
#include "quell/text/error.h"
#include "quell/text/json_write.h"

namespace quell::app {
namespace {

constexpr double kReach = 16;       // factor that a search goes from where it starts
constexpr double kFewValues = 256;  // of a whole number: all of them are searched

struct Bounds {
  double low, high;
};

const quell_param_desc& describe(const Graph& graph, const NodeParam& at) {
  return *QUELL_AT(quell_param_desc, graph.nodes[static_cast<std::size_t>(at.node)].pass->params, at.param);
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    parts.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

bool is_number(const quell_param_desc& desc) {
  return !desc.is_array && (desc.type == QUELL_PARAM_INT || desc.type == QUELL_PARAM_DOUBLE);
}

std::vector<std::string> known_names(const Graph& graph) {
  std::vector<std::string> names;
  for (const GraphParam& param : graph.params) names.push_back(param.name);
  for (const Node& node : graph.nodes)
    for (std::uint32_t i = 0; i < node.pass->param_count; ++i)
      if (const quell_param_desc& desc = *QUELL_AT(quell_param_desc, node.pass->params, i); is_number(desc))
        names.push_back(node.name + "." + desc.name);
  return names;
}

std::vector<NodeParam> find(const Graph& graph, const std::string& name) {
  for (const GraphParam& param : graph.params)
    if (param.name == name) return param.sets;
  for (std::size_t node = 0; node < graph.nodes.size(); ++node)
    for (std::uint32_t i = 0; i < graph.nodes[node].pass->param_count; ++i)
      if (const NodeParam at{static_cast<int>(node), i}; graph.nodes[node].name + "." + describe(graph, at).name == name)
        return {at};
  const std::vector<std::string> known = known_names(graph);
  const std::string close = did_you_mean(name, known);
  throw Error(Fault::usage, "--params",
              "the graph '" + graph.name + "' has no parameter '" + name + "'" +
                  (close.empty() ? "; those that are numbers are " + list_names(known, "and") : close));
}

bool same(const NodeParam& a, const NodeParam& b) { return a.node == b.node && a.param == b.param; }

double number_of(const ParamValue& value) {
  if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&value.elements)) return static_cast<double>(whole->front());
  return std::get<std::vector<double>>(value.elements).front();
}

/// What it is now, and how far it may go, for all that it sets.
struct Given {
  double value = 0;
  Bounds bounds{-HUGE_VAL, HUGE_VAL};
  bool is_whole = false;
};
Given look_up(const Graph& graph, const std::string& name) {
  Given given;
  const std::vector<NodeParam> sets = find(graph, name);
  if (sets.empty())
    throw Error(Fault::usage, "--params", "'" + name + "' sets nothing in the graph as it is with these inputs; leave it out");
  const auto value_at = [&](const NodeParam& at) {
    return number_of(graph.nodes[static_cast<std::size_t>(at.node)].instance->values()[at.param]);
  };
  for (const NodeParam& at : sets) {
    const quell_param_desc& desc = describe(graph, at);
    if (!is_number(desc))
      throw Error(
          Fault::usage, "--params",
          "'" + name + "' is not a number, so that there is nothing to search between; choose among its values with --set");
    given.value = value_at(at);
    if (given.value != value_at(sets.front()))
      throw Error(Fault::usage, "--params",
                  "'" + name + "' sets parameters that have different values now, " + number_text(value_at(sets.front())) +
                      " and " + number_text(given.value) + "; give it one first, with --set " + name + "=VALUE");
    given.bounds = {std::max(given.bounds.low, desc.min_value), std::min(given.bounds.high, desc.max_value)};
    given.is_whole = given.is_whole || desc.type == QUELL_PARAM_INT;
  }
  return given;
}

std::map<std::string, Bounds> parse_ranges(const std::vector<std::string>& ranges) {
  std::map<std::string, Bounds> parsed;
  for (const std::string& text : ranges) {
    const std::size_t equals = text.find('='), dots = text.find("..", std::min(equals, text.size()));
    Bounds bounds{};
    const auto read = [&](std::size_t begin, std::size_t end, double& number) {
      const auto [last, error] = std::from_chars(text.data() + begin, text.data() + end, number);
      return error == std::errc() && last == text.data() + end && std::isfinite(number);
    };
    const bool is_range = equals != std::string::npos && dots != std::string::npos && read(equals + 1, dots, bounds.low) &&
                          read(dots + 2, text.size(), bounds.high) && bounds.low < bounds.high;
    if (!is_range)
      throw Error(Fault::usage, "--range", "'" + text + "' is not a range; write PARAM=LOW..HIGH, such as blend.alpha=0.05..0.5");
    if (!parsed.emplace(text.substr(0, equals), bounds).second)
      throw Error(Fault::usage, "--range", "'" + text.substr(0, equals) + "' has two ranges; leave one of them out");
  }
  return parsed;
}

std::string text_of(const Bounds& bounds) { return number_text(bounds.low) + ".." + number_text(bounds.high); }

Bounds choose_bounds(const std::string& name, const Given& given, const Bounds* asked) {
  if (asked) {
    if (asked->low < given.bounds.low || asked->high > given.bounds.high)
      throw Error(Fault::usage, "--range", "'" + name + "' goes from " + text_of(given.bounds) + ", not " + text_of(*asked));
    return *asked;
  }
  if (given.bounds.low >= 0 && given.bounds.high <= 1) return given.bounds;
  if (given.is_whole && given.bounds.high - given.bounds.low < kFewValues) return given.bounds;
  if (given.value > 0)
    return {std::max(given.bounds.low, given.value / kReach), std::min(given.bounds.high, given.value * kReach)};
  throw Error(Fault::usage, "--params",
              "'" + name + "' is " + number_text(given.value) + ", which does not say where to search; add --range " + name +
                  "=LOW..HIGH");
}

}  // namespace

double TunedParam::value(double place) const {
  place = std::clamp(place, 0.0, 1.0);
  const double exact = is_geometric ? low * std::pow(high / low, place) : low + (high - low) * place;
  if (is_whole) return std::clamp(std::round(exact), std::ceil(low), std::floor(high));
  return std::clamp(std::strtod(number_text(exact).c_str(), nullptr), low, high);
}

double TunedParam::place(double value) const {
  value = std::clamp(value, low, high);
  const double exact = is_geometric ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return std::clamp(exact, 0.0, 1.0);
}

namespace {

// What two names that are searched both set would be searched twice.
void require_apart(const Graph& graph, const std::vector<TunedParam>& params, const std::string& name) {
  for (const TunedParam& other : params)
    for (const NodeParam& a : find(graph, other.name))
      for (const NodeParam& b : find(graph, name))
        if (same(a, b))
          throw Error(Fault::usage, "--params",
                      "'" + other.name + "' and '" + name + "' set the same parameter; leave one of them out");
}

Bounds whole(const std::string& name, const Bounds& bounds) {
  const Bounds inner{std::ceil(bounds.low), std::floor(bounds.high)};
  if (inner.low < inner.high) return inner;
  throw Error(Fault::usage, "--range",
              "'" + name + "' is a whole number, and " + text_of(bounds) +
                  (inner.low == inner.high ? " holds but one of them" : " holds none of them"));
}

}  // namespace

std::vector<TunedParam> find_tuned_params(const Graph& graph, const std::string& names, const std::vector<std::string>& ranges) {
  std::map<std::string, Bounds> asked = parse_ranges(ranges);
  std::vector<TunedParam> params;
  for (const std::string& name : split(names)) {
    if (std::ranges::find(params, name, &TunedParam::name) != params.end())
      throw Error(Fault::usage, "--params", "'" + name + "' stands there twice; leave one of them out");
    const Given given = look_up(graph, name);
    const auto range = asked.find(name);
    require_apart(graph, params, name);
    Bounds bounds = choose_bounds(name, given, range == asked.end() ? nullptr : &range->second);
    if (given.is_whole) bounds = whole(name, bounds);
    if (range != asked.end()) asked.erase(range);
    const bool is_geometric = bounds.low > 0 && (bounds.high > 4 * bounds.low);
    params.push_back({name, given.value, bounds.low, bounds.high, given.is_whole, is_geometric});
  }
  if (!asked.empty())
    throw Error(Fault::usage, "--range", "'" + asked.begin()->first + "' is not among those of --params; add it there");
  return params;
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

Json overrides(const std::vector<TunedParam>& params, const std::vector<double>& values) {
  JsonMembers members;
  for (std::size_t i = 0; i < params.size(); ++i) members.add(params[i].name, values[i]);
  return members.take();
}

}  // namespace quell::app
