#include "quell/image/image.h"

#include <unistd.h>

#include <cassert>
#include <string>

#include "quell/text/error.h"

namespace quell {
namespace {

constexpr std::ptrdiff_t kLine = 64 / sizeof(float);  // elements in a cache line, which is also the widest vector

std::size_t physical_memory() {
  static const std::size_t bytes =
      static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return bytes;
}

std::string gibibytes(std::size_t bytes) {
  const std::size_t tenths = bytes / ((std::size_t{1} << 30) / 10);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " GiB";
}

[[noreturn]] void refuse(Size size, const std::string& why) {
  throw Error(Fault::input, "",
              "an image of " + std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels" + why);
}

// What only a broken or hostile header asks for, told before memory is taken: the system would hand it out, and kill the program
// when it is used.
void check_size(PortType type, Size size) {
  const auto allowed = [](int side) { return side >= 1 && side <= Image::kMaxSize; };
  if (!allowed(size.width) || !allowed(size.height))
    refuse(size, "; sides from 1 to " + std::to_string(Image::kMaxSize) + " are possible");
  const std::size_t bytes = Image::bytes_needed(type, size);
  if (bytes > physical_memory())
    refuse(size, " takes " + gibibytes(bytes) + "; this machine has " + gibibytes(physical_memory()));
}

}  // namespace

std::ptrdiff_t Image::row_stride(int width) {
  const std::ptrdiff_t lines = (width + kLine - 1) / kLine;
  return (lines + 1) * kLine;  // one line more, so that a whole vector may be loaded from the last pixel on
}

std::size_t Image::bytes_needed(PortType type, Size size) {
  return static_cast<std::size_t>(info(type).channels) * static_cast<std::size_t>(size.height) *
         static_cast<std::size_t>(row_stride(size.width)) * sizeof(float);
}

Image::Image(PortType type, Size size, BufferPool& pool, int spare_lines) : type_(type), size_(size) {
  assert(is_image(type));
  check_size(type, size);
  row_stride_ = row_stride(size.width) + spare_lines * kLine;
  plane_stride_ = row_stride_ * size.height + spare_lines * kLine;
  buffer_ = pool.acquire(static_cast<std::size_t>(plane_stride_) * static_cast<std::size_t>(channels()) * sizeof(float));
}

Image Image::as(PortType type) const {
  assert(info(type).channels == info(type_).channels && info(type).format == info(type_).format);
  Image other = *this;
  other.type_ = type;
  return other;
}

void Image::require([[maybe_unused]] quell_format format) const { assert(buffer_ && info(type_).format == format); }

quell_image Image::raw() const {
  return {sizeof(quell_image),
          static_cast<std::uint32_t>(type_),
          static_cast<std::uint32_t>(info(type_).format),
          static_cast<std::uint32_t>(channels()),
          size_.width,
          size_.height,
          row_stride_,
          plane_stride_,
          buffer_.data()};
}

}  // namespace quell
