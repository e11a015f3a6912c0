#include "quell/sequence/checked_output.h"

#include <OpenImageIO/filesystem.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "quell/sequence/oiio.h"
#include "quell/text/error.h"

namespace quell {

/// A file that OpenImageIO writes to. OpenImageIO itself does not look whether its PNG writer's data arrive, nor at what a file
/// still holds when it is closed, so that on a full disk half a picture would pass for whole.
class CheckedOutput::File final : public OIIO::Filesystem::IOFile {
 public:
  explicit File(const std::filesystem::path& file) : IOFile(std::fopen(file.c_str(), "wb"), Write) { note(m_file != nullptr); }
  ~File() override { finish(); }

  std::size_t write(const void* data, std::size_t size) override {
    const std::size_t written = IOFile::write(data, size);
    note(written == size);
    return written;
  }
  bool seek(std::int64_t offset) override {  // writes what was held back
    const bool ok = IOFile::seek(offset);
    note(ok);
    return ok;
  }
  void close() override {}  // finish() does, and looks

  /// Writes what is left and closes the file.
  void finish() {
    if (m_file) note(std::fclose(m_file) == 0);
    m_file = nullptr;
  }
  /// The errno of the first failure; 0 for none.
  int error() const { return error_; }

 private:
  void note(bool ok) {
    if (!ok && error_ == 0) error_ = errno;
  }
  int error_ = 0;
};

CheckedOutput::CheckedOutput(const char* format, const std::filesystem::path& file, OIIO::ImageSpec spec) : path_(file) {
  prepare_oiio();
  file_ = std::make_unique<File>(file);
  output_ = OIIO::ImageOutput::create(format);
  if (!output_)
    throw Error(Fault::frame, file.string(), "OpenImageIO cannot write " + std::string(format) + ": " + OIIO::geterror());
  OIIO::Filesystem::IOProxy* const proxy = file_.get();  // as an attribute, for the EXR writer forgets set_ioproxy()
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  check(output_->open(file.string(), spec));
}

CheckedOutput::~CheckedOutput() = default;

void CheckedOutput::check(bool ok) {
  if (ok && file_->error() == 0) return;
  const std::string why = one_line(output_->geterror());  // asked for in any case: what is not asked for is printed
  throw Error(Fault::frame, path_.string(), "cannot be written: " + (file_->error() ? std::strerror(file_->error()) : why));
}

void CheckedOutput::write_rows(int begin, int end, OIIO::TypeDesc type, const void* pixels) {
  check(output_->write_scanlines(begin, end, 0, type, pixels));
}

void CheckedOutput::close() {
  check(output_->close());
  file_->finish();
  check(true);
}

}  // namespace quell
