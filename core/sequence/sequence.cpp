#include "quell/sequence/sequence.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "quell/sequence/sequence_file.h"
#include "quell/sequence/sequence_state.h"
#include "quell/sequence/value_file.h"
#include "quell/text/error.h"

namespace quell {

namespace fs = std::filesystem;

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
  state->window_choice = options.window;
  state->crop = options.crop;
  std::error_code error;
  const bool folder = fs::is_directory(path, error);
  if (path.empty()) {
    if (stated.empty())
      throw Error(Fault::usage, "",
                  "no sequence: name a folder or a sequence.json, or give inputs such as --in color=beauty_%d.exr");
    state->title = "inputs given with --in";
  } else if (const fs::path file = folder ? path / "sequence.json" : path; folder && !fs::exists(file, error)) {
    FolderLayout layout = recognize_folder(path, stated, options.wanted);
    state->title = path.string() + ": " + layout.description;
    specs = std::move(layout.inputs);
  } else if (!folder && path.extension() != ".json") {
    const bool is_pattern = path.filename().string().find_first_of("#%") != std::string::npos;
    if (!is_pattern && !fs::exists(file, error)) throw Error(Fault::input, path.string(), "no such folder or file");
    const FilePattern pattern = parse_files(path.string(), "SEQUENCE");
    FolderLayout layout = recognize_files(pattern, stated, options.wanted);
    state->title = path.string() + ": " + layout.description;
    state->shared = pattern;
    specs = std::move(layout.inputs);
    if (!state->asked && pattern.single_frame()) state->asked = FrameRange({*pattern.single_frame()});
  } else {
    if (!fs::exists(file, error)) throw Error(Fault::input, path.string(), "no such folder or file");
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
  const SequenceInput* found = state_->find(input);
  if (!found) found = state_->find_shared(input, type);
  if (!found) return;
  if (found->spec.type && *found->spec.type != type)
    throw Error(Fault::input, found->spec.origin,
                "the input '" + std::string(input) + "' is stated to be " + std::string(name(*found->spec.type)) +
                    ", but the graph wants " + std::string(name(type)));
  state_->expected.insert_or_assign(std::string(input), type);
}

std::vector<std::int64_t> Sequence::frames(const std::vector<std::string>& required) const {
  for (const std::string& input : required) state_->require_files(input);
  return state_->asked ? state_->asked->frames() : complete_frames(required);
}

std::vector<std::int64_t> Sequence::complete_frames(const std::vector<std::string>& required) const {
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
  const FrameRange all(std::move(wanted));
  for (const std::int64_t frame : all.frames()) {
    for (const std::string& name : required) {
      const SequenceInput& input = state_->require(name);
      if (std::binary_search(input.frames.begin(), input.frames.end(), frame)) continue;
      if (state_->asked && result.size() == kMostMissing) return result;
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
  const SequenceInput* color = state_->find("color");
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
    if (const std::string choice = state_->describe_choice(input); !choice.empty()) text += "  " + choice;
  }
  return text;
}

std::string Sequence::describe_layers() const {
  std::string text;
  std::set<std::string> told;
  for (const auto& [name, input] : state_->inputs) {
    if (!input.spec.shared || input.frames.empty() || !told.insert(input.spec.pattern.text()).second) continue;
    text += (text.empty() ? "" : "\n") + input.spec.pattern.text() + " has the layers:";
    const ImageFile file(input.spec.pattern.path(input.frames.front()));
    for (const Layer& layer : group_layers(file.channels())) {
      text += "\n  " + (layer.name.empty() ? "without a layer" : layer.name) + "  (";
      for (const int channel : layer.channels)
        text += (channel == layer.channels.front() ? "" : ",") +
                std::string(channel_suffix(file.channels()[static_cast<std::size_t>(channel)].name));
      text += ")";
    }
  }
  return text;
}

std::vector<std::string> Sequence::warnings() const {
  const std::lock_guard lock(state_->mutex);
  return {state_->warnings.begin(), state_->warnings.end()};
}

std::optional<PictureWindow> Sequence::picture_window() { return state_->picture_window(); }

fs::path Sequence::file(std::string_view input, std::int64_t frame) const {
  return state_->require(input).spec.pattern.path(frame);
}

std::vector<std::string> Sequence::channels_read(std::string_view name, std::int64_t frame) const {
  const SequenceInput& input = state_->require(name);
  const fs::path path = input.spec.pattern.path(frame);
  const ImageFile file(path);
  std::vector<std::string> names;
  for (const int channel : select_channels(file.channels(), state_->request(input), path.string()).channels)
    names.push_back(file.channels()[static_cast<std::size_t>(channel)].name);
  return names;
}

StoredImage Sequence::read_stored(std::string_view name, std::int64_t frame, BufferPool& pool) const {
  const SequenceInput& input = state_->require(name);
  return quell::read_stored(input.spec.pattern.path(frame), state_->request(input), pool);
}

std::optional<Shape> Sequence::shape(std::string_view input) {
  if (!state_->find(input)) return std::nullopt;
  return state_->shape(input);
}

Item Sequence::read(std::string_view name, std::int64_t frame, BufferPool& pool) {
  const SequenceInput& input = state_->require(name);
  const fs::path file = input.spec.pattern.path(frame);
  std::error_code error;
  const auto& single = input.spec.pattern.single_frame();
  if (!fs::exists(file, error) || (single && *single != frame))
    throw Error(Fault::input, file.string(),
                "the input '" + std::string(name) + "' has no file for frame " + std::to_string(frame) + "; " +
                    input.spec.pattern.name() + " has frames " + FrameRange(input.frames).text());
  const PortType type = state_->type(input);
  if (type == QUELL_TYPE_CAMERA) {
    Camera camera = state_->read_camera(input, frame);
    const std::optional<Rectangle> window = state_->window();
    return window ? shift(std::move(camera), *window) : camera;
  }
  if (type == QUELL_TYPE_VALUE) return read_values(file);
  ImageRequest request = state_->request(input);
  request.camera = [&](int frames_back) { return state_->find_camera(frame - frames_back); };
  return read_image(file, request, pool, [&](const std::string& note) {
    const std::lock_guard lock(state_->mutex);
    state_->warnings.insert(input.spec.pattern.text() + ": " + note);  // not the file, or thousands of frames would say the same
  });
}

}  // namespace quell
