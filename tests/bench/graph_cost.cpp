// What graphs that ship cost, a line each: name, and milliseconds a frame at 1920 x 1080 on two threads. graphs/measure asks for
// it.
#include <charconv>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>

#include "quell/simd/isa.h"
#include "quell/text/error.h"
#include "tests/bench/figure.h"
#include "tests/bench/graph_times.h"

namespace quell::bench {
namespace {

// "1920x1080"
Size read_size(std::string_view text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ptr == end || *width.ptr != 'x' || std::from_chars(width.ptr + 1, end, size.height).ptr != end || size.width < 1 ||
      size.height < 1)
    throw Error(Fault::usage, "graph_cost", "a size is like 1920x1080");
  return size;
}

void run(int argc, char** argv) {
  Size size{1920, 1080};
  int first = 1;
  if (argc > 2 && std::string_view(argv[1]) == "--size") size = read_size(argv[2]), first = 3;
  if (first == argc) throw Error(Fault::usage, "graph_cost", "usage: graph_cost [--size WIDTHxHEIGHT] GRAPH...");
  pin_isa_from_environment();
  for (int i = first; i < argc; ++i) {
    std::printf("%s %.1f\n", argv[i], 1e3 * time_graph(argv[i], size, acceptance_threads()).best.frame);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace quell::bench

int main(int argc, char** argv) {
  try {
    quell::bench::run(argc, argv);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
