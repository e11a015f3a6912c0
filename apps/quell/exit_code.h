// What the runner's exit status tells scripts and render farms.
#pragma once

#include "quell/text/error.h"

namespace quell::app {

enum ExitCode : int {
  kOk = 0,
  kFramesFailed = 1,
  kFoundWrong = 1,    // inspect: what was tested is wrong
  kUsage = 2,         // command line, graph or parameter
  kInput = 3,         // a sequence, image or camera that is missing or unreadable
  kPlugin = 4,        // a plugin that was asked for does not load, or a pass breaks the interface
  kMemory = 33,       // the memory limit is too small for a single frame; render farms try again with more
  kInternal = 70,     // EX_SOFTWARE of sysexits.h
  kInterrupted = 75,  // EX_TEMPFAIL: the same command may be given again
};

constexpr ExitCode exit_code(Fault fault) {
  switch (fault) {
    case Fault::usage:
      return kUsage;
    case Fault::input:
      return kInput;
    case Fault::plugin:
      return kPlugin;
    case Fault::frame:
      return kFramesFailed;
    case Fault::memory:
      return kMemory;
  }
  return kInternal;
}

}  // namespace quell::app
