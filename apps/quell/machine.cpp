#include "machine.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "quell/runtime/executor.h"
#include "quell/sdk/abi.h"
#include "quell/simd/isa.h"

namespace quell::app {
namespace {

std::string read(const char* file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string first_line(const char* file) {
  const std::string text = read(file);
  return text.substr(0, text.find('\n'));
}

/// x86 names the processor in its "model name"; elsewhere it may have none.
std::string processor_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "";
}

}  // namespace

Machine describe_machine() {
  return {processor_name(), first_line("/proc/sys/kernel/ostype") + " " + first_line("/proc/sys/kernel/osrelease"), current_isa(),
          available_threads()};
}

std::vector<std::string> command_words() {
  std::vector<std::string> words;
  const std::string text = read("/proc/self/cmdline");
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\0', at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

std::string version_text() {
  return std::string("quell ") + QUELL_VERSION + " (plugin interface " + std::to_string(QUELL_ABI_MAJOR) + "." +
         std::to_string(QUELL_ABI_MINOR) + ")";
}

}  // namespace quell::app
