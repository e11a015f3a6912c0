#include "quell/sequence/sequence.h"

#include <algorithm>
#include <iterator>
#include <mutex>
#include <set>

#include "quell/sequence/camera_file.h"
#include "quell/sequence/image_input.h"
#include "quell/sequence/input_spec.h"
#include "quell/sequence/sequence_file.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

/// An input and the files it has.
struct Input {
  InputSpec spec;
  std::vector<std::int64_t> frames;
  bool has_sidecars = false;  ///< frame.<n>.json lie beside the files
};

/// Folders' listings, each read once.
class Listings {
 public:
  const std::vector<std::string>& of(const fs::path& folder) {
    const auto found = listings_.find(folder);
    return found != listings_.end() ? found->second : listings_.emplace(folder, list_files(folder)).first->second;
  }

 private:
  std::map<fs::path, std::vector<std::string>> listings_;
};

bool has_sidecars(const std::vector<std::string>& listing) {
  const FilePattern sidecar({}, "frame.", 1, ".json");
  return std::any_of(listing.begin(), listing.end(), [&](const std::string& name) { return sidecar.match(name).has_value(); });
}

std::string padding_warning(const InputSpec& spec, const std::vector<std::string>& others, bool none) {
  const std::string& example = others.front();
  const auto match = spec.pattern.match(example);
  return spec.pattern.text() + ": " + (none ? "no file" : "not every file") + " is named like this pattern of '" + spec.name +
         "'; the folder has " + example + ", where the pattern says " + spec.pattern.file_name(match->frame) +
         " (#### is a number of four digits, %d one without leading zeros)";
}

}  // namespace

struct Sequence::State {
  std::string title;  // what was recognised
  std::map<std::string, Input, std::less<>> inputs;
  std::optional<FrameRange> asked;
  std::map<std::string, PortType, std::less<>> expected;

  mutable std::mutex mutex;  // guards what follows
  std::set<std::string> warnings;
  std::map<std::string, Shape, std::less<>> shapes;

  void add(InputSpec spec, Listings& listings) {
    const std::vector<std::string>& listing = listings.of(spec.pattern.folder());
    FrameFiles files = find_frames(spec.pattern, listing);
    if (!files.padded_otherwise.empty()) warnings.insert(padding_warning(spec, files.padded_otherwise, files.frames.empty()));
    const std::string name = spec.name;
    inputs.insert_or_assign(name, Input{std::move(spec), std::move(files.frames), has_sidecars(listing)});
  }

  const Input* find(std::string_view name) const {
    const auto found = inputs.find(name);
    return found == inputs.end() ? nullptr : &found->second;
  }

  const Input& require(std::string_view name) const {
    if (const Input* input = find(name)) return *input;
    std::vector<std::string> names;
    for (const auto& [known, input] : inputs) names.push_back(known);
    throw Error(Fault::input, title,
                "the sequence has no input '" + std::string(name) + "'" + did_you_mean(name, names) + "; it has " +
                    list_names(names, "and") + "; add it with --in " + std::string(name) + "=PATTERN");
  }

  /// Throws when the input has no file at all.
  const Input& require_files(std::string_view name) const {
    const Input& input = require(name);
    if (!input.frames.empty()) return input;
    throw Error(Fault::input, input.spec.pattern.text(),
                "there is no file of this name for the input '" + std::string(name) + "' (" + input.spec.origin + ")");
  }

  PortType type(const Input& input) const {
    if (input.spec.type) return *input.spec.type;
    if (const auto found = expected.find(input.spec.name); found != expected.end()) return found->second;
    if (const auto usual = input.spec.usual_type()) return *usual;
    throw Error(Fault::input, input.spec.pattern.text(),
                "the type of the input '" + input.spec.name + "' is not known; state it: --in " + input.spec.name +
                    "=PATTERN:type=scalar");
  }

  /// How to read its files. An id's background that is not stated is 0 beside sidecars (Cycles' numbering starts at 1 there), and
  /// every negative value elsewhere.
  ImageRequest request(const Input& input) const {
    ImageRequest request{type(input), input.spec.channels, input.spec.background};
    if (!request.background && input.has_sidecars) request.background = 0;
    return request;
  }

  std::int64_t first_frame(const Input& input) const {
    if (asked)
      for (const std::int64_t frame : asked->frames())
        if (std::binary_search(input.frames.begin(), input.frames.end(), frame)) return frame;
    return input.frames.front();
  }

  Shape shape(std::string_view name) {
    {
      const std::lock_guard lock(mutex);
      if (const auto found = shapes.find(name); found != shapes.end()) return found->second;
    }
    const Input& input = require_files(name);
    Shape shape;
    shape.type = type(input);
    if (is_image(shape.type)) shape.size = probe_image(input.spec.pattern.path(first_frame(input)), request(input));
    const std::lock_guard lock(mutex);
    return shapes.emplace(name, shape).first->second;
  }

  /// The size of the images, for cameras that do not tell it.
  Size resolution(const fs::path& camera) {
    const auto is_picture = [&](const Input& input) {
      const auto usual = input.spec.usual_type();
      return !input.frames.empty() && (expected.contains(input.spec.name) || usual) && is_image(type(input));
    };
    if (const Input* color = find("color"); color && is_picture(*color)) return shape("color").size;
    for (const auto& [name, input] : inputs)
      if (is_picture(input)) return shape(name).size;
    throw Error(
        Fault::input, camera.string(),
        "this camera's file does not tell the resolution, and the sequence has no image to take it from; add one with --in");
  }
};

Sequence::Sequence(std::unique_ptr<State> state) : state_(std::move(state)) {}
Sequence::~Sequence() = default;

std::unique_ptr<Sequence> Sequence::open(const fs::path& path, const SequenceOptions& options) {
  auto state = std::make_unique<State>();
  InputSpecs specs, stated;
  for (const std::string& text : options.in) {
    InputSpec spec = parse_input_option(text);
    stated.insert_or_assign(spec.name, spec);
  }
  state->asked = options.frames;
  std::error_code error;
  const bool folder = fs::is_directory(path, error);
  if (path.empty()) {
    if (stated.empty())
      throw Error(Fault::usage, "",
                  "no sequence: name a folder or a sequence.json, or give inputs such as --in color=beauty_%d.exr");
    state->title = "inputs given with --in";
  } else if (const fs::path file = folder ? path / "sequence.json" : path; folder && !fs::exists(file, error)) {
    FolderLayout layout = recognise_folder(path, stated);
    state->title = path.string() + ": " + layout.description;
    specs = std::move(layout.inputs);
  } else {
    if (!fs::exists(file, error)) throw Error(Fault::input, path.string(), "no such folder or file");
    if (file.extension() != ".json")
      throw Error(Fault::input, path.string(), "a sequence is a folder or a .json file; single patterns are given with --in");
    SequenceFile described = read_sequence_file(file);
    state->title = file.string() + (described.name.empty() ? "" : ": " + described.name);
    specs = std::move(described.inputs);
    if (!state->asked) state->asked = std::move(described.frames);
  }
  for (auto& [name, spec] : stated) specs.insert_or_assign(name, spec);
  Listings listings;
  for (auto& [name, spec] : specs) state->add(std::move(spec), listings);
  return std::unique_ptr<Sequence>(new Sequence(std::move(state)));
}

void Sequence::expect(std::string_view input, PortType type) {
  const Input* found = state_->find(input);
  if (!found) return;
  if (found->spec.type && *found->spec.type != type)
    throw Error(Fault::input, found->spec.origin,
                "the input '" + std::string(input) + "' is stated to be " + std::string(name(*found->spec.type)) +
                    ", but the graph wants " + std::string(name(type)));
  state_->expected.insert_or_assign(std::string(input), type);
}

std::vector<std::int64_t> Sequence::frames(const std::vector<std::string>& required) const {
  for (const std::string& input : required) state_->require_files(input);
  if (state_->asked) return state_->asked->frames();
  std::vector<std::int64_t> common;
  bool first = true;
  for (const std::string& name : required) {
    const std::vector<std::int64_t>& frames = state_->require(name).frames;
    std::vector<std::int64_t> both;
    std::set_intersection(common.begin(), common.end(), frames.begin(), frames.end(), std::back_inserter(both));
    common = first ? frames : std::move(both);
    first = false;
  }
  return common;
}

std::vector<MissingFile> Sequence::missing(const std::vector<std::string>& required) const {
  std::vector<std::int64_t> wanted;
  if (state_->asked)
    wanted = state_->asked->frames();
  else
    for (const std::string& name : required) {
      const std::vector<std::int64_t>& frames = state_->require(name).frames;
      wanted.insert(wanted.end(), frames.begin(), frames.end());
    }
  std::vector<MissingFile> result;
  for (const std::int64_t frame : FrameRange(std::move(wanted)).frames()) {
    for (const std::string& name : required) {
      const Input& input = state_->require(name);
      if (!std::binary_search(input.frames.begin(), input.frames.end(), frame))
        result.push_back({name, frame, input.spec.pattern.path(frame)});
    }
  }
  return result;
}

std::vector<InputFiles> Sequence::inputs() const {
  std::vector<InputFiles> result;
  for (const auto& [name, input] : state_->inputs) {
    const auto expected = state_->expected.find(name);
    const auto type = expected != state_->expected.end() ? expected->second : input.spec.usual_type();
    result.push_back({name, input.spec.pattern.text(), type, input.frames});
  }
  return result;
}

int Sequence::padding() const {
  if (state_->inputs.empty()) return 4;
  const Input* color = state_->find("color");
  const int digits = (color ? *color : state_->inputs.begin()->second).spec.pattern.digits();
  return digits > 1 ? digits : 4;
}

std::string Sequence::describe() const {
  std::size_t name_width = 0, pattern_width = 0;
  for (const auto& [name, input] : state_->inputs) {
    name_width = std::max(name_width, name.size());
    pattern_width = std::max(pattern_width, input.spec.pattern.name().size());
  }
  std::string text = state_->title;
  for (const auto& [name, input] : state_->inputs) {
    const std::string& pattern = input.spec.pattern.name();
    text += "\n  " + name + std::string(name_width - name.size() + 2, ' ') + pattern +
            std::string(pattern_width - pattern.size() + 2, ' ') + "frames " + FrameRange(input.frames).text();
  }
  return text;
}

std::vector<std::string> Sequence::warnings() const {
  const std::lock_guard lock(state_->mutex);
  return {state_->warnings.begin(), state_->warnings.end()};
}

std::optional<Shape> Sequence::shape(std::string_view input) {
  if (!state_->find(input)) return std::nullopt;
  return state_->shape(input);
}

Item Sequence::read(std::string_view name, std::int64_t frame, BufferPool& pool) {
  const Input& input = state_->require(name);
  const fs::path file = input.spec.pattern.path(frame);
  std::error_code error;
  if (!fs::exists(file, error))
    throw Error(Fault::input, file.string(),
                "the input '" + std::string(name) + "' has no file for frame " + std::to_string(frame) + "; " +
                    input.spec.pattern.name() + " has frames " + FrameRange(input.frames).text());
  const PortType type = state_->type(input);
  if (type == QUELL_TYPE_CAMERA) {
    if (input.spec.camera_format() == CameraFormat::json) return read_json_camera(file);
    return read_mat_camera(file, state_->resolution(file));
  }
  if (!is_image(type))
    throw Error(Fault::input, file.string(), "the input '" + std::string(name) + "' is of type value, which no file can carry");
  return read_image(file, state_->request(input), pool, [&](const std::string& note) {
    const std::lock_guard lock(state_->mutex);
    state_->warnings.insert(note);
  });
}

}  // namespace quell
