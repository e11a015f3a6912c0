#include "shot_files.h"

#include <cerrno>
#include <cstring>
#include <memory>

#include "quell/sequence/frame_range.h"
#include "quell/text/shell_word.h"
#include "results.h"
#include "run_report.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view kLogBeginning = "quell batch: ";

std::string text_of(const Json& object, std::string_view key) {
  const Json* value = object.find(key);
  return value ? value->string : "";
}

std::vector<std::string> texts_of(const Json& object, std::string_view key) {
  std::vector<std::string> texts;
  if (const Json* list = object.find(key))
    for (const Json& element : list->elements) texts.push_back(element.string);
  return texts;
}

std::int64_t count_of(const Json& object, std::string_view key) {
  const std::string range = text_of(object, key);
  if (range.empty()) return 0;
  Diagnostics ignored;
  const std::optional<FrameRange> frames = FrameRange::parse(range, object.where, ignored);
  return frames ? static_cast<std::int64_t>(frames->frames().size()) : 0;
}

/// Without what it says of frames.
ShotReport interpret(const Json& root) {
  ShotReport report;
  report.version = text_of(root, "version"), report.folder = text_of(root, "folder");
  report.outcome = text_of(root, "outcome"), report.error = text_of(root, "error");
  report.command = texts_of(root, "command");
  report.done = count_of(root, "done"), report.failed = count_of(root, "failed");
  if (const Json* before = root.find("before"))
    report.done += count_of(*before, "done"), report.failed += count_of(*before, "failed");
  report.frames = report.done + report.failed + count_of(root, "not_computed");
  if (const Json* code = root.find("exit_code")) report.exit_code = static_cast<int>(code->integer);
  return report;
}

}  // namespace

void ShotFiles::refuse_to_replace_others() const {
  app::refuse_to_replace_others(log, kLogBeginning, "--logs");
  app::refuse_to_replace_others(events, R"({"event":")", "--logs");
  app::refuse_to_replace_others(report, kRunReportBeginning, "--logs");
}

void ShotFiles::begin(const std::vector<std::string>& command) const {
  std::error_code error;
  for (const fs::path& file : {log, events, report}) fs::remove(file, error);
  std::ofstream stream(log, std::ios::binary);
  stream << kLogBeginning << "quell";
  for (const std::string& word : command) stream << ' ' << shell_word(word);
  stream << std::endl;
  if (!stream) throw Error(Fault::usage, "--logs", log.string() + " cannot be written: " + std::strerror(errno));
}

std::optional<ShotReport> read_shot_report(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  try {
    Diagnostics errors;
    const std::optional<Json> root = parse_json(read_text(file, Fault::input), errors);
    if (!root || !root->find("quell_run")) return std::nullopt;
    ShotReport report = interpret(*root);
    if (const Json* frames = root->find("frames"))
      for (const Json& frame : frames->elements) {
        if (report.error.empty()) report.error = text_of(frame, "error");
        for (std::string& name : texts_of(frame, "files")) report.files.push_back(std::move(name));
      }
    return report;
  } catch (const Error&) { return std::nullopt; }
}

void EventReader::read(const std::function<void(const Json&)>& take) {
  std::ifstream stream(file_, std::ios::binary);
  if (!stream) return;
  stream.seekg(read_);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {  // a line without its end is still being written
    read_ += static_cast<std::streamoff>(line.size()) + 1;
    Diagnostics errors;
    if (const auto event = parse_json(std::make_shared<SourceText>(SourceText{file_.string(), line}), errors)) take(*event);
  }
}

}  // namespace quell::app
