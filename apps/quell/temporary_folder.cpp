#include "temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "quell/text/error.h"

namespace quell::app {
namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  std::string path = (fs::temp_directory_path(error) / "quell-XXXXXX").string();
  if (error || !mkdtemp(path.data()))
    throw Error(Fault::usage, "TMPDIR",
                "no temporary folder can be made: " + (error ? error.message() : std::strerror(errno)) +
                    "; name a folder that can be written to");
  path_ = path;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace quell::app
