#include "tests/layering/layering.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>

namespace quell::test {
namespace {

using Names = std::set<std::string, std::less<>>;

// What each box of core/ may include besides itself. A pass is a box of its own that sees the SDK alone.
const std::map<std::string, Names, std::less<>> kMayInclude = {
    {"core/sdk", {}},
    {"core/simd", {"sdk", "text"}},
    {"core/text", {"sdk"}},
    {"core/image", {"sdk", "text"}},
    {"core/plugin", {"sdk", "text", "image"}},
    {"core/graph", {"sdk", "text", "image", "plugin"}},
    {"core/runtime", {"sdk", "text", "image", "plugin", "graph"}},
    {"core/sequence", {"sdk", "text", "image"}},
    {"core/metrics", {"sdk", "simd", "text", "image"}},
    {"core/testing", {"sdk", "simd", "text", "image", "plugin", "graph", "runtime"}},
    {"passes", {"sdk", "simd"}},
    {"apps", {"sdk", "simd", "text", "image", "plugin", "graph", "runtime", "sequence", "metrics"}},
};

// Third-party headers by the first part of their path, and where they may appear.
const std::map<std::string, Names, std::less<>> kThirdParty = {
    {"nlohmann", {"core/text"}},  {"OpenImageIO", {"core/sequence"}},
    {"tbb", {"core/runtime"}},    {"oneapi", {"core/runtime"}},
    {"OpenColorIO", {"passes"}},  {"hwy", {"passes", "core/metrics", "core/simd"}},
    {"spdlog", {"apps"}},         {"CLI", {"apps"}},
    {"xxhash.h", {"core/graph"}}, {"gtest", {"core/testing"}},
    {"gmock", {"core/testing"}},  {"xmmintrin.h", {"core/runtime"}},
    {"nlopt.hpp", {"apps"}},      {"zlib.h", {"apps"}},
};

// The operating system's headers. The SDK and the passes do without.
const Names kSystem = {"malloc.h",   "sys/prctl.h",    "sys/signalfd.h", "dlfcn.h",       "elf.h",         "fcntl.h",
                       "link.h",     "netdb.h",        "poll.h",         "sched.h",       "sys/socket.h",  "sys/time.h",
                       "signal.h",   "spawn.h",        "unistd.h",       "sys/eventfd.h", "sys/inotify.h", "sys/ioctl.h",
                       "sys/mman.h", "sys/resource.h", "sys/stat.h",     "sys/types.h",   "sys/wait.h"};
const Names kCHeaders = {"stddef.h", "stdint.h"};  // abi.h is C

/// "core/graph" for core/graph/plan.cpp, "passes" and "apps" for all that lies below these.
std::string box_of(const std::string& file) {
  const std::size_t first = file.find('/');
  if (file.substr(0, first) != "core") return file.substr(0, first);
  return file.substr(0, file.find('/', first + 1));
}

struct Include {
  std::string path;
  bool quoted;
};

/// The include that a line makes, if it makes one.
std::optional<Include> parse_include(std::string_view line) {
  const auto skip = [&](std::string_view word) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.substr(0, word.size()) != word) return false;
    line.remove_prefix(word.size());
    return true;
  };
  if (!skip("#") || !skip("include")) return std::nullopt;
  const bool quoted = skip("\"");
  if (!quoted && !skip("<")) return std::nullopt;
  return Include{std::string(line.substr(0, line.find_first_of("\">"))), quoted};
}

std::string fault_in_quoted(const std::string& file, const std::string& box, const std::string& path) {
  const Names& allowed = kMayInclude.at(box);
  if (path.find("..") != std::string::npos) return "paths go down from the root or stay in their folder, never up";
  if (path.find('/') == std::string::npos) return {};  // a neighbor
  if (path.rfind("quell/", 0) == 0) {
    const std::string other = path.substr(6, path.find('/', 6) - 6);
    if (allowed.count(other) || box == "core/" + other) return {};
    return box + " may not include core/" + other;
  }
  const std::string folder = file.substr(0, file.rfind('/') + 1);
  const std::string own = box == "apps" ? "apps/" : folder;
  return path.rfind(own, 0) == 0 ? "" : box + " includes only \"quell/...\" and its own folder";
}

std::string fault_in_angle(const std::string& box, const std::string& path) {
  const bool is_standard = path.find_first_of("/.") == std::string::npos || kCHeaders.count(path);
  if (is_standard) return {};
  if (kSystem.count(path))
    return box == "core/sdk" || box == "passes" ? box + " may not include headers of the operating system" : "";
  const auto library = kThirdParty.find(path.substr(0, path.find('/')));
  if (library == kThirdParty.end()) return "this header is not known; third-party headers are listed in tests/layering";
  if (library->second.count(box)) return {};
  return library->first + " is visible in " + *library->second.begin() + " only";
}

}  // namespace

std::vector<std::string> find_bad_includes(const std::string& file, std::string_view text) {
  const std::string box = box_of(file);
  if (!kMayInclude.count(box)) return {file + ":1: the folder " + box + " has no place in the layering"};
  std::vector<std::string> faults;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::optional<Include> include = parse_include(line);
    if (!include) continue;
    const std::string fault = include->quoted ? fault_in_quoted(file, box, include->path) : fault_in_angle(box, include->path);
    if (!fault.empty()) faults.push_back(file + ":" + std::to_string(number) + ": " + line + ": " + fault);
  }
  return faults;
}

}  // namespace quell::test
