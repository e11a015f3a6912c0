// Parameters of a pass: one `describe` names each of them once, and serves the descriptor and the reading of values.
//
//   struct Params {
//     int radius = 8;
//     Fetch fetch = Fetch::nearest;          // an enum class that counts from 0
//     void describe(auto&& field) {
//       field("radius", radius, Range<int>{0, 64}, "px", "Taps reach this far.");
//       field("fetch", fetch, Choices{{"nearest", "the closest pixel"}, {"bilinear", "four pixels"}}, "How to sample.");
//     }
//   };
#pragma once

#include <concepts>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "quell/sdk/abi.h"

namespace quell {

/// Inclusive bounds of a number.
template <class Number>
struct Range {
  Number min = std::numeric_limits<Number>::lowest();
  Number max = std::numeric_limits<Number>::max();
};

/// Inclusive bounds of an array's length.
struct Length {
  std::uint32_t min = 0;
  std::uint32_t max = std::numeric_limits<std::uint32_t>::max();
};

/// The values of an enum parameter, in the order of the enum's constants.
struct Choice {
  const char* name;
  const char* doc;
};
using Choices = std::initializer_list<Choice>;

namespace detail {

template <class T>
concept Number = (std::integral<T> && !std::same_as<T, bool>) || std::floating_point<T>;

template <class T>
constexpr std::uint32_t param_type() {
  if constexpr (std::same_as<T, bool>)
    return QUELL_PARAM_BOOL;
  else if constexpr (std::integral<T>)
    return QUELL_PARAM_INT;
  else if constexpr (std::floating_point<T>)
    return QUELL_PARAM_DOUBLE;
  else if constexpr (std::is_enum_v<T>)
    return QUELL_PARAM_ENUM;
  else if constexpr (std::same_as<T, std::filesystem::path>)
    return QUELL_PARAM_PATH;
  else {
    static_assert(std::same_as<T, std::string>,
                  "a parameter is bool, integer, floating point, string, enum, path or a vector of these");
    return QUELL_PARAM_STRING;
  }
}

/// Owns what a quell_param_value points to.
class OwnedValue {
 public:
  template <class T>
  explicit OwnedValue(const T& value) {
    add(value), finish(param_type<T>(), 1);
  }
  template <class T>
  explicit OwnedValue(const std::vector<T>& values) {
    for (const T& value : values) add(value);
    finish(param_type<T>(), static_cast<std::uint32_t>(values.size()));
  }
  OwnedValue(const OwnedValue&) = delete;
  OwnedValue& operator=(const OwnedValue&) = delete;
  const quell_param_value* get() const { return &value_; }

 private:
  template <class T>
  void add(const T& value) {
    constexpr std::uint32_t type = param_type<T>();
    if constexpr (type == QUELL_PARAM_BOOL)
      bools_.push_back(value ? 1 : 0);
    else if constexpr (type == QUELL_PARAM_DOUBLE)
      doubles_.push_back(double{value});
    else if constexpr (type == QUELL_PARAM_INT || type == QUELL_PARAM_ENUM)
      ints_.push_back(static_cast<std::int64_t>(value));
    else if constexpr (type == QUELL_PARAM_PATH)
      texts_.push_back(value.string());
    else
      texts_.push_back(value);
  }
  void finish(std::uint32_t type, std::uint32_t count) {
    for (const std::string& text : texts_) strings_.push_back(text.c_str());
    value_ = {sizeof(value_), type, count, {}};
    if (type == QUELL_PARAM_BOOL)
      value_.data.bools = bools_.data();
    else if (type == QUELL_PARAM_DOUBLE)
      value_.data.doubles = doubles_.data();
    else if (type == QUELL_PARAM_INT || type == QUELL_PARAM_ENUM)
      value_.data.ints = ints_.data();
    else
      value_.data.strings = strings_.data();
  }
  std::vector<std::uint8_t> bools_;
  std::vector<std::int64_t> ints_;
  std::vector<double> doubles_;
  std::vector<std::string> texts_;
  std::vector<const char*> strings_;
  quell_param_value value_{};
};

/// The `field` that turns a Params' describe() into descriptors; the member's initial value is the default.
class ParamDescriber {
 public:
  template <Number T>
  void operator()(const char* name, const T& value, Range<T> range, const char* unit, const char* doc) {
    add(name, value, unit, doc, static_cast<double>(range.min), static_cast<double>(range.max));
  }
  template <class T>
  requires(std::same_as<T, bool> || std::same_as<T, std::string> || std::same_as<T, std::filesystem::path>) void operator()(
      const char* name, const T& value, const char* doc) {
    add(name, value, "", doc);
  }
  template <class T>
  requires std::is_enum_v<T>
  void operator()(const char* name, const T& value, Choices choices, const char* doc) {
    choose(add(name, value, "", doc), choices);
  }
  template <Number T>
  void operator()(const char* name, const std::vector<T>& values, Range<T> range, Length length, const char* unit,
                  const char* doc) {
    quell_param_desc& desc = add(name, values, unit, doc, static_cast<double>(range.min), static_cast<double>(range.max));
    desc.min_count = length.min, desc.max_count = length.max;
  }
  template <class T>
  requires(std::same_as<T, bool> || std::same_as<T, std::string> || std::same_as<T, std::filesystem::path>) void operator()(
      const char* name, const std::vector<T>& values, Length length, const char* doc) {
    quell_param_desc& desc = add(name, values, "", doc);
    desc.min_count = length.min, desc.max_count = length.max;
  }
  template <class T>
  requires std::is_enum_v<T>
  void operator()(const char* name, const std::vector<T>& values, Choices choices, Length length, const char* doc) {
    quell_param_desc& desc = add(name, values, "", doc);
    desc.min_count = length.min, desc.max_count = length.max;
    choose(desc, choices);
  }
  const std::vector<quell_param_desc>& descriptors() const { return descriptors_; }

 private:
  template <class T>
  struct Element {
    using type = T;
  };
  template <class T>
  struct Element<std::vector<T>> {
    using type = T;
  };

  template <class T>
  quell_param_desc& add(const char* name, const T& value, const char* unit, const char* doc,
                        double min = std::numeric_limits<double>::lowest(), double max = std::numeric_limits<double>::max()) {
    using E = typename Element<T>::type;
    quell_param_desc desc{};
    desc.struct_size = sizeof(desc);
    desc.type = param_type<E>();
    desc.name = name, desc.unit = unit, desc.doc = doc;
    desc.is_array = std::same_as<E, T> ? 0 : 1;
    desc.min_count = desc.max_count = 1;
    desc.min_value = min, desc.max_value = max;
    desc.default_value = values_.emplace_back(value).get();
    return descriptors_.emplace_back(desc);
  }
  void choose(quell_param_desc& desc, Choices choices) {
    auto& names = names_.emplace_back();
    auto& docs = names_.emplace_back();
    for (const Choice& choice : choices) names.push_back(choice.name), docs.push_back(choice.doc);
    desc.enum_values = names.data(), desc.enum_docs = docs.data();
    desc.enum_count = static_cast<std::uint32_t>(names.size());
  }
  std::deque<OwnedValue> values_;
  std::deque<std::vector<const char*>> names_;
  std::vector<quell_param_desc> descriptors_;
};

/// The `field` that fills a Params from the host's values, which come checked and in the descriptor's order.
class ParamReader {
 public:
  explicit ParamReader(const quell_param_value* values) : values_(values) {}
  template <class T, class... Rest>
  void operator()(const char*, T& value, Rest&&...) {
    read(value);
  }
  // Choices is an initializer_list, which a forwarded pack cannot take from braces.
  template <class T, class... Rest>
  void operator()(const char*, T& value, Choices, Rest&&...) {
    read(value);
  }

 private:
  const quell_param_value& next() { return *QUELL_AT(quell_param_value, values_, index_++); }
  template <class T>
  void read(T& value) {
    value = element<T>(next(), 0);
  }
  template <class T>
  void read(std::vector<T>& values) {
    const quell_param_value& from = next();
    values.clear();
    for (std::uint32_t i = 0; i < from.count; ++i) values.push_back(element<T>(from, i));
  }
  template <class T>
  static T element(const quell_param_value& from, std::uint32_t i) {
    constexpr std::uint32_t type = param_type<T>();
    if constexpr (type == QUELL_PARAM_BOOL)
      return from.data.bools[i] != 0;
    else if constexpr (type == QUELL_PARAM_DOUBLE)
      return static_cast<T>(from.data.doubles[i]);
    else if constexpr (type == QUELL_PARAM_INT || type == QUELL_PARAM_ENUM)
      return static_cast<T>(from.data.ints[i]);
    else
      return T(from.data.strings[i]);
  }
  const quell_param_value* values_;
  std::size_t index_ = 0;
};

}  // namespace detail
}  // namespace quell
