#include "checkpoint.h"

#include <unistd.h>

#include <cctype>
#include <exception>
#include <fstream>
#include <mutex>
#include <system_error>

#include "quell/sequence/item_file.h"
#include "quell/sequence/pending_file.h"
#include "quell/text/error.h"

namespace quell::app {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kPrefix = "history.";

/// "03.blend.color.41.exr": names of nodes may hold what a file's may not, and the number makes it unique.
std::string name_of_file(std::size_t number, const SavedHistory::Kept& kept) {
  constexpr std::size_t kLongest = 100;
  std::string name = kept.from.substr(0, kLongest);
  for (char& letter : name)
    if (!std::isalnum(static_cast<unsigned char>(letter)) && letter != '.') letter = '_';
  return (number < 10 ? "0" : "") + std::to_string(number) + "." + name + "." + std::to_string(kept.frame) +
         item_extension(kept.item.type());
}

[[noreturn]] void fail(const fs::path& file, const std::error_code& error) {
  throw Error(Fault::frame, file.string(), "the checkpoint cannot be written: " + error.message());
}

void replace_text(const fs::path& file, const std::string& text) {
  PendingFile pending(file);
  std::ofstream stream(pending.path(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) fail(file, std::make_error_code(std::errc::io_error));
  pending.commit();
}

}  // namespace

CheckpointFolder::CheckpointFolder(fs::path folder, RunTraits traits) : folder_(std::move(folder)), traits_(std::move(traits)) {}

std::optional<CheckpointManifest> CheckpointFolder::find() const {
  std::error_code error;
  if (!fs::exists(manifest(), error)) return std::nullopt;
  CheckpointManifest found = read_manifest(manifest());
  const std::string differences = list_differences(traits_, found.run);
  if (differences.empty()) return found;
  throw Error(Fault::usage, "--resume",
              "the checkpoint in " + folder_.string() + " is of another run:" + differences +
                  "\nresults would not be those of one run; give the same command, or leave out --resume to begin anew");
}

SavedHistory CheckpointFolder::read(const CheckpointManifest& manifest, BufferPool& pool) const {
  SavedHistory history{manifest.frame, manifest.shapes, {}, manifest.resets};
  for (const CheckpointManifest::Kept& kept : manifest.history)
    history.items.push_back({kept.from, kept.frame, read_item(folder_ / manifest.folder / kept.file, kept.type, pool)});
  return history;
}

std::vector<CheckpointManifest::Kept> CheckpointFolder::write_items(const std::vector<SavedHistory::Kept>& items,
                                                                    const fs::path& folder, Executor& executor) const {
  std::vector<CheckpointManifest::Kept> written;
  for (std::size_t i = 0; i < items.size(); ++i)
    written.push_back({items[i].from, items[i].frame, items[i].item.type(), name_of_file(i, items[i])});
  std::mutex mutex;
  std::exception_ptr failure;
  const auto write = [&](std::int64_t chunk, std::uint32_t) {
    const auto i = static_cast<std::size_t>(chunk);
    try {
      write_item(items[i].item, items[i].frame, folder / written[i].file);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      failure = std::current_exception();
    }
  };
  executor.run(static_cast<std::int64_t>(items.size()), write);
  if (failure) std::rethrow_exception(failure);
  return written;
}

void CheckpointFolder::write(const SavedHistory& history, const PastFrames& past, Executor& executor) const {
  std::error_code error;
  std::string name = std::string(kPrefix) + std::to_string(history.frame);
  while (fs::exists(folder_ / name, error)) name += "b";  // the manifest in force may name it
  const fs::path temporary = folder_ / (std::string(kPrefix) + std::to_string(getpid()) + ".tmp"), final = folder_ / name;
  fs::remove_all(temporary, error);
  if (!fs::create_directories(temporary, error)) fail(temporary, error);
  try {
    CheckpointManifest manifest{history.frame, past, traits_, history.shapes, history.resets, name, {}};
    manifest.history = write_items(history.items, temporary, executor);
    fs::rename(temporary, final, error);
    if (error) fail(final, error);
    replace_text(this->manifest(), write_manifest(manifest));
  } catch (...) {
    fs::remove_all(temporary, error);
    throw;
  }
  remove_folders_but(name);
}

void CheckpointFolder::remove_folders_but(const std::string& kept) const {
  std::error_code error;
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error))
    if (const std::string name = entry.path().filename().string(); name.starts_with(kPrefix) && name != kept)
      old.push_back(entry.path());
  for (const fs::path& folder : old) fs::remove_all(folder, error);
}

}  // namespace quell::app
