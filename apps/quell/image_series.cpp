#include "image_series.h"

#include <algorithm>
#include <set>
#include <utility>

#include "quell/sequence/input_spec.h"
#include "quell/text/diagnostic.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

const char* input_of(SeriesRole role) { return role == SeriesRole::motion ? "motion" : "color"; }

bool is_sequence(const std::string& what) {
  std::error_code error;
  return fs::is_directory(what, error) || fs::path(what).extension() == ".json";
}

/// The names of a path's last part and of the folders above it, the last first. A folder's may end with a slash.
std::vector<std::string> parts_of(const fs::path& path) {
  std::vector<std::string> parts;
  std::error_code error;
  for (const fs::path& part : fs::absolute(path, error).lexically_normal())
    if (part.has_filename() && part != part.root_path()) parts.insert(parts.begin(), part.string());
  return parts;
}

std::vector<std::string> names_of_inputs(const Sequence& sequence) {
  std::vector<std::string> names;
  for (const InputFiles& files : sequence.inputs()) names.push_back(files.input);
  return names;
}

/// Of a folder or a sequence.json.
std::string choose_input(const Sequence& sequence, SeriesRole role, const std::string& what) {
  const std::vector<std::string> names = names_of_inputs(sequence);
  const auto has = [&](const char* name) { return std::ranges::find(names, name) != names.end(); };
  if (role == SeriesRole::reference && has("reference")) return "reference";
  if (has(input_of(role))) return input_of(role);
  const std::string wanted = role == SeriesRole::reference ? "'reference' or 'color'" : "'" + std::string(input_of(role)) + "'";
  throw Error(Fault::input, what,
              "has no input " + wanted + "; it has " + (names.empty() ? "nothing" : list_names(names, "and")) +
                  "; name the files instead, such as " + (fs::path(what).parent_path() / "NAME.####.exr").string());
}

/// The message without the input and its "--in color=", which nobody wrote.
Error speak_of(const std::string& what, SeriesRole role, const Error& error) {
  std::string text = error.what();
  const std::string input = input_of(role), written = "--in " + input + "=" + what;
  if (text.starts_with(written)) text = what + text.substr(written.size());
  const std::string purpose = " for the input '" + input + "' (" + written + ")";
  if (text.ends_with(purpose)) text.resize(text.size() - purpose.size());
  return {error.fault(), "", text};
}

}  // namespace

ImageSeries::ImageSeries(std::shared_ptr<Sequence> sequence, std::string input)
    : sequence_(std::move(sequence)), input_(std::move(input)) {
  wanted_ = sequence_->frames({input_});
  for (InputFiles& files : sequence_->inputs())
    if (files.input == input_) files_ = files.pattern, frames_ = std::move(files.frames);
}

ImageSeries ImageSeries::open(const std::string& what, SeriesRole role, SequenceOptions options) {
  if (what.empty()) throw Error(Fault::usage, "", "a name of images is empty; name files, a folder or a sequence.json");
  if (is_sequence(what)) {
    options.wanted = {{"reference", "color", "motion"}};
    std::shared_ptr<Sequence> sequence = Sequence::open(what, options);
    ImageSeries series(sequence, choose_input(*sequence, role, what));
    const fs::path path = what;
    series.names_ = parts_of(path.extension() == ".json" ? fs::path(what).parent_path() : path);
    return series;
  }
  const std::string option = std::string(input_of(role)) + "=" + what;
  try {
    const InputSpec spec = parse_input_option(option);
    options.in = {option};
    ImageSeries series(Sequence::open("", options), input_of(role));
    series.single_ = spec.pattern.single_frame();
    series.names_ = parts_of(spec.pattern.folder() / "file");
    series.names_.front() = spec.pattern.stem().empty() ? spec.pattern.name() : spec.pattern.stem();
    if (!spec.layer.empty()) {
      series.names_.insert(series.names_.begin(), spec.layer);
      series.files_ += ":" + spec.layer;
    }
    return series;
  } catch (const Error& error) {
    if (std::string_view(error.what()).starts_with("--in:1:"))  // a pattern without a counter: the file is not there
      throw Error(Fault::input, what, "there is no such file or folder; files of a sequence are named with ####, %d or %04d");
    throw speak_of(what, role, error);
  }
}

bool ImageSeries::has(std::int64_t frame) const { return std::ranges::binary_search(frames_, frame); }

fs::path ImageSeries::file(std::int64_t frame) const { return sequence_->file(input_, single_.value_or(frame)); }

Size ImageSeries::size() const { return sequence_->shape(input_)->size; }

Image ImageSeries::read(std::int64_t frame, BufferPool& pool) const {
  const Item item = sequence_->read(input_, single_.value_or(frame), pool);
  const PortType type = input_ == "motion" ? QUELL_TYPE_MOTION : QUELL_TYPE_COLOR;
  const PortTypeInfo& about = info(item.type());
  if (about.channels != info(type).channels || about.format != QUELL_FORMAT_F32)
    throw Error(Fault::input, file(frame).string(),
                "is read as " + std::string(about.name) + ", but " + std::string(info(type).name) + " is wanted, of " +
                    std::to_string(info(type).channels) + " channels");
  return item.image()->as(type);
}

bool ImageSeries::is_display_referred(BufferPool& pool) const {
  // Frames that are asked for may have no file.
  const auto first = std::ranges::find_if(wanted_, [this](std::int64_t frame) { return has(frame); });
  const std::int64_t frame = first == wanted_.end() ? frames_.front() : *first;
  const StoredImage stored = sequence_->read_stored(input_, single_.value_or(frame), pool);
  return stored.conventions.transfer == Transfer::srgb;
}

Operand parse_operand(const std::string& text) {
  const std::size_t equals = text.find('=');
  std::error_code error;
  if (equals == std::string::npos || fs::exists(text, error)) return {"", text};
  const std::string label = text.substr(0, equals);
  if (label.find_first_of(":#%/") != std::string::npos) return {"", text};  // part of a pattern, or of its settings
  if (label.empty()) throw Error(Fault::usage, text, "the label before '=' is empty; write LABEL=FILES, or the files alone");
  return {label, text.substr(equals + 1)};
}

namespace {

/// Labels become parts of file names.
std::string clean(std::string name) {
  for (char& c : name)
    if (c == '/' || static_cast<unsigned char>(c) < 0x20) c = '_';
  return name;
}

/// The reference's, in messages.
constexpr const char* kReferenceLabel = "reference";

/// The names of the first rank at which all are distinct, of the series that need one; else those of the first rank.
std::vector<std::string> choose_names(const std::vector<const ImageSeries*>& series) {
  std::size_t ranks = SIZE_MAX;
  for (const ImageSeries* one : series) ranks = std::min(ranks, one->names().size());
  const auto names_at = [&](std::size_t rank) {
    std::vector<std::string> names;
    for (const ImageSeries* one : series)
      names.push_back(rank < one->names().size() ? clean(one->names()[rank]) : std::string("image"));
    return names;
  };
  for (std::size_t rank = 0; rank < ranks; ++rank) {
    const std::vector<std::string> names = names_at(rank);
    std::set<std::string> distinct(names.begin(), names.end());
    if (distinct.size() == names.size() && !distinct.contains(kReferenceLabel)) return names;
  }
  return names_at(0);
}

}  // namespace

std::vector<std::string> make_labels(const std::vector<Operand>& operands, const std::vector<ImageSeries>& series) {
  std::set<std::string> taken;
  std::vector<const ImageSeries*> nameless;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const std::string& label = operands[i].label;
    if (label.empty()) {
      nameless.push_back(&series[i]);
    } else if (label != clean(label) || label.front() == '.') {
      throw Error(Fault::usage, operands[i].what,
                  "'" + label + "' cannot be a label: files are named after it; leave out '/', line breaks and a '.' in front");
    } else if (label == kReferenceLabel) {
      throw Error(Fault::usage, operands[i].what, "the label 'reference' is that of the first operand; choose another");
    } else if (!taken.insert(label).second) {
      throw Error(Fault::usage, operands[i].what, "the label '" + label + "' is given twice; choose another");
    }
  }
  const std::vector<std::string> names = choose_names(nameless);
  std::vector<std::string> labels;
  for (std::size_t i = 0, at = 0; i < operands.size(); ++i) {
    std::string label = operands[i].label;
    if (label.empty()) {
      label = names[at++];
      for (int n = 2; label == kReferenceLabel || !taken.insert(label).second; ++n)
        label = names[at - 1] + "-" + std::to_string(n);
    }
    labels.push_back(std::move(label));
  }
  return labels;
}

}  // namespace quell::app
