#include "checkpoint_manifest.h"

#include <algorithm>
#include <limits>

#include "quell/sequence/frame_range.h"
#include "quell/text/json_write.h"

namespace quell::app {
namespace {

constexpr std::int64_t kVersion = 1;

std::string range(const std::vector<std::int64_t>& frames) { return frames.empty() ? "" : FrameRange(frames).text(); }

Json to_json(const std::optional<Shape>& shape) {
  if (!shape) return Json();
  return JsonMembers()
      .add("type", make_json(name(shape->type)))
      .add("width", shape->size.width)
      .add("height", shape->size.height)
      .add("values", static_cast<std::int64_t>(shape->value_count))
      .take();
}

Json to_json(const CheckpointManifest::Kept& kept) {
  return JsonMembers()
      .add("from", make_json(kept.from))
      .add("frame", kept.frame)
      .add("type", make_json(name(kept.type)))
      .add("file", make_json(kept.file))
      .take();
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : text_(read_text(file, Fault::input)) {}

  CheckpointManifest read() {
    CheckpointManifest manifest;
    if (const std::optional<Json> root = parse_json(text_, errors_)) read(*root, manifest);
    errors_.throw_if_any(Fault::input);
    return manifest;
  }

 private:
  void read(const Json& root, CheckpointManifest& manifest) {
    const std::int64_t version = integer(root, "quell_checkpoint");
    if (errors_.empty() && version != kVersion)
      errors_.error(root.where, "this version of quell reads checkpoints of form 1, not " + std::to_string(version));
    manifest.frame = integer(root, "frame");
    manifest.past = {frames(root, "done"), frames(root, "failed"), integer(root, "history_from")};
    for (const JsonMember& trait : member(root, "run", Json::Kind::object).members) manifest.run[trait.key] = trait.value.string;
    for (const JsonMember& shape : member(root, "shapes", Json::Kind::object).members)
      manifest.shapes[shape.key] = shape_of(shape.value);
    for (const Json& reset : member(root, "resets", Json::Kind::array).elements) manifest.resets.push_back(frames_of(reset));
    manifest.folder = file_name(root, "folder");
    for (const Json& kept : member(root, "history", Json::Kind::array).elements)
      manifest.history.push_back({text(kept, "from"), integer(kept, "frame"), type(kept), file_name(kept, "file")});
  }

  const Json& member(const Json& object, const char* key, Json::Kind kind) {
    static const Json kNothing;
    const Json* value = object.find(key);
    if (value && value->kind == kind) return *value;
    errors_.error(value ? value->where : object.where,
                  "'" + std::string(key) + "' should be here, " + std::string(describe(kind)));
    return kNothing;
  }
  std::int64_t integer(const Json& object, const char* key) { return member(object, key, Json::Kind::integer).integer; }
  std::string text(const Json& object, const char* key) { return member(object, key, Json::Kind::string).string; }
  std::vector<std::int64_t> frames(const Json& object, const char* key) {
    return frames_of(member(object, key, Json::Kind::string));
  }
  std::vector<std::int64_t> frames_of(const Json& range) {
    if (range.string.empty()) return {};
    const std::optional<FrameRange> parsed = FrameRange::parse(range.string, range.where, errors_);
    return parsed ? parsed->frames() : std::vector<std::int64_t>();
  }
  std::string file_name(const Json& object, const char* key) {
    const std::string name = text(object, key);
    if (name.empty() || name == "." || name == ".." || name.find('/') != std::string::npos)
      errors_.error(object.where, "'" + std::string(key) + "' should be the name of a file beside this one");
    return name;
  }
  PortType type(const Json& object) {
    const std::string wanted = text(object, "type");
    for (int type = 0; type < QUELL_TYPE_COUNT; ++type)
      if (name(static_cast<PortType>(type)) == wanted) return static_cast<PortType>(type);
    errors_.error(object.where, "'" + wanted + "' is no type");
    return QUELL_TYPE_COLOR;
  }
  int length(const Json& object, const char* key) {
    const std::int64_t pixels = integer(object, key);
    if (pixels < 0 || pixels > Image::kMaxSize)
      errors_.error(object.where, "'" + std::string(key) + "' is no length of an image");
    return static_cast<int>(std::clamp<std::int64_t>(pixels, 0, Image::kMaxSize));
  }
  std::optional<Shape> shape_of(const Json& value) {
    if (value.kind == Json::Kind::null) return std::nullopt;
    const std::int64_t values = integer(value, "values");
    if (values < 0 || values > std::numeric_limits<std::uint32_t>::max())
      errors_.error(value.where, "'values' is no number of values");
    return Shape{type(value), {length(value, "width"), length(value, "height")}, static_cast<std::uint32_t>(values), true};
  }

  SourceTextPtr text_;
  Diagnostics errors_;
};

}  // namespace

std::string write_manifest(const CheckpointManifest& manifest) {
  JsonMembers run, shapes;
  for (const auto& [what, text] : manifest.run) run.add(what, make_json(text));
  for (const auto& [input, shape] : manifest.shapes) shapes.add(input, to_json(shape));
  std::vector<std::string> resets;
  for (const std::vector<std::int64_t>& frames : manifest.resets) resets.push_back(range(frames));
  std::vector<Json> history;
  for (const CheckpointManifest::Kept& kept : manifest.history) history.push_back(to_json(kept));
  return write_json(JsonMembers()
                        .add("quell_checkpoint", kVersion)
                        .add("frame", manifest.frame)
                        .add("done", make_json(range(manifest.past.done)))
                        .add("failed", make_json(range(manifest.past.failed)))
                        .add("history_from", manifest.past.history_from)
                        .add("run", run.take())
                        .add("shapes", shapes.take())
                        .add("resets", make_json(resets))
                        .add("folder", make_json(manifest.folder))
                        .add("history", make_json(std::move(history)))
                        .take());
}

CheckpointManifest read_manifest(const std::filesystem::path& file) { return Reader(file).read(); }

}  // namespace quell::app
