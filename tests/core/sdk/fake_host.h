// A host for tests of the SDK alone: it runs chunks in the order that the test asks for, and notes what it is told.
#pragma once

#include <string>
#include <vector>

#include "quell/sdk/abi.h"

namespace quell::test {

struct FakeHost {
  bool backwards = false;       // run the last chunk first
  std::int64_t cancel_at = -1;  // cancelled once this many chunks were asked; -1: never
  std::int64_t asked = 0;
  std::string error;
  std::vector<std::string> logged;
  quell_host raw{sizeof(quell_host), QUELL_ABI_VERSION, this, parallel_for, log, cancelled, set_error};

 private:
  static FakeHost& self(const quell_host* host) { return *static_cast<FakeHost*>(host->context); }
  static quell_status parallel_for(const quell_host* host, std::int64_t begin, std::int64_t end, std::int64_t grain,
                                   quell_chunk_fn fn, void* context) {
    const std::int64_t chunks = (end - begin + grain - 1) / grain;
    quell_status lowest = QUELL_OK;
    std::int64_t lowest_chunk = chunks;
    for (std::int64_t i = 0; i < chunks; ++i) {
      const std::int64_t chunk = self(host).backwards ? chunks - 1 - i : i;
      const std::int64_t from = begin + chunk * grain;
      const quell_status status = fn(context, chunk, from, from + grain < end ? from + grain : end, chunk % 2);
      if (status != QUELL_OK && chunk < lowest_chunk) lowest = status, lowest_chunk = chunk;
    }
    return lowest;
  }
  static void log(const quell_host* host, int level, const char* text) {
    self(host).logged.push_back(std::to_string(level) + ":" + text);
  }
  static int cancelled(const quell_host* host) {
    FakeHost& fake = self(host);
    return fake.cancel_at >= 0 && fake.asked++ >= fake.cancel_at;
  }
  static void set_error(const quell_host* host, const char* text) { self(host).error = text; }
};

}  // namespace quell::test
