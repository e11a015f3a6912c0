#include "quell/sequence/frame_range.h"

#include <algorithm>
#include <charconv>

namespace quell {
namespace {

constexpr std::string_view kExample = "write frames as 1-100, 1-100x2 (every second) or 1,5,9-12";

std::string grouped(std::uint64_t n) {
  std::string digits = std::to_string(n);
  for (int i = static_cast<int>(digits.size()) - 3; i > 0; i -= 3) digits.insert(static_cast<std::size_t>(i), " ");
  return digits;
}

/// a <= b. Wraps around to the right answer, where the signed difference would overflow.
std::uint64_t distance(std::int64_t a, std::int64_t b) { return static_cast<std::uint64_t>(b) - static_cast<std::uint64_t>(a); }

struct Mistake {
  std::size_t offset;
  std::string what;
};

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  std::vector<std::int64_t> parse() {
    do { parse_range(); } while (accept(","));
    if (at_ < text_.size()) fail(at_, "'" + std::string(1, text_[at_]) + "' does not belong here; " + std::string(kExample));
    return std::move(frames_);
  }

 private:
  [[noreturn]] void fail(std::size_t offset, const std::string& what) const { throw Mistake{offset, what}; }

  void skip_spaces() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }

  /// One of the characters of `any`, with the spaces around it.
  bool accept(std::string_view any) {
    skip_spaces();
    if (at_ == text_.size() || any.find(text_[at_]) == std::string_view::npos) return false;
    ++at_;
    skip_spaces();
    return true;
  }

  std::int64_t parse_number(std::string_view expected) {
    skip_spaces();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range) fail(at_, "this number does not fit 64 bits");
    if (error != std::errc()) fail(at_, std::string(expected) + " is missing here; " + std::string(kExample));
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  void parse_range() {
    skip_spaces();
    const std::size_t start = at_;
    const std::int64_t first = parse_number("a frame number");
    if (!accept("-")) {
      if (at_ < text_.size() && (text_[at_] == 'x' || text_[at_] == ':'))
        fail(at_, "a step needs a range before it, such as 1-100x2");
      return add(start, first, first, 1);
    }
    const std::size_t last_at = at_;
    const std::int64_t last = parse_number("the last frame of the range");
    if (last < first)
      fail(last_at, "the range descends; write " + std::to_string(last) + "-" + std::to_string(first) +
                        " (frames always run in ascending order)");
    std::int64_t step = 1;
    if (accept("x:")) {
      const std::size_t step_at = at_;
      step = parse_number("the step");
      if (step < 1) fail(step_at, "the step must be at least 1");
    }
    add(start, first, last, static_cast<std::uint64_t>(step));
  }

  void add(std::size_t start, std::int64_t first, std::int64_t last, std::uint64_t step) {
    const std::uint64_t steps = distance(first, last) / step;
    if (steps >= FrameRange::kMaxFrames - frames_.size())
      fail(start, "more than " + grouped(FrameRange::kMaxFrames) + " frames; is there a digit too many?");
    for (std::uint64_t i = 0; i <= steps; ++i)
      frames_.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(first) + i * step));
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::int64_t> frames_;
};

}  // namespace

FrameRange::FrameRange(std::vector<std::int64_t> frames) : frames_(std::move(frames)) {
  std::sort(frames_.begin(), frames_.end());
  frames_.erase(std::unique(frames_.begin(), frames_.end()), frames_.end());
}

FrameRange FrameRange::parse(std::string_view text, const std::string& source) {
  Diagnostics errors;
  const auto whole = std::make_shared<const SourceText>(SourceText{source, std::string(text)});
  const auto range = parse(text, Position{whole, 0}, errors);
  errors.throw_if_any(Fault::usage);
  return *range;
}

std::optional<FrameRange> FrameRange::parse(std::string_view text, const Position& where, Diagnostics& errors) {
  try {
    return FrameRange(Parser(text).parse());
  } catch (const Mistake& mistake) {
    errors.error(Position{where.source, where.offset + mistake.offset}, mistake.what);
    return std::nullopt;
  }
}

bool FrameRange::contains(std::int64_t frame) const { return std::binary_search(frames_.begin(), frames_.end(), frame); }

std::string FrameRange::text() const {
  if (frames_.empty()) return "none";
  std::string text;
  for (std::size_t i = 0; i < frames_.size();) {
    std::size_t last = i;  // of the run of equal steps that starts at i
    const std::uint64_t step = i + 1 < frames_.size() ? distance(frames_[i], frames_[i + 1]) : 0;
    while (last + 1 < frames_.size() && distance(frames_[last], frames_[last + 1]) == step) ++last;
    // In 1,5,9-12 the 9 begins the longer run after it.
    if (step > 1 && last + 1 < frames_.size() && distance(frames_[last], frames_[last + 1]) == 1) --last;
    if (step > 1 && last < i + 2) last = i;
    text += (text.empty() ? "" : ",") + std::to_string(frames_[i]);
    if (last > i) text += "-" + std::to_string(frames_[last]) + (step > 1 ? "x" + std::to_string(step) : "");
    i = last + 1;
  }
  return text;
}

}  // namespace quell
