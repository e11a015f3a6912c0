// What a report shows of a run: its images, collected while frames are written.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "quell/image/stream.h"
#include "report_pixels.h"

namespace quell::app {

using Names = std::set<std::string, std::less<>>;

/// Names, as a sink is told them, of what weights of filters are made of: it is kept exactly, since they have to reproduce what
/// the passes gave.
struct Weighed {
  Names now;     ///< of inner frames
  Names before;  ///< of the frames before these
};

/// A series of images of one name.
struct ReportImage {
  enum class Kind {
    noisy,      ///< the sequence's color
    reference,  ///< what results should look like
    result,     ///< an output of a graph
    input,      ///< another input of the sequence
    inner,      ///< what a node yields
  };
  std::string name;  ///< of an inner image "node.port"
  Kind kind = Kind::result;
  int graph = -1;  ///< of results and inner images
  PortType type = QUELL_TYPE_COLOR;
  std::map<std::int64_t, int> frames;  ///< numbers of PackedImages
};

struct ReportFrames {
  std::vector<std::int64_t> all;  ///< that are computed
  std::set<std::int64_t> kept;    ///< whose images are shown
  std::set<std::int64_t> inner;   ///< of these, whose inner images are shown, too
  std::set<std::int64_t> before;  ///< that end right before one of `inner`: of what they left to it, images are kept, too
};

/// Keeps the images of outputs and dumps of one graph. Thread-safe.
class ReportSink final : public FrameSink {
 public:
  /// `results` are names of outputs. What is given must outlive the sink.
  ReportSink(const ReportFrames& frames, Names results, Weighed weighed, PackedImages& packed);

  void write(std::string_view output, std::int64_t frame, const Item& item) override;
  bool uses_processor() const override { return true; }

  /// What a frame left that failed.
  void forget(std::int64_t frame);
  /// By the name that the sink was told. Not while one is written.
  const std::map<std::string, ReportImage, std::less<>>& images() const { return images_; }

 private:
  const ReportFrames& frames_;
  const Names results_;
  const Weighed weighed_;
  PackedImages& packed_;
  std::mutex mutex_;
  std::map<std::string, ReportImage, std::less<>> images_;
};

}  // namespace quell::app
