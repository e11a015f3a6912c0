#include "skip_existing.h"

#include <algorithm>
#include <map>
#include <optional>
#include <regex>

#include "quell/graph/preroll.h"
#include "quell/runtime/executor.h"
#include "quell/sequence/image_file.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

using Expected = std::vector<FileAttribute>;

// "color.#.exr", however the number was written: "color.####.exr", "color.%04d.exr".
std::string without_digits(const std::string& pattern) {
  static const std::regex kNumber("#+|%0?[0-9]*d");
  return std::regex_replace(pattern, kNumber, "#");
}

bool looks_back(const Plan& plan) {
  return std::ranges::any_of(plan.histories, [](const PlannedHistory& kept) { return kept.frames > 0; });
}

bool is_image_file(const fs::path& file) { return file.extension() != ".json"; }

void read_whole(const fs::path& path) {
  ImageFile file(path);
  std::vector<float> floats;
  std::vector<std::uint32_t> ids;
  for (int channel = 0; channel < static_cast<int>(file.channels().size()); ++channel) {
    const Rectangle window = file.data_window(channel);
    const auto count = static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
    if (is_integer(file.channels()[static_cast<std::size_t>(channel)].numbers)) {
      ids.resize(count);
      file.read(channel, window, IdOutput{window.width, window.height, 1, window.width, 0, ids.data()});
    } else {
      floats.resize(count);
      file.read({channel}, window, FloatOutput{window.width, window.height, 1, window.width, 0, floats.data()});
    }
  }
}

bool tells(const fs::path& path, const Expected& expected) {
  const std::vector<ImageFile::Attribute> found = ImageFile(path).attributes();
  return std::ranges::all_of(expected, [&](const FileAttribute& wanted) {
    return std::ranges::any_of(found, [&](const ImageFile::Attribute& attribute) {
      return attribute.name == wanted.name && attribute.text == wanted.text;
    });
  });
}

class Finder {
 public:
  Finder(const Job& job, const std::vector<ResultFiles>& results, const FileSinkOptions& output)
      : job_(job), results_(results), output_(output) {}

  // By place in the job's frames.
  std::vector<char> find() const {
    const std::vector<std::optional<fs::file_time_type>> latest = find_latest_inputs();
    std::vector<char> trusted(job_.frames.size(), 0);
    Executor executor;
    executor.run(static_cast<std::int64_t>(job_.frames.size()), [&](std::int64_t index, std::uint32_t) {
      const auto i = static_cast<std::size_t>(index);
      trusted[i] = latest[i] && is_trusted(i, *latest[i]);
    });
    return trusted;
  }

 private:
  bool is_trusted(std::size_t i, fs::file_time_type made_of) const {
    for (const ResultFiles& series : results_) {
      const fs::path& file = series.files[i];
      std::error_code error;
      const fs::file_time_type written = fs::last_write_time(file, error);
      if (error || written < made_of) return false;
      if (!is_image_file(file)) continue;
      try {
        if (!tells(file, expected(series, i))) return false;
        read_whole(file);
      } catch (const Error&) { return false; }  // it is written anew
    }
    return true;
  }

  Expected expected(const ResultFiles& series, std::size_t i) const {
    Expected all = output_.attributes;
    std::erase_if(all, [](const FileAttribute& attribute) { return !attribute.name.starts_with("quell:"); });
    const bool is_layers = !output_.layers.empty() && series.files[i].extension() == ".exr";
    const auto image = std::ranges::find(output_.images, series.result, &ResultImage::name);
    if (is_layers)
      all.insert(all.end(), output_.layered_attributes.begin(), output_.layered_attributes.end());
    else if (image != output_.images.end())
      all.insert(all.end(), image->attributes.begin(), image->attributes.end());
    all.push_back({"quell:frame", std::to_string(job_.frames[i])});
    return all;
  }

  // Of what each frame is made of, earlier frames included where history counts; nothing where a file is missing.
  std::vector<std::optional<fs::file_time_type>> find_latest_inputs() const {
    std::vector<std::optional<fs::file_time_type>> all;
    std::optional<fs::file_time_type> before;
    for (const std::int64_t frame : job_.frames) {
      std::optional<fs::file_time_type> latest = looks_back(job_.plan) ? before : std::nullopt;
      bool complete = true;
      for (const InputFiles& input : job_.inputs) {
        std::error_code error;
        const fs::file_time_type time = fs::last_write_time(job_.sequence->file(input.input, frame), error);
        complete = complete && !error;
        if (!error) latest = std::max(latest.value_or(time), time);
      }
      before = latest;
      all.push_back(complete ? latest : std::nullopt);
    }
    return all;
  }

  const Job& job_;
  const std::vector<ResultFiles>& results_;
  const FileSinkOptions& output_;
};

}  // namespace

std::string describe_inputs(const Job& job, const SequenceArguments& sequence, const SessionOptions& options,
                            const Surroundings& around) {
  std::string text;
  const auto add = [&](const std::string& what, const std::string& value) {
    text += (text.empty() ? "" : "; ") + what + "=" + value;
  };
  for (const InputFiles& input : job.inputs) add(input.input, without_digits(fs::path(input.pattern).filename().string()));
  if (sequence.window) add("window", *sequence.window);
  if (sequence.crop) add("crop", *sequence.crop);
  if (!looks_back(job.plan)) return text;
  if (!options.cuts.empty()) add("cuts", FrameRange(options.cuts).text());
  add("history from", std::to_string(around.history_from));
  return text;
}

void skip_existing(Job& job, Surroundings& around, const std::vector<ResultFiles>& results, const FileSinkOptions& output) {
  const std::vector<char> trusted = Finder(job, results, output).find();
  std::vector<std::int64_t> there, wanted;
  for (std::size_t i = 0; i < trusted.size(); ++i) (trusted[i] ? there : wanted).push_back(job.frames[i]);
  if (there.empty()) return;
  const std::size_t all = job.frames.size();
  job.frames = wanted;
  if (wanted.empty()) {
    around.history_only.clear();
    return spdlog::info("all {} frames are there already", all);
  }
  // What is there serves the history of what is not: as far as that reaches back, or from the very beginning.
  const std::optional<int> reach = find_preroll(job.plan, 0).frames;
  std::vector<std::int64_t> history = join(around.history_only, there);
  std::erase_if(history, [&](std::int64_t frame) {
    const auto next = std::ranges::upper_bound(wanted, frame);
    return next == wanted.end() || (reach && frame < *next - *reach);
  });
  around.history_only = std::move(history);
  const std::size_t again = around.history_only.size();
  spdlog::info("{} of {} frames are there already{}", there.size(), all,
               again > 0 ? "; of " + std::to_string(again) + " the history is computed" : "");
}

}  // namespace quell::app
