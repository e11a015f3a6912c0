// Shows images in tev (https://github.com/Tom94/tev), a viewer, while they are made.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "quell/image/stream.h"

namespace quell::app {

/// Hands everything on to another sink, and sends images to a running tev by its protocol over TCP: each becomes an image of its
/// own, named `output.frame`. A tev that goes away meanwhile is told once, and does not end the run. Thread-safe.
class TevSink final : public FrameSink {
 public:
  /// Connects. The other sink must outlive this one. `address` is HOST:PORT, or HOST, with tev's own port 14158; HOST may be
  /// [IPV6]. Throws Error(usage) naming --tev when nobody answers.
  TevSink(FrameSink& sink, const std::string& address);
  ~TevSink() override;

  void write(std::string_view output, std::int64_t frame, const Item& item) override;
  bool uses_processor() const override;

 private:
  struct State;
  FrameSink& sink_;
  std::unique_ptr<State> state_;
};

}  // namespace quell::app
