#include "console.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <utility>

#include "quell/text/diagnostic.h"

namespace quell::app {
namespace {

constexpr std::string_view kErrorMark = ": error: ";

bool names_its_place(std::string_view text) { return text.substr(0, text.find('\n')).find(kErrorMark) != std::string_view::npos; }

struct Style {
  std::string_view label, color;
};

Style style_of(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::critical:
    case spdlog::level::err:
      return {"error: ", "\x1b[1;31m"};
    case spdlog::level::warn:
      return {"warning: ", "\x1b[1;33m"};
    default:
      return {"", ""};
  }
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value && *value;
}

bool is_dumb_terminal() {
  const char* term = std::getenv("TERM");
  return !term || std::string_view(term) == "dumb";
}

}  // namespace

Console::Console(std::FILE* stream, bool is_terminal, bool has_colors)
    : stream_(stream), is_terminal_(is_terminal), has_colors_(has_colors) {}

int Console::columns() const {
  winsize size{};
  return ioctl(fileno(stream_), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

void Console::set_status(std::string line) {
  const std::scoped_lock lock(mutex_);
  if (!is_terminal_) return;
  erase_status();
  status_ = std::move(line);
  draw_status();
}

void Console::erase_status() {
  if (!status_.empty()) std::fputs("\r\x1b[K", stream_);
}

void Console::draw_status() {
  if (!status_.empty()) std::fputs(status_.c_str(), stream_);
  std::fflush(stream_);
}

void Console::sink_it_(const spdlog::details::log_msg& message) {
  std::string text = printable({message.payload.data(), message.payload.size()});  // files' names may hold anything
  const Style style = style_of(message.level);
  if (!style.label.empty() && !names_its_place(text)) {
    const std::string label(style.label);
    if (text.starts_with(label)) text.erase(0, label.size());  // a graph's error without a place has its own
    text.insert(0, has_colors_ ? std::string(style.color) + label + "\x1b[0m" : label);
  }
  text += '\n';
  erase_status();
  std::fputs(text.c_str(), stream_);
  draw_status();
}

void Console::flush_() { std::fflush(stream_); }

std::shared_ptr<Console> open_console() {
  const bool is_terminal = isatty(STDERR_FILENO) == 1 && !is_dumb_terminal();
  auto console = std::make_shared<Console>(stderr, is_terminal, is_terminal && !is_set("NO_COLOR"));
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("quell", console));
  return console;
}

void set_verbosity(Verbosity verbosity) {
  switch (verbosity) {
    case Verbosity::quiet:
      return spdlog::set_level(spdlog::level::warn);
    case Verbosity::normal:
      return spdlog::set_level(spdlog::level::info);
    case Verbosity::verbose:
      return spdlog::set_level(spdlog::level::debug);
  }
}

}  // namespace quell::app
