#include "quell/sequence/checks/load_frame.h"

#include <algorithm>

#include "quell/text/error.h"

namespace quell {
namespace {

/// What an --in option names to choose these channels among others; "" for channels that are in no layer.
std::string choice_of(const StoredImage& stored) {
  const std::vector<std::string>& channels = stored.channels;
  if (channels.front().find('.') == std::string::npos) return "";
  if (channels.size() == 1) return channels.front();
  if (!stored.selection.layer.empty()) return stored.selection.layer;
  std::string named = "channels=";
  for (const std::string& channel : channels) named += (&channel == &channels.front() ? "" : ",") + channel;
  return named;
}

class Loader {
 public:
  Loader(Sequence& sequence, std::int64_t frame, BufferPool& pool, std::vector<Finding>& problems)
      : sequence_(sequence), pool_(pool), problems_(problems) {
    data_.frame = frame;
  }

  FrameData load() {
    const std::vector<InputFiles> inputs = sequence_.inputs();
    for (const InputFiles& input : inputs)
      if (input.type == QUELL_TYPE_CAMERA && !data_.camera) load_cameras(input);
    for (const InputFiles& input : inputs) {
      if (!std::binary_search(input.frames.begin(), input.frames.end(), data_.frame) || input.type == QUELL_TYPE_CAMERA) continue;
      if (!input.type)
        tell(Verdict::not_tested, input.input,
             "its type is not known; state it: --in " + input.input + "=" + input.pattern + ":type=scalar");
      else
        load_image(input);
    }
    return std::move(data_);
  }

 private:
  void tell(Verdict verdict, const std::string& input, const std::string& text) {
    problems_.push_back({verdict, reading_subject(input), text});
    problems_.back().frame = data_.frame, problems_.back().frame_matters = true;
  }

  std::shared_ptr<const Camera> load_camera(const InputFiles& input, std::int64_t frame) {
    if (!std::binary_search(input.frames.begin(), input.frames.end(), frame)) return nullptr;
    try {
      return std::make_shared<const Camera>(sequence_.read(input.input, frame, pool_).camera()->camera());
    } catch (const Error& error) {
      if (frame == data_.frame) tell(Verdict::wrong, input.input, error.what());
      return nullptr;
    }
  }

  void load_cameras(const InputFiles& input) {
    data_.camera = load_camera(input, data_.frame);
    data_.previous = load_camera(input, data_.frame - 1);
  }

  void load_image(const InputFiles& input) {
    CheckedImage image;
    image.name = input.input;
    try {
      StoredImage stored = sequence_.read_stored(input.input, data_.frame, pool_);
      image.stored = std::move(stored.image);
      image.read_as = stored.conventions;
      image.numbers = stored.numbers;
      image.layer = choice_of(stored);
      image.whole = stored.whole, image.x = stored.x, image.y = stored.y;
      image.image = *sequence_.read(input.input, data_.frame, pool_).image();
    } catch (const Error& error) {
      tell(Verdict::wrong, input.input, error.what());
      if (input.type != QUELL_TYPE_ID || !image.stored) return;  // ids that are no integers have a check of their own
    }
    place(*input.type, std::move(image));
  }

  std::optional<CheckedImage>* slot(PortType type) {
    switch (type) {
      case QUELL_TYPE_COLOR:
        return &data_.color;
      case QUELL_TYPE_ALBEDO:
        return &data_.albedo;
      case QUELL_TYPE_ALPHA:
        return &data_.alpha;
      case QUELL_TYPE_NORMAL:
        return &data_.normal;
      case QUELL_TYPE_POSITION:
        return &data_.position;
      case QUELL_TYPE_DEPTH:
        return &data_.depth;
      case QUELL_TYPE_ID:
        return &data_.id;
      case QUELL_TYPE_MOTION:
        return &data_.motion;
      default:
        return nullptr;
    }
  }

  void place(PortType type, CheckedImage image) {
    std::optional<CheckedImage>* const usual = slot(type);
    if (usual && *usual && image.name == name(type)) std::swap(**usual, image);
    if (usual && !*usual)
      *usual = std::move(image);
    else if (image.image)
      data_.others.push_back(std::move(image));
  }

  Sequence& sequence_;
  BufferPool& pool_;
  std::vector<Finding>& problems_;
  FrameData data_;
};

}  // namespace

std::string reading_subject(std::string_view input) { return std::string(input) + " can be read"; }

FrameData load_frame(Sequence& sequence, std::int64_t frame, BufferPool& pool, std::vector<Finding>& problems) {
  return Loader(sequence, frame, pool, problems).load();
}

}  // namespace quell
