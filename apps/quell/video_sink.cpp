#include "video_sink.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>

#include "console.h"
#include "quell/metrics/display.h"
#include "quell/sequence/pending_file.h"
#include "quell/text/error.h"
#include "report_pixels.h"
#include "results.h"

extern char** environ;

namespace quell::app {
namespace {

namespace fs = std::filesystem;
using Picture = std::vector<std::uint8_t>;  // rows of red, green and blue

struct Format {
  std::string_view extension, name, codec;
};
constexpr std::array<Format, 4> kFormats{
    {{".mp4", "mp4", "libx264"}, {".mov", "mov", "libx264"}, {".mkv", "matroska", "libx264"}, {".webm", "webm", "libvpx-vp9"}}};

const Format* find_format(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  const auto found = std::ranges::find(kFormats, extension, &Format::extension);
  return found == kFormats.end() ? nullptr : &*found;
}

std::uint8_t to_8(float linear) {
  return static_cast<std::uint8_t>(std::lround(255 * to_display(DisplayTransform::srgb, std::isnan(linear) ? 0 : linear)));
}

/// By the bits of half floats, which tell more values apart than 8 bits do.
const std::array<std::uint8_t, 65536>& bytes_of_halves() {
  static const std::array<std::uint8_t, 65536> table = [] {
    std::array<std::uint8_t, 65536> bytes{};
    bytes[0x7c00] = 255;  // infinity; negative values and NaN stay 0
    for (std::uint32_t bits = 0; bits < 0x7c00; ++bits) {
      const int exponent = static_cast<int>(bits >> 10), fraction = static_cast<int>(bits & 1023);
      bytes[bits] = to_8(exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                       : std::ldexp(static_cast<float>(1024 + fraction), exponent - 25));
    }
    return bytes;
  }();
  return table;
}

Picture to_picture(FloatImage image) {
  const std::array<std::uint8_t, 65536>& bytes = bytes_of_halves();
  Picture picture;
  picture.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) picture.push_back(bytes[to_half(image.at(x, y, c))]);
  return picture;
}

std::vector<std::string> ffmpeg_words(const VideoOptions& options, const fs::path& to) {
  const Format& format = *find_format(options.file);
  const std::string size = std::to_string(options.size.width) + "x" + std::to_string(options.size.height);
  // Most players want even sizes and halved colors. The curve of sRGB is near enough to BT.709's to be told as such.
  return {"ffmpeg",
          "-hide_banner",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "rgb24",
          "-video_size",
          size,
          "-framerate",
          std::to_string(options.frames_per_second),
          "-i",
          "pipe:0",
          "-an",
          "-vf",
          "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
          "-pix_fmt",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-c:v",
          std::string(format.codec),
          "-crf",
          "16",
          "-b:v",
          "0",
          "-f",
          std::string(format.name),
          "file:" + to.string()};  // or what stands before a colon would be a protocol
}

}  // namespace

bool is_video(const fs::path& file) { return find_format(file) != nullptr; }

void check_video_file(const fs::path& file) {
  std::error_code error;
  if (fs::exists(file, error) && !fs::is_regular_file(file, error))
    throw Error(Fault::usage, "--out",
                file.string() + " is to be a video, but " +
                    (fs::is_directory(file, error) ? "a folder" : "something that is no file") +
                    " has this name; choose another one");
}

PlannedResult find_video_output(const Plan& plan) {
  std::vector<PlannedResult> colors;
  for (const PlannedResult& result : plan.results())
    if (plan.shape(result.from).type == QUELL_TYPE_COLOR) colors.push_back(result);
  const auto color = std::ranges::find(colors, "color", &PlannedResult::name);
  if (color != colors.end()) return *color;
  if (colors.size() == 1) return colors.front();
  throw Error(Fault::usage, "--out",
              colors.empty()
                  ? "the graph has no output of type color that a video could show; name a folder for images"
                  : "a video shows the output 'color', which the graph does not have, or its only color output; it has " +
                        std::to_string(colors.size()) + "; name a folder for images");
}

struct VideoSink::State {
  VideoOptions options;
  PendingFile file;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> words{std::tmpfile(), &std::fclose};  // of ffmpeg
  pid_t process = 0;
  int to = -1;  // its standard input: a socket, since writing to a pipe that nobody reads would end this program
  std::mutex mutex;
  std::map<std::int64_t, Picture> waiting;
  Picture last;
  int before_first = 0;  // frames that failed before there was a picture
  bool is_empty = true, is_broken = false;

  explicit State(VideoOptions given) : options(std::move(given)), file(options.file) {}
  ~State() {
    if (to >= 0) close(to);
    if (process <= 0) return;
    kill(process, SIGTERM);
    wait();
  }

  void start() {
    std::array<int, 2> ends{};
    if (!words || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw Error(Fault::usage, "--out", std::string("ffmpeg cannot be started: ") + std::strerror(errno));
    to = ends[1];
    posix_spawn_file_actions_t actions{};
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, fileno(words.get()), STDERR_FILENO);
    // A group of its own: Ctrl-C is for this program, which then finishes the video.
    posix_spawnattr_t attributes{};
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::vector<std::string> texts = ffmpeg_words(options, file.path());
    std::vector<char*> arguments;
    for (std::string& text : texts) arguments.push_back(text.data());
    arguments.push_back(nullptr);
    const int error = posix_spawnp(&process, arguments.front(), &actions, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    if (error == 0) return;
    process = 0;
    if (error == ENOENT)
      throw Error(Fault::usage, "--out",
                  "videos are made by the program 'ffmpeg', which is not in PATH; install it (on Debian: apt install ffmpeg), or "
                  "name a folder for images");
    throw Error(Fault::usage, "--out", std::string("ffmpeg does not start: ") + std::strerror(error));
  }

  int wait() {
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {}
    process = 0;
    return status;
  }

  [[noreturn]] void fail() {
    std::string text(4096, '\0');
    std::rewind(words.get());
    text.resize(std::fread(text.data(), 1, text.size(), words.get()));
    while (text.ends_with('\n')) text.pop_back();
    throw Error(Fault::frame, options.file.string(), "ffmpeg failed" + (text.empty() ? std::string() : "; it says:\n" + text));
  }

  /// Where ffmpeg has ended, finish() tells it: the frames' reports are no place to throw from.
  void send(const Picture& picture) {
    for (std::size_t at = 0; at < picture.size() && !is_broken;) {
      const ssize_t count = ::send(to, picture.data() + at, picture.size() - at, MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      is_broken = count < 0;
      at += is_broken ? 0 : static_cast<std::size_t>(count);
    }
    is_empty = false;
  }
};

VideoSink::VideoSink(VideoOptions options) : state_(std::make_unique<State>(std::move(options))) { state_->start(); }
VideoSink::~VideoSink() = default;

void VideoSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  if (output != state_->options.output || !item.image()) return;
  if (item.image()->size() != state_->options.size)
    throw Error(Fault::frame, state_->options.file.string(), "the images of a video have one size, but this frame has another");
  Picture picture = to_picture(item.image()->floats());
  const std::lock_guard lock(state_->mutex);
  state_->waiting.insert_or_assign(frame, std::move(picture));
}

void VideoSink::end_frame(std::int64_t frame, bool ok) {
  {
    const std::lock_guard lock(state_->mutex);
    const auto found = state_->waiting.find(frame);
    if (ok && found != state_->waiting.end()) state_->last = std::move(found->second);
    if (found != state_->waiting.end()) state_->waiting.erase(found);
  }
  if (state_->last.empty()) return void(++state_->before_first);
  for (int i = std::exchange(state_->before_first, 0); i >= 0; --i) state_->send(state_->last);
}

void VideoSink::finish() {
  close(std::exchange(state_->to, -1));
  const bool is_whole = state_->wait() == 0 && !state_->is_broken;
  if (state_->is_empty) return;
  if (!is_whole) state_->fail();
  state_->file.commit();
}

}  // namespace quell::app
