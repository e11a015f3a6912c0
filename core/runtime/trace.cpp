#include "quell/runtime/trace.h"

#include <ostream>

namespace quell {

struct Trace::State {
  std::ostream& out;
};

Trace::Trace(std::ostream& out) : state_(std::make_unique<State>(State{out})) {}
Trace::~Trace() = default;
void Trace::slice(Kind, std::string_view, std::int64_t, Clock::time_point, Clock::time_point) {}
void Trace::memory(const BufferPool::Usage&) {}
void Trace::finish() {}

}  // namespace quell
