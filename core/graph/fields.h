// Reading JSON objects whose keys are known: every unknown key and every value of the wrong kind is told. Private to this box.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/graph/document.h"

namespace quell::detail {

/// "; did you mean 'sigma'?", or all names when none is close: "; expected 'a', 'b' or 'c'", or `none` when there are no names.
std::string suggest(std::string_view misspelt, const std::vector<std::string>& names, std::string_view none = "");

/// Whether one of the misspelt names is close to this one.
bool is_meant(const std::string& name, const std::vector<std::string>& misspelt);

/// Whether the value is of that kind; an error if not.
bool expect(const Json& value, Json::Kind kind, std::string_view what, Diagnostics& errors);

/// Whether a key may be a name: snake_case; an error if not. `what` is "a node", "an input", ...
bool expect_name(const JsonMember& member, std::string_view what, Diagnostics& errors);

/// The members of one object.
class Fields {
 public:
  /// `what` names the object in messages: "a node".
  Fields(const Json& object, std::string what, const std::vector<std::string>& keys, Diagnostics& errors);

  bool has_unknown() const { return has_unknown_; }
  const Json* any(std::string_view key) const { return object_.find(key); }
  /// Null when there is no such key, or when its value is of another kind, which is told.
  const Json* find(std::string_view key, Json::Kind kind) const;
  std::optional<Text> text(std::string_view key) const;
  std::string text_or_empty(std::string_view key) const;
  bool flag(std::string_view key) const;

 private:
  const Json& object_;
  Diagnostics& errors_;
  bool has_unknown_ = false;
};

}  // namespace quell::detail
