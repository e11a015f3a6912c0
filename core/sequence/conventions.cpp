#include "quell/sequence/conventions.h"

#include <algorithm>
#include <charconv>

#include "quell/text/diagnostic.h"

namespace quell {
namespace {

using Words = std::vector<std::string_view>;

/// A key, and where in Conventions it is kept: the index of the value in key.values, which is that of the enum.
struct Choice {
  ConventionKey key;
  std::optional<std::size_t> (*get)(const Conventions&);
  void (*set)(Conventions&, std::size_t);
};

template <auto kMember>
Choice choice(std::string_view name, std::vector<PortType> types, Words values, std::string_view doc) {
  return {{name, std::move(types), std::move(values), doc},
          [](const Conventions& conventions) -> std::optional<std::size_t> {
            const auto& value = conventions.*kMember;
            return value ? std::optional(static_cast<std::size_t>(*value)) : std::nullopt;
          },
          [](Conventions& conventions, std::size_t index) {
            auto& value = conventions.*kMember;
            value = static_cast<typename std::decay_t<decltype(value)>::value_type>(index);
          }};
}

const std::vector<Choice>& choices() {
  using C = Conventions;
  static const std::vector<Choice> all = {
      choice<&C::sign>("sign", {QUELL_TYPE_MOTION}, {"previous-current", "current-previous"},
                       "Which position is subtracted from which."),
      choice<&C::unit>("unit", {QUELL_TYPE_MOTION}, {"pixels", "uv", "ndc"},
                       "What motion is measured in; the image's width is 1 in uv, 2 in ndc."),
      choice<&C::y>("y", {QUELL_TYPE_MOTION, QUELL_TYPE_CAMERA}, {"down", "up"},
                    "Where y grows, in motion and in the NDC of a header's camera."),
      choice<&C::jitter>("jitter", {QUELL_TYPE_MOTION}, {"excluded", "included"},
                         "Whether motion holds the difference of the two frames' jitter."),
      choice<&C::depth>("depth", {QUELL_TYPE_DEPTH}, {"axis", "ray", "reciprocal"},
                        "What depth is: the distance along the view axis, that from the camera, or 1 / the former."),
      choice<&C::space>("space", {QUELL_TYPE_NORMAL, QUELL_TYPE_POSITION}, {"world", "camera"},
                        "In which space normals and positions are."),
      choice<&C::encoding>("encoding", {QUELL_TYPE_NORMAL}, {"signed", "unsigned"},
                           "Whether normals are -1 to 1, or written as (n + 1) / 2."),
      {{"background", {QUELL_TYPE_ID}, {}, "The id where there is no surface."}, nullptr, nullptr},
      choice<&C::alpha>("alpha", {QUELL_TYPE_COLOR}, {"premultiplied", "straight"},
                        "Whether color has been multiplied by alpha."),
      choice<&C::transfer>("transfer", {QUELL_TYPE_COLOR, QUELL_TYPE_ALBEDO}, {"linear", "srgb"},
                           "The transfer curve of the numbers."),
      choice<&C::vectors>("vectors", {QUELL_TYPE_CAMERA}, {"row", "column"},
                          "For which vectors a header's matrices are: p M, or M p."),
      choice<&C::ndc>("ndc", {QUELL_TYPE_CAMERA}, {"0..1", "-1..1", "0..1-shorter"},
                      "The range of a header's NDC across the image."),
      choice<&C::w>("w", {QUELL_TYPE_CAMERA}, {"positive", "negative"}, "The sign of a header's w in front of the camera."),
  };
  return all;
}

const Choice* find(std::string_view name) {
  const auto found = std::find_if(choices().begin(), choices().end(), [&](const Choice& c) { return c.key.key == name; });
  return found == choices().end() ? nullptr : &*found;
}

std::vector<std::string> texts(const Words& values) { return {values.begin(), values.end()}; }

std::optional<std::string> set_background(Conventions& conventions, std::string_view value) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size())
    return "background must be an integer, found '" + std::string(value) + "'";
  conventions.background = number;
  return std::nullopt;
}

/// The value of a key as it is written; nothing when it is not stated.
std::optional<std::string> value_of(const Conventions& conventions, const Choice& choice) {
  if (!choice.get) return conventions.background ? std::optional(std::to_string(*conventions.background)) : std::nullopt;
  const auto index = choice.get(conventions);
  return index ? std::optional<std::string>(choice.key.values[*index]) : std::nullopt;
}

}  // namespace

Conventions Conventions::or_else(const Conventions& others) const {
  Conventions result = *this;
  if (!result.background) result.background = others.background;
  for (const Choice& choice : choices())
    if (choice.get && !choice.get(*this))
      if (const auto index = choice.get(others)) choice.set(result, *index);
  return result;
}

const std::vector<ConventionKey>& convention_keys() {
  static const std::vector<ConventionKey> keys = [] {
    std::vector<ConventionKey> all;
    for (const Choice& choice : choices()) all.push_back(choice.key);
    return all;
  }();
  return keys;
}

std::optional<std::string> set_convention(Conventions& conventions, std::string_view key, std::string_view value) {
  const Choice* const choice = find(key);
  if (!choice) {
    std::vector<std::string> names;
    for (const ConventionKey& known : convention_keys()) names.emplace_back(known.key);
    return "there is no convention '" + std::string(key) + "'" + did_you_mean(key, names) + "; there are " +
           list_names(names, "and");
  }
  if (!choice->get) return set_background(conventions, value);
  const Words& values = choice->key.values;
  const auto found = std::find(values.begin(), values.end(), value);
  if (found == values.end())
    return std::string(key) + " must be " + list_names(texts(values)) + ", found '" + std::string(value) + "'" +
           did_you_mean(value, texts(values));
  choice->set(conventions, static_cast<std::size_t>(found - values.begin()));
  return std::nullopt;
}

std::optional<std::string> find_misplaced(const Conventions& conventions, PortType type) {
  for (const Choice& choice : choices()) {
    const std::vector<PortType>& types = choice.key.types;
    if (!value_of(conventions, choice) || std::find(types.begin(), types.end(), type) != types.end()) continue;
    std::string of;
    for (const PortType has : types) of += (of.empty() ? "" : " and ") + std::string(name(has));
    return std::string(choice.key.key) + " is a convention of " + of + ", not of " + std::string(name(type));
  }
  return std::nullopt;
}

std::string describe(const Conventions& conventions) {
  std::string text;
  for (const Choice& choice : choices())
    if (const auto value = value_of(conventions, choice))
      text += (text.empty() ? "" : ", ") + std::string(choice.key.key) + "=" + *value;
  return text;
}

Conventions default_conventions(std::string_view format, Numbers numbers, PortType type) {
  Conventions usual;
  // OpenEXR's integers are 32 bit, and count something.
  if (format == "openexr" || (numbers != Numbers::uint8 && numbers != Numbers::uint16)) return usual;
  if (type == QUELL_TYPE_COLOR || type == QUELL_TYPE_ALBEDO) usual.transfer = Transfer::srgb;
  if (type == QUELL_TYPE_COLOR) usual.alpha = AlphaKind::straight;
  if (type == QUELL_TYPE_NORMAL) usual.encoding = Encoding::unsigned_numbers;
  return usual;
}

}  // namespace quell
