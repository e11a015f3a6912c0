#include "new_files.h"

#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>

#include "quell/sequence/pending_file.h"
#include "quell/text/error.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

/// Takes back what was made, last first, unless it is kept.
class Undo {
 public:
  ~Undo() {
    std::error_code ignored;
    for (auto path = made_.rbegin(); path != made_.rend(); ++path) fs::remove(*path, ignored);  // folders only when empty
  }
  void made(const fs::path& path) { made_.push_back(path); }
  void keep() { made_.clear(); }

 private:
  std::vector<fs::path> made_;
};

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw Error(Fault::frame, path.string(), "cannot be written: " + why);
}

void make_folders(const fs::path& folder, Undo& undo) {
  std::error_code error;
  if (folder.empty() || fs::is_directory(folder, error)) return;
  make_folders(folder.parent_path(), undo);
  if (fs::create_directory(folder, error)) undo.made(folder);
  if (error) fail(folder, error.message());
}

void write(const fs::path& file, const std::string& text, const fs::path& final_path) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) fail(final_path, std::strerror(errno));
}

/// Also a link that leads nowhere.
void refuse_existing(const fs::path& file) {
  std::error_code error;
  if (fs::symlink_status(file, error).type() != fs::file_type::not_found)
    throw Error(Fault::usage, file.string(), "exists already, and nothing is ever overwritten; choose another name or folder");
}

}  // namespace

void NewFiles::add(fs::path file, std::string text) { files_.push_back({std::move(file), std::move(text), false}); }
void NewFiles::replace(fs::path file, std::string text) { files_.push_back({std::move(file), std::move(text), true}); }

void NewFiles::commit() const {
  for (const File& file : files_)
    if (!file.replaces) refuse_existing(file.path);
  Undo undo;
  std::deque<PendingFile> pending;
  for (const File& file : files_) {
    make_folders(file.path.parent_path(), undo);
    write(pending.emplace_back(file.path).path(), file.text, file.path);
  }
  for (std::size_t i = 0; i < files_.size(); ++i) {
    if (!files_[i].replaces) refuse_existing(files_[i].path);
    pending[i].commit();
    if (!files_[i].replaces) undo.made(files_[i].path);
  }
  undo.keep();
}

}  // namespace quell::app
