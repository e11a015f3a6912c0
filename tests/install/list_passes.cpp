// Prints the passes that a registry finds, one a line with its file, then what went wrong.
#include <iostream>

#include "quell/plugin/registry.h"

int main(int count, char** arguments) {
  const quell::Registry registry = quell::load_plugins({arguments + 1, arguments + count});
  for (const auto& [id, pass] : registry.passes()) std::cout << id << " " << pass.file.string() << "\n";
  int failures = 0;
  for (const quell::PluginReport& report : registry.reports()) {
    if (report.error.empty()) continue;
    std::cerr << report.file.string() << ": " << report.error << "\n";
    ++failures;
  }
  return failures;
}
