#include <algorithm>

#include "quell/sequence/camera_file.h"
#include "quell/sequence/header_camera.h"
#include "quell/sequence/sequence_state.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr std::size_t kTried = 5;  // frames that are looked at to tell the readings of a header apart

[[noreturn]] void fail_undecided(const SequenceInput& input, const HeaderReadings& readings) {
  std::string text = "worldToCamera and worldToNDC of these headers can be understood in several ways";
  if (readings.possible.empty()) {
    text +=
        ", but " + readings.why + "; correct the positions' space (space=camera), or state vectors, ndc, y and w of the camera: ";
    text += "--in " + input.spec.name + "=PATTERN:vectors=row:ndc=0..1:y=down:w=positive";
  } else {
    text += ":";
    for (const HeaderReading& reading : readings.possible) text += "\n  " + describe(reading);
    std::string settings = describe(readings.possible.front());
    for (std::size_t at = settings.find(", "); at != std::string::npos; at = settings.find(", ")) settings.replace(at, 2, ":");
    text += "\nadd positions (--in position=PATTERN), which tell them apart, or say which: --in " + input.spec.name + "=" +
            input.spec.pattern.text() + ":" + settings;
  }
  throw Error(Fault::input, input.spec.pattern.text(), text);
}

}  // namespace

Camera Sequence::State::read_camera(const SequenceInput& input, std::int64_t frame) {
  const std::filesystem::path file = input.spec.pattern.path(frame);
  switch (input.spec.camera_format()) {
    case CameraFormat::json:
      return read_json_camera(file);
    case CameraFormat::mat:
      return read_mat_camera(file, resolution(file));
    case CameraFormat::header:
      break;
  }
  return make_camera(read_header_camera(file), reading_of(input));
}

std::shared_ptr<const Camera> Sequence::State::find_camera(std::int64_t frame) {
  const SequenceInput* found = find("camera");
  for (auto input = inputs.begin(); !found && input != inputs.end(); ++input)
    if (input->second.spec.usual_type() == QUELL_TYPE_CAMERA) found = &input->second;
  if (!found) throw Error(Fault::input, title, "the sequence has no camera; add one with --in camera=PATTERN");
  if (!std::binary_search(found->frames.begin(), found->frames.end(), frame)) return nullptr;
  return std::make_shared<const Camera>(read_camera(*found, frame));
}

/// Positions with which a header's camera can be tested; nothing when there are none for the frame, or of another size.
std::optional<HeaderPositions> Sequence::State::find_positions(std::int64_t frame, Size size) {
  const SequenceInput* found = find("position");
  for (auto input = inputs.begin(); !found && input != inputs.end(); ++input)
    if (input->second.spec.usual_type() == QUELL_TYPE_POSITION) found = &input->second;
  if (!found || !std::binary_search(found->frames.begin(), found->frames.end(), frame)) return std::nullopt;
  const Space space = selection(*found).conventions.space.value_or(Space::world);
  ImageRequest whole = request(*found);
  whole.window.reset();
  whole.conventions.space = Space::world;  // read as they stand: to convert them would take the camera
  BufferPool pool;
  HeaderPositions positions{read_image(found->spec.pattern.path(frame), whole, pool, [](const std::string&) {}), space};
  if (positions.image.size() != size) return std::nullopt;
  return positions;
}

HeaderReading Sequence::State::choose_reading(const SequenceInput& input) {
  HeaderReadings readings;
  for (std::size_t i = 0; i < std::min(input.frames.size(), kTried); ++i) {
    const HeaderCamera header = read_header_camera(input.spec.pattern.path(input.frames[i]));
    const std::optional<HeaderPositions> positions = find_positions(input.frames[i], header.size);
    readings = find_readings(header, input.spec.conventions, positions ? &*positions : nullptr);
    if (readings.possible.empty()) break;  // no later frame makes that right
    if (readings.possible.size() != 1) continue;
    const std::lock_guard lock(mutex);
    warnings.insert(input.spec.pattern.text() + ": the header's camera is read with " + quell::describe(readings.possible[0]) +
                    " (" + readings.why + ")");
    return readings.possible[0];
  }
  fail_undecided(input, readings);
}

HeaderReading Sequence::State::reading_of(const SequenceInput& input) {
  const std::lock_guard lock(reading_mutex);  // others wait for the one that finds out
  if (const auto found = header_readings.find(input.spec.name); found != header_readings.end()) {
    if (const Error* error = std::get_if<Error>(&found->second)) throw *error;
    return std::get<HeaderReading>(found->second);
  }
  try {
    const HeaderReading reading = choose_reading(input);
    header_readings.emplace(input.spec.name, reading);
    return reading;
  } catch (const Error& error) {
    header_readings.emplace(input.spec.name, error);
    throw;
  }
}

}  // namespace quell
