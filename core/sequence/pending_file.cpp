#include "quell/sequence/pending_file.h"

#include <unistd.h>

#include <atomic>
#include <string>

#include "quell/text/error.h"

namespace quell {

PendingFile::PendingFile(std::filesystem::path final_path) : final_(std::move(final_path)) {
  // The process and a count make it unique here, the host among the machines that write into a shared folder.
  static std::atomic<unsigned> count{0};
  char host[256] = "host";
  gethostname(host, sizeof host - 1);
  temporary_ = final_.parent_path() / ("." + final_.filename().string() + "." + host + "-" + std::to_string(getpid()) + "-" +
                                       std::to_string(count++) + ".tmp");
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void PendingFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, final_, error);
  if (error) throw Error(Fault::frame, final_.string(), "cannot be written: " + error.message());
  committed_ = true;
}

}  // namespace quell
