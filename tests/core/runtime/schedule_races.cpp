// Runs a pass that races under the concurrent schedule: schedule_races PASS FRAMES_IN_FLIGHT. Built with a race detector alone,
// which must tell.
#include <cstdlib>

#include "tests/core/runtime/memory_stream.h"

int main(int count, char** arguments) {
  using namespace quell;
  if (count != 3) return 2;
  const auto graph =
      test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"racy": {"pass": ")" +
                 std::string(arguments[1]) + R"(", "in": {"color": "color"}}}, "outputs": {"color": "racy.color"}})");
  MemorySource source;
  source.size = {8, 64};
  MemorySink sink;
  Session(graph, {.threads = 4, .frames_in_flight = std::atoi(arguments[2])}).run({1, 2, 3, 4}, source, sink);
  return sink.items.size() == 4 ? 0 : 1;
}
