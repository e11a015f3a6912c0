// Numbers of many pixels, summed up.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace quell {

/// Collects numbers and tells how they are spread.
class Distribution {
 public:
  void add(double value) { values_.push_back(static_cast<float>(value)), sorted_ = false; }
  std::size_t count() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  /// The smallest number that at least this share (0 to 1) of all does not exceed; 0 when there are none.
  double quantile(double share) const;
  double median() const { return quantile(0.5); }
  double max() const { return quantile(1); }
  /// The share of the numbers that are at most `limit`; 0 when there are none.
  double share_within(double limit) const;

 private:
  mutable std::vector<float> values_;
  mutable bool sorted_ = false;
  void sort() const;
};

/// "0.0031", "4.7", "152"
std::string short_number(double value);
/// "0.0031 px"
std::string pixels(double value);
/// "97 %", "99.98 %", "all" for everything, "none" for nothing: what is rounded never claims either.
std::string percent(double share);
std::string percent_of(double share, const std::string& noun);

}  // namespace quell
