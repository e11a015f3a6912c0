#include <opencv2/core.hpp>
#include <opencv2/ximgproc/edge_filter.hpp>

#include "tests/bench/references/bilateral.h"

namespace quell::bench {

std::vector<Float3> filter_with_opencv(const InterleavedFrame& frame, const BilateralSettings& settings, int threads) {
  cv::setNumThreads(threads);
  const auto image = [&](const std::vector<Float3>& pixels) {  // OpenCV has no images that are const
    return cv::Mat(frame.height, frame.width, CV_32FC3, const_cast<Float3*>(pixels.data()));
  };
  std::vector<Float3> filtered(frame.color.size());
  cv::Mat result = image(filtered);
  cv::ximgproc::jointBilateralFilter(image(frame.normal), image(frame.color), result, 2 * settings.radius + 1,
                                     settings.sigma_normal, settings.sigma_coord);
  return filtered;
}

}  // namespace quell::bench
