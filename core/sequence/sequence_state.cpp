#include "quell/sequence/sequence_state.h"

#include "quell/sequence/value_file.h"

#include <algorithm>

#include "quell/text/diagnostic.h"

namespace quell {
namespace {

bool holds_sidecars(const std::vector<std::string>& listing) {
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

const std::vector<std::string>& Listings::of(const std::filesystem::path& folder) {
  const auto found = listings_.find(folder);
  return found != listings_.end() ? found->second : listings_.emplace(folder, list_files(folder)).first->second;
}

void Sequence::State::add(InputSpec spec, Listings& listings) {
  const std::vector<std::string>& listing = listings.of(spec.pattern.folder());
  FrameFiles files = find_frames(spec.pattern, listing);
  if (!files.padded_otherwise.empty()) warnings.insert(padding_warning(spec, files.padded_otherwise, files.frames.empty()));
  const std::string name = spec.name;
  inputs.insert_or_assign(name, SequenceInput{std::move(spec), std::move(files.frames), holds_sidecars(listing)});
}

const SequenceInput* Sequence::State::find(std::string_view name) const {
  const auto found = inputs.find(name);
  return found == inputs.end() ? nullptr : &found->second;
}

const SequenceInput& Sequence::State::require(std::string_view name) const {
  if (const SequenceInput* input = find(name)) return *input;
  std::vector<std::string> names;
  for (const auto& [known, input] : inputs) names.push_back(known);
  throw Error(Fault::input, title,
              "the sequence has no input '" + std::string(name) + "'" + did_you_mean(name, names) + "; it has " +
                  list_names(names, "and") + "; add it with --in " + std::string(name) + "=PATTERN");
}

const SequenceInput& Sequence::State::require_files(std::string_view name) const {
  const SequenceInput& input = require(name);
  if (!input.frames.empty()) return input;
  throw Error(Fault::input, input.spec.pattern.text(),
              "there is no file of this name for the input '" + std::string(name) + "' (" + input.spec.origin + ")");
}

PortType Sequence::State::type(const SequenceInput& input) const {
  if (input.spec.type) return *input.spec.type;
  if (const auto found = expected.find(input.spec.name); found != expected.end()) return found->second;
  if (const auto usual = input.spec.usual_type()) return *usual;
  throw Error(
      Fault::input, input.spec.pattern.text(),
      "the type of the input '" + input.spec.name + "' is not known; state it: --in " + input.spec.name + "=PATTERN:type=scalar");
}

ImageRequest Sequence::State::request(const SequenceInput& input) {
  ImageRequest request{type(input), input.spec.channels, input.spec.conventions};
  request.layer = input.spec.layer;
  request.input = input.spec.name;
  request.pattern = input.spec.pattern.text();
  request.stem = input.spec.pattern.stem();
  request.shared = input.spec.shared;
  request.window = window();
  if (const auto wrong = find_misplaced(request.conventions, request.type)) throw Error(Fault::input, input.spec.origin, *wrong);
  if (request.type == QUELL_TYPE_ID && !request.conventions.background && input.has_sidecars) request.conventions.background = 0;
  return request;
}

std::int64_t Sequence::State::first_frame(const SequenceInput& input) const {
  if (asked)
    for (const std::int64_t frame : asked->frames())
      if (std::binary_search(input.frames.begin(), input.frames.end(), frame)) return frame;
  return input.frames.front();
}

Shape Sequence::State::shape(std::string_view name) {
  {
    const std::lock_guard lock(mutex);
    if (const auto found = shapes.find(name); found != shapes.end()) return found->second;
  }
  const SequenceInput& input = require_files(name);
  Shape shape;
  shape.type = type(input);
  if (is_image(shape.type)) {
    shape.size = probe_image(input.spec.pattern.path(first_frame(input)), request(input));
    require_same_size(input);
  }
  if (shape.type == QUELL_TYPE_VALUE) shape.value_count = read_values(input.spec.pattern.path(first_frame(input))).size();
  const std::lock_guard lock(mutex);
  return shapes.emplace(name, shape).first->second;
}

bool Sequence::State::is_picture(const SequenceInput& input) const {
  const bool known = expected.contains(input.spec.name) || input.spec.usual_type();
  return known && !input.frames.empty() && is_image(type(input));
}

const SequenceInput* Sequence::State::main_picture() const {
  if (const SequenceInput* color = find("color"); color && is_picture(*color)) return color;
  for (const auto& [name, input] : inputs)
    if (is_picture(input)) return &input;
  return nullptr;
}

}  // namespace quell
