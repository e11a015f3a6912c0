#include "text_output.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "quell/sequence/pending_file.h"
#include "quell/text/error.h"
#include "results.h"

namespace quell::app {

void require_writable(const std::string& out, std::string_view beginning, const char* option) {
  const std::filesystem::path file = out;
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    throw Error(Fault::usage, option, file.string() + " is not a file; choose another name");
  refuse_to_replace_others(file, beginning, option);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (access(folder.c_str(), W_OK) != 0)
    throw Error(Fault::usage, option, file.string() + " cannot be written: " + std::strerror(errno));
}

void write_output(const std::string& text, const std::optional<std::string>& out, std::string_view beginning,
                  const char* option) {
  if (!out) {
    std::cout << text;
    return;
  }
  require_writable(*out, beginning, option);
  const std::filesystem::path file = *out;
  PendingFile pending(file);
  std::ofstream stream(pending.path(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw Error(Fault::usage, option, file.string() + " cannot be written: " + std::strerror(errno));
  pending.commit();
}

}  // namespace quell::app
