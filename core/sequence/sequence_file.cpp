#include "quell/sequence/sequence_file.h"

#include <algorithm>

#include "quell/text/json.h"

namespace quell {
namespace {

using Keys = std::vector<std::string>;
const Keys kTopKeys = {"quell_sequence", "name", "doc", "frames", "inputs"};
constexpr std::int64_t kVersion = 1;

const Keys& input_keys() {
  static const Keys keys = [] {
    Keys all = {"file", "type", "layer", "channels", "format", "doc"};
    for (const ConventionKey& known : convention_keys()) all.emplace_back(known.key);
    return all;
  }();
  return keys;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : folder_(file.parent_path()), text_(read_text(file, Fault::input)) {}

  SequenceFile read() {
    SequenceFile result;
    if (const auto root = parse_json(text_, errors_)) read_root(*root, result);
    errors_.throw_if_any(Fault::input);
    return result;
  }

 private:
  /// Whether the value is of this kind; otherwise an error is told.
  bool expect(const Json& value, Json::Kind kind, std::string_view what) {
    if (value.kind == kind) return true;
    errors_.error(value.where, "expected " + std::string(what) + ", found " + excerpt(value));
    return false;
  }

  void check_keys(const Json& object, const Keys& known) {
    for (const JsonMember& member : object.members)
      if (std::find(known.begin(), known.end(), member.key) == known.end())
        errors_.error(member.where, "unknown key \"" + member.key + "\"" + did_you_mean(member.key, known) +
                                        "; known here: " + list_names(known, "and"));
  }

  std::string read_string(const Json& object, std::string_view key) {
    const Json* value = object.find(key);
    return value && expect(*value, Json::Kind::string, "a text") ? value->string : "";
  }

  void read_root(const Json& root, SequenceFile& result) {
    if (!expect(root, Json::Kind::object, "an object with \"quell_sequence\": 1 and \"inputs\"")) return;
    if (root.find("nodes") && !root.find("quell_sequence"))
      return errors_.error(
          root.where,
          "this is a graph, not a sequence; a sequence is a folder of images, or a file with \"quell_sequence\": 1 "
          "and \"inputs\"");
    check_keys(root, kTopKeys);
    const Json* version = root.find("quell_sequence");
    if (!version)
      errors_.error(root.where, "the key \"quell_sequence\" is missing; write \"quell_sequence\": 1");
    else if (version->kind != Json::Kind::integer || version->integer != kVersion)
      errors_.error(version->where, "expected 1, the only version of this format, found " + excerpt(*version));
    result.name = read_string(root, "name");
    result.doc = read_string(root, "doc");
    if (const Json* frames = root.find("frames"); frames && expect(*frames, Json::Kind::string, "frames such as \"1-8\""))
      result.frames = FrameRange::parse(frames->string, inside(*frames), errors_);
    const Json* inputs = root.find("inputs");
    if (!inputs)
      return errors_.error(root.where, "the key \"inputs\" is missing; write \"inputs\": {\"color\": \"color.####.exr\"}");
    if (!expect(*inputs, Json::Kind::object, "an object: {\"color\": \"color.####.exr\"}")) return;
    for (const JsonMember& member : inputs->members) read_input(member, result.inputs);
  }

  void read_input(const JsonMember& member, InputSpecs& inputs) {
    InputSpec spec;
    spec.name = member.key;
    spec.origin = place(member.where);
    if (!is_input_name(member.key))
      errors_.error(member.where, "an input's name has letters, digits and underscores, and starts with a letter");
    const Json& value = member.value;
    if (value.kind == Json::Kind::string) {
      read_pattern(value, spec);
    } else if (expect(value, Json::Kind::object, "a file pattern, or an object with \"file\"")) {
      check_keys(value, input_keys());
      read_string(value, "doc");
      if (const Json* file = value.find("file"); !file)
        errors_.error(value.where, "the key \"file\" is missing; write \"file\": \"" + member.key + ".####.exr\"");
      else if (expect(*file, Json::Kind::string, "a file pattern such as \"color.####.exr\""))
        read_pattern(*file, spec);
      read_type(value, spec);
      spec.layer = read_string(value, "layer");
      if (const Json* channels = value.find("channels")) read_channels(*channels, spec);
      if (!spec.layer.empty() && !spec.channels.empty()) errors_.error(value.where, "name a layer or its channels, not both");
      if (const Json* format = value.find("format")) read_format(*format, spec);
      for (const ConventionKey& key : convention_keys())
        if (const Json* stated = value.find(key.key)) read_convention(key, *stated, spec);
    }
    inputs.emplace(member.key, std::move(spec));
  }

  void read_pattern(const Json& value, InputSpec& spec) {
    if (auto pattern = FilePattern::parse(value.string, folder_, inside(value), errors_)) spec.pattern = std::move(*pattern);
  }

  void read_type(const Json& object, InputSpec& spec) {
    const Json* type = object.find("type");
    if (!type || !expect(*type, Json::Kind::string, "a type such as \"color\"")) return;
    spec.type = port_type(type->string);
    if (spec.type) return;
    Keys types;
    for (int i = 0; i < QUELL_TYPE_COUNT; ++i) types.emplace_back(quell::name(static_cast<PortType>(i)));
    errors_.error(type->where, "there is no type \"" + type->string + "\"" + did_you_mean(type->string, types) + "; there are " +
                                   list_names(types, "and"));
  }

  void read_convention(const ConventionKey& key, const Json& value, InputSpec& spec) {
    std::string text = value.string;
    if (key.values.empty()) {
      if (!expect(value, Json::Kind::integer, "an integer")) return;
      text = std::to_string(value.integer);
    } else if (!expect(value, Json::Kind::string, list_names({key.values.begin(), key.values.end()}))) {
      return;
    }
    Conventions stated;
    const auto type = spec.usual_type();
    auto wrong = set_convention(stated, key.key, text);
    if (!wrong && type) wrong = find_misplaced(stated, *type);
    if (wrong) errors_.error(value.where, *wrong);
    spec.conventions = stated.or_else(spec.conventions);
  }

  void read_format(const Json& format, InputSpec& spec) {
    const auto type = spec.usual_type();
    if (type && *type != QUELL_TYPE_CAMERA) errors_.error(format.where, "only a camera has a format");
    if (!expect(format, Json::Kind::string, "\"json\", \"mat\" or \"header\"")) return;
    spec.camera = camera_format(format.string);
    if (!spec.camera) errors_.error(format.where, "expected \"json\", \"mat\" or \"header\", found " + excerpt(format));
  }

  void read_channels(const Json& value, InputSpec& spec) {
    if (!expect(value, Json::Kind::array, "a list of channel names such as [\"R\", \"G\", \"B\"]")) return;
    const auto type = spec.usual_type();
    const int planes = type ? info(*type).channels : static_cast<int>(value.elements.size());
    if (static_cast<int>(value.elements.size()) != planes)
      errors_.error(value.where, std::string(quell::name(*type)) + " needs " + std::to_string(planes) +
                                     (planes == 1 ? " channel, " : " channels, ") + std::to_string(value.elements.size()) +
                                     " are named");
    for (const Json& channel : value.elements)
      if (expect(channel, Json::Kind::string, "a channel's name")) spec.channels.push_back(channel.string);
  }

  /// The place of a string's first character, after the quote.
  static Position inside(const Json& value) { return Position{value.where.source, value.where.offset + 1}; }
  static std::string place(const Position& where) {
    return where.source->name + ":" + std::to_string(where.line()) + ":" + std::to_string(where.column());
  }

  std::filesystem::path folder_;
  SourceTextPtr text_;
  Diagnostics errors_;
};

}  // namespace

SequenceFile read_sequence_file(const std::filesystem::path& file) { return Reader(file).read(); }

}  // namespace quell
