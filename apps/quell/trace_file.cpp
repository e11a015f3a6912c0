#include "trace_file.h"

#include <cerrno>
#include <cstring>

#include "quell/text/error.h"
#include "results.h"

namespace quell::app {
namespace {

std::filesystem::path checked(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    throw Error(Fault::usage, "--trace", file.string() + " is not a file; choose another name");
  refuse_to_replace_others(file, R"([{"ph":"M")", "--trace");
  return file;
}

}  // namespace

TraceFile::TraceFile(const std::filesystem::path& file)
    : file_(checked(file)), stream_(file_.path(), std::ios::binary), trace_(stream_) {
  if (!stream_) throw Error(Fault::usage, "--trace", file.string() + " cannot be written: " + std::strerror(errno));
}

void TraceFile::commit() {
  trace_.finish();
  stream_.close();
  if (!stream_) throw Error(Fault::frame, "--trace", std::string("the file could not be written: ") + std::strerror(errno));
  file_.commit();
}

}  // namespace quell::app
