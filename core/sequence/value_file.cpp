#include "quell/sequence/value_file.h"

#include <limits>
#include <vector>

#include "quell/text/json.h"

namespace quell {

Values read_values(const std::filesystem::path& file) {
  Diagnostics errors;
  const SourceTextPtr text = read_text(file, Fault::input);
  std::vector<double> numbers;
  const auto add = [&](const Json& value) {
    if (!value.is_number() && value.kind != Json::Kind::null)
      errors.error(value.where, "expected a number, found " + excerpt(value));
    numbers.push_back(value.is_number() ? value.number : std::numeric_limits<double>::quiet_NaN());
  };
  if (const auto root = parse_json(text, errors)) {
    const Json* values = root->kind == Json::Kind::object ? root->find("values") : &*root;
    if (!values)
      errors.error(root->where, "the key \"values\" is missing in this object; write \"values\": [1]");
    else if (values->kind != Json::Kind::array)
      add(*values);
    else
      for (const Json& element : values->elements) add(element);
  }
  errors.throw_if_any(Fault::input);
  return Values(numbers);
}

}  // namespace quell
