#include "quell/sequence/checks/channel_statistics.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace quell {
namespace {

constexpr int kBand = 64;  // rows: at least two blocks of nearly every compression
constexpr std::size_t kMostBytes = std::size_t{256} << 20;

struct Sum {
  ChannelStatistics statistics;
  double sum = 0;

  void add(float value) {
    if (std::isnan(value)) {
      ++statistics.nan;
    } else if (std::isinf(value)) {
      ++statistics.infinite;
    } else {
      statistics.min = statistics.finite == 0 ? value : std::min<double>(statistics.min, value);
      statistics.max = statistics.finite == 0 ? value : std::max<double>(statistics.max, value);
      ++statistics.finite, sum += value;
    }
  }
};

/// How many channels of a part are read at a time: all, where they are not so many that a band of them fills the memory.
std::size_t channels_at_a_time(const Rectangle& window) {
  return std::max<std::size_t>(1, kMostBytes / (sizeof(float) * kBand * static_cast<std::size_t>(window.width)));
}

/// Channels of one part, whose data window they share.
void measure_channels_of(ImageFile& file, const std::vector<int>& channels, std::vector<Sum>& sums,
                         const std::function<void(int)>& rows_done) {
  const Rectangle window = file.data_window(channels.front());
  const auto planes = static_cast<std::ptrdiff_t>(channels.size());
  std::vector<float> pixels(static_cast<std::size_t>(window.width) * kBand * channels.size());
  for (int y = 0; y < window.height; y += kBand) {
    const int rows = std::min(kBand, window.height - y);
    const FloatOutput out{window.width, rows, static_cast<int>(planes), window.width, std::ptrdiff_t{window.width} * rows,
                          pixels.data()};
    file.read(channels, {window.x, window.y + y, window.width, rows}, out);
    for (int c = 0; c < out.channels; ++c)
      for (int row = 0; row < rows; ++row)
        for (int x = 0; x < out.width; ++x)
          sums[static_cast<std::size_t>(channels[static_cast<std::size_t>(c)])].add(out.row(row, c)[x]);
    rows_done(rows);
  }
}

}  // namespace

std::vector<ChannelStatistics> measure_channels(ImageFile& file, const std::function<void(double)>& progress) {
  std::map<int, std::vector<int>> parts;
  for (int i = 0; i < static_cast<int>(file.channels().size()); ++i)
    parts[file.channels()[static_cast<std::size_t>(i)].part].push_back(i);
  std::vector<std::vector<int>> groups;
  double all_rows = 0, done = 0;
  for (const auto& [part, channels] : parts) {
    const Rectangle& window = file.data_window(channels.front());
    const std::size_t most = channels_at_a_time(window);
    for (std::size_t i = 0; i < channels.size(); i += most, all_rows += window.height) {
      const auto begin = channels.begin() + static_cast<std::ptrdiff_t>(i);
      groups.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(std::min(most, channels.size() - i)));
    }
  }
  std::vector<Sum> sums(file.channels().size());
  for (const std::vector<int>& group : groups)
    measure_channels_of(file, group, sums, [&](int rows) { progress((done += rows) / all_rows); });
  std::vector<ChannelStatistics> all;
  for (Sum& sum : sums) {
    if (sum.statistics.finite > 0) sum.statistics.mean = sum.sum / static_cast<double>(sum.statistics.finite);
    all.push_back(sum.statistics);
  }
  return all;
}

}  // namespace quell
