#include "quell/sequence/file_pattern.h"

#include <algorithm>
#include <charconv>

namespace quell {
namespace {

constexpr int kMaxDigits = 20;  // no frame number has more
constexpr std::string_view kCounters = "write the frame number as %d, %04d or ####";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct Counter {
  std::size_t offset, length;
  int digits;
  bool sign_counts;
};

struct Mistake {
  std::size_t offset;
  std::string what;
};

/// Takes a pattern's text apart into literal text and counters.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  std::string literal[2];  // before and after the counter
  std::optional<Counter> counter;

  void scan() {
    if (const std::size_t zero = text_.find('\0'); zero != std::string_view::npos) fail(zero, "no file's name holds a zero byte");
    for (std::size_t i = 0; i < text_.size();) {
      if (text_[i] == '#') {
        const std::size_t end = std::min(text_.find_first_not_of('#', i), text_.size());
        i = add({i, end - i, static_cast<int>(std::min<std::size_t>(end - i, kMaxDigits + 1)), false});
      } else if (text_.substr(i, 2) == "%%") {
        literal[counter ? 1 : 0] += '%';
        i += 2;
      } else if (text_[i] == '%') {
        i = scan_percent(i);
      } else {
        literal[counter ? 1 : 0] += text_[i++];
      }
    }
    if (!counter) fail(0, "the pattern has no frame number; " + std::string(kCounters));
  }

  [[noreturn]] void fail(std::size_t offset, const std::string& what) const { throw Mistake{offset, what}; }

 private:
  std::size_t scan_percent(std::size_t start) {
    std::size_t i = start + 1;
    int digits = 1;
    if (i < text_.size() && text_[i] == '0') {
      const auto [end, error] = std::from_chars(text_.data() + i, text_.data() + text_.size(), digits);
      if (error != std::errc()) digits = kMaxDigits + 1;
      i = static_cast<std::size_t>(end - text_.data());
    }
    if (i >= text_.size() || text_[i] != 'd')
      fail(start, "unknown counter; " + std::string(kCounters) + ", and a percent sign as %%");
    return add({start, i + 1 - start, std::max(digits, 1), true});
  }

  std::size_t add(const Counter& found) {
    if (counter) fail(found.offset, "a second frame number; a pattern has one (a percent sign is written %%)");
    if (found.digits > kMaxDigits) fail(found.offset, "more than " + std::to_string(kMaxDigits) + " digits");
    counter = found;
    return found.offset + found.length;
  }

  std::string_view text_;
};

}  // namespace

std::string padded(std::int64_t number, int digits) {
  std::string text = std::to_string(number);
  const std::size_t sign = number < 0 ? 1 : 0;
  const std::size_t wanted = static_cast<std::size_t>(digits) + sign;
  if (text.size() < wanted) text.insert(sign, wanted - text.size(), '0');
  return text;
}

FilePattern::FilePattern(std::filesystem::path folder, std::string prefix, int digits, std::string suffix)
    : folder_(std::move(folder)), prefix_(std::move(prefix)), suffix_(std::move(suffix)), digits_(digits) {
  const auto escaped = [](const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '%' ? "%%" : std::string(1, c);
    return result;
  };
  const std::string counter = digits > 1 ? std::string(static_cast<std::size_t>(digits), '#') : "%d";
  name_ = escaped(prefix_) + counter + escaped(suffix_);
}

FilePattern FilePattern::parse(std::string_view text, const std::filesystem::path& base, const std::string& source) {
  Diagnostics errors;
  const auto whole = std::make_shared<const SourceText>(SourceText{source, std::string(text)});
  const auto pattern = parse(text, base, Position{whole, 0}, errors);
  errors.throw_if_any(Fault::usage);
  return *pattern;
}

std::optional<FilePattern> FilePattern::parse(std::string_view text, const std::filesystem::path& base, const Position& where,
                                              Diagnostics& errors) {
  try {
    Scanner scanner(text);
    scanner.scan();
    const Counter& counter = *scanner.counter;
    if (text.find('/', counter.offset) != std::string_view::npos)
      scanner.fail(counter.offset, "the frame number must be in the file's name, not in a folder's");
    const std::size_t slash = scanner.literal[0].rfind('/');  // npos + 1 is 0
    const std::filesystem::path folder = (base / scanner.literal[0]).parent_path();
    FilePattern pattern(folder, scanner.literal[0].substr(slash + 1), counter.digits, scanner.literal[1]);
    pattern.sign_counts_ = counter.sign_counts;
    pattern.name_ = text.substr(text.rfind('/') + 1);
    return pattern;
  } catch (const Mistake& mistake) {
    errors.error(Position{where.source, where.offset + mistake.offset}, mistake.what);
    return std::nullopt;
  }
}

FilePattern FilePattern::single(const std::filesystem::path& file, std::int64_t frame) {
  FilePattern pattern;
  pattern.folder_ = file.parent_path();
  pattern.prefix_ = pattern.name_ = file.filename().string();
  pattern.single_frame_ = frame;
  return pattern;
}

std::string FilePattern::stem() const {
  std::string stem = prefix_;
  if (single_frame_) {
    const auto numbered = take_apart(prefix_);
    stem = numbered ? numbered->prefix : prefix_.substr(0, prefix_.rfind('.'));
  }
  if (!stem.empty() && (stem.back() == '.' || stem.back() == '_')) stem.pop_back();
  return stem;
}

std::optional<NumberedName> take_apart(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || dot == 0) return std::nullopt;
  std::size_t start = dot;
  while (start > 0 && is_digit(name[start - 1])) --start;
  if (start == dot) return std::nullopt;
  if (start > 0 && name[start - 1] == '-') --start;
  if (dot - start > kMaxDigits || start < 2 || (name[start - 1] != '.' && name[start - 1] != '_')) return std::nullopt;
  return NumberedName{name.substr(0, start), name.substr(start, dot - start), name.substr(dot)};
}

std::string FilePattern::file_name(std::int64_t frame) const {
  if (single_frame_) return prefix_;
  const int sign = sign_counts_ && frame < 0 ? 1 : 0;
  return prefix_ + padded(frame, std::max(digits_ - sign, 1)) + suffix_;
}

std::optional<FilePattern::Match> FilePattern::match(std::string_view name) const {
  if (single_frame_) return name == prefix_ ? std::optional(Match{*single_frame_, true}) : std::nullopt;
  if (name.size() <= prefix_.size() + suffix_.size()) return std::nullopt;
  if (!name.starts_with(prefix_) || !name.ends_with(suffix_)) return std::nullopt;
  const std::string_view number = name.substr(prefix_.size(), name.size() - prefix_.size() - suffix_.size());
  const std::string_view digits = number.substr(number[0] == '-' ? 1 : 0);
  if (digits.empty() || !std::all_of(digits.begin(), digits.end(), is_digit)) return std::nullopt;
  std::int64_t frame = 0;
  if (std::from_chars(number.data(), number.data() + number.size(), frame).ec != std::errc()) return std::nullopt;
  return Match{frame, file_name(frame) == name};
}

FrameFiles find_frames(const FilePattern& pattern, const std::vector<std::string>& listing) {
  FrameFiles found;
  for (const std::string& name : listing) {
    const auto match = pattern.match(name);
    if (!match) continue;
    if (match->exact)
      found.frames.push_back(match->frame);
    else
      found.padded_otherwise.push_back(name);
  }
  std::sort(found.frames.begin(), found.frames.end());
  return found;
}

std::vector<std::string> list_files(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  const std::filesystem::path real = folder.empty() ? "." : folder;
  std::filesystem::directory_iterator entry(real, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;  // a dangling link is simply no file
    if (entry->is_regular_file(ignored)) names.push_back(entry->path().filename().string());
  }
  if (error) throw Error(Fault::input, real.string(), "the folder cannot be read: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace quell
