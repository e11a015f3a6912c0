// Writing JSON for people: values are built one by one, and laid out so that small ones take one line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "quell/text/json.h"

namespace quell {

/// Values without a place, to be written.
Json make_json(std::string_view text);
inline Json make_json(const char* text) { return make_json(std::string_view(text)); }
Json make_json(bool value);
Json make_json(std::int64_t value);
inline Json make_json(int value) { return make_json(std::int64_t{value}); }
/// A whole number within the integers that a double tells apart is written without a fraction. Not finite becomes null, since
/// JSON has neither NaN nor infinity.
Json make_json(double value);
Json make_json(std::vector<Json> elements);
Json make_json(const std::vector<std::string>& texts);
/// Without members.
Json make_object();

/// An object, member by member; keys stay in this order. A key that is there already is not replaced: give each once.
class JsonMembers {
 public:
  JsonMembers& add(std::string key, Json value);
  template <class T>
  JsonMembers& add(std::string key, T value) {
    return add(std::move(key), make_json(std::move(value)));
  }
  bool empty() const { return object_.members.empty(); }
  Json take() { return std::move(object_); }

 private:
  Json object_ = make_object();
};

/// The text of a value, ending with a line feed. Arrays and objects stand in one line where `columns` bytes hold it; else each
/// element and member has a line of its own, indented by two spaces. The same value always gives the same text.
std::string write_json(const Json& value, std::size_t columns = 120);

}  // namespace quell
