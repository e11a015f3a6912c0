// A pass by itself on images in memory: what it takes, without a session and its files.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quell/runtime/single_frame.h"

namespace quell::bench {

struct PassSetup {
  std::string pass;
  std::string params = "{}";           ///< as JSON
  std::map<std::string, Item> inputs;  ///< by port
  std::vector<std::string> outputs = {"color"};
};

class PassRunner {
 public:
  /// Throws Error when the pass refuses the setup.
  PassRunner(PassSetup setup, int threads);

  /// Computes once, and returns the seconds that it took. Memory is there from the second time on.
  double run();
  /// Of the last run.
  const Image& output(std::string_view port = "color") const;

 private:
  PassSetup setup_;
  std::unique_ptr<Executor> executor_;
  HostServices services_;
  BufferPool pool_;
  std::unique_ptr<PlanState> plan_;
  std::unique_ptr<Lane> lane_;
  std::vector<std::pair<std::string, Item>> outputs_;
};

}  // namespace quell::bench
