#include "memory_promise.h"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "quell/runtime/executor.h"

namespace quell::app {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;
constexpr int kLargeBlock = 1 << 20;         // bytes, from which on blocks are given back
constexpr std::size_t kProgram = 24 * kMiB;  // libraries and tables that are touched only when the run is on its way
constexpr std::size_t kThread = 2 * kMiB;    // stack, and small blocks that the C library keeps for a thread
constexpr std::size_t kRowsAtATime = 64;     // of a file; as image_file_read.cpp and exr_writer.cpp have it
constexpr std::size_t kCopies = 4;           // of these: as the file has them, unpacked, and as floats, beside OpenEXR's own
constexpr std::size_t kPlanesMeasured = 24;  // of an image and its reference: both, and what metrics make of them
constexpr std::size_t kGrain = 4 * kMiB;     // so that two runs of one command are told the same

// A field of /proc/self/status, in bytes.
std::size_t read_status(const std::string& field) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(field + ":")) return std::stoull(line.substr(field.size() + 1)) * 1024;
  return 0;
}

std::size_t pixels(const Shape& shape) {
  return static_cast<std::size_t>(shape.size.width) * static_cast<std::size_t>(shape.size.height);
}

// Bytes of the widest rows that are decoded or encoded at a time.
std::size_t rows_of_a_file(const Plan& plan) {
  constexpr std::size_t kMostChannels = 4;  // that one image is read from or written as
  std::size_t width = 0;
  for (const Shape& input : plan.inputs)
    if (input.present && is_image(input.type)) width = std::max(width, static_cast<std::size_t>(input.size.width));
  for (const PlannedResult& result : plan.results())
    if (const Shape shape = plan.shape(result.from); is_image(shape.type))
      width = std::max(width, static_cast<std::size_t>(shape.size.width));
  return width * kRowsAtATime * kMostChannels * sizeof(float);
}

}  // namespace

void steady_allocation() { mallopt(M_MMAP_THRESHOLD, kLargeBlock); }

std::size_t resident_bytes() { return read_status("VmRSS"); }
std::size_t peak_resident_bytes() { return read_status("VmHWM"); }

std::size_t estimate_beside_images(const Job& job, int threads, bool measures) {
  const auto count = static_cast<std::size_t>(threads > 0 ? threads : available_threads());
  std::size_t largest = 0;
  for (const PlannedResult& result : job.plan.results())
    if (const Shape shape = job.plan.shape(result.from); is_image(shape.type)) largest = std::max(largest, pixels(shape));
  std::size_t bytes = resident_bytes() + kProgram + (2 * count + 1) * kThread + count * kCopies * rows_of_a_file(job.plan);
  if (measures) bytes += count * kPlanesMeasured * largest * sizeof(float);
  return (bytes + kGrain - 1) / kGrain * kGrain;
}

}  // namespace quell::app
