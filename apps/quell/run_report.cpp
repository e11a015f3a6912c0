#include "run_report.h"

#include <spdlog/spdlog.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "machine.h"
#include "memory_promise.h"
#include "quell/sequence/pending_file.h"
#include "text_output.h"

namespace quell::app {
namespace {

constexpr int kVersion = 1;

JsonObject machine() {
  const Machine about = describe_machine();
  return JsonObject()
      .text("processor", about.processor)
      .text("system", about.system)
      .number("processors", about.processors)
      .text("isa", about.isa);
}

std::string current_folder() {
  std::error_code error;
  return std::filesystem::current_path(error).string();
}

/// An object a line, so that a person finds a frame.
std::string list(const std::vector<JsonObject>& objects) {
  std::string text;
  for (const JsonObject& object : objects) text += (text.empty() ? "\n" : ",\n") + object.str();
  return "[" + text + (text.empty() ? "]" : "\n]");
}

}  // namespace

RunReport::RunReport(std::filesystem::path file) : file_(std::move(file)), started_(utc_time()) {
  require_writable(file_.string(), kRunReportBeginning, "--report");
  std::error_code error;
  std::filesystem::remove(file_, error);
  if (error) throw Error(Fault::usage, "--report", file_.string() + " cannot be replaced: " + error.message());
}

void RunReport::resume(const PastFrames& past) {
  before_ = JsonObject().text("done", range_text(past.done)).text("failed", range_text(past.failed));
}

void RunReport::start(const Job& job, const std::vector<ResultFiles>& results, const JsonObject& record) {
  run_ = record;
  for (std::size_t i = 0; i < job.frames.size(); ++i)
    for (const ResultFiles& series : results) files_[job.frames[i]].push_back(series.files[i].string());
}

void RunReport::frame(const FrameReport& report, const Plan& plan, JsonObject record) {
  frames_.push_back(record.texts("files", report.ok ? files_[report.frame] : std::vector<std::string>()));
  for (const ReplacedValues& values : report.replaced) replaced_[values.input] += values.count;
  if (report.node_seconds.size() == plan.nodes.size())
    for (std::size_t i = 0; i < plan.nodes.size(); ++i)
      node_seconds_[plan.graph->nodes[static_cast<std::size_t>(plan.nodes[i].node)].name] += report.node_seconds[i];
  read_seconds_ += report.read_seconds, write_seconds_ += report.write_seconds;
}

void RunReport::message(const JsonObject& record) {
  const std::scoped_lock lock(mutex_);
  messages_.push_back(record);
}

JsonObject RunReport::totals() const {
  JsonObject replaced, nodes;
  for (const auto& [input, count] : replaced_) replaced.number(input, count);
  for (const auto& [node, seconds] : node_seconds_) nodes.seconds(node, seconds);
  return JsonObject()
      .number("frames", frames_.size())
      .seconds("read_seconds", read_seconds_)
      .seconds("write_seconds", write_seconds_)
      .object("node_seconds", nodes)
      .object("replaced", replaced)
      .number("peak_resident_bytes", peak_resident_bytes());
}

std::string RunReport::text(const JsonObject& end, ExitCode code) const {
  JsonObject head;
  head.text("version", QUELL_VERSION)
      .texts("command", command_words())
      .text("folder", current_folder())
      .object("machine", machine())
      .text("started", started_)
      .text("ended", utc_time());
  std::string text = std::string(kRunReportBeginning) + std::to_string(kVersion) + ",\n" + head.members() + ",\n" +
                     end.members() + ",\"exit_code\":" + std::to_string(static_cast<int>(code)) +
                     ",\n\"totals\":" + totals().str() + ",\n";
  if (!before_.members().empty()) text += "\"before\":" + before_.str() + ",\n";
  if (!run_.members().empty()) text += "\"run\":" + run_.str() + ",\n";
  return text + "\"messages\":" + list(messages_) + ",\n\"frames\":" + list(frames_) + "}\n";
}

bool RunReport::end(const JsonObject& end, ExitCode code) {
  std::string whole;
  {
    const std::scoped_lock lock(mutex_);
    whole = text(end, code);
  }
  forget();
  try {
    PendingFile pending(file_);
    std::ofstream stream(pending.path(), std::ios::binary);
    stream << whole;
    stream.close();
    if (!stream) throw Error(Fault::usage, "--report", file_.string() + " cannot be written: " + std::strerror(errno));
    pending.commit();
    return true;
  } catch (const Error& error) {
    spdlog::error(error.what());
    return false;
  }
}

// With --watch another run follows.
void RunReport::forget() {
  const std::scoped_lock lock(mutex_);
  started_ = utc_time();
  before_ = run_ = {};
  frames_.clear(), messages_.clear(), files_.clear(), replaced_.clear(), node_seconds_.clear();
  read_seconds_ = write_seconds_ = 0;
}

}  // namespace quell::app
