#include "tev_sink.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <vector>

#include "console.h"
#include "quell/text/error.h"

namespace quell::app {
namespace {

constexpr const char* kPort = "14158";        // tev's own
constexpr std::size_t kMostBytes = 8U << 20;  // of pixels a packet
constexpr timeval kPatience{.tv_sec = 10, .tv_usec = 0};

// A packet: its length with these 4 bytes, a byte that tells what it is, then its fields; all little endian, texts end with 0.
// After tev's src/Ipc.cpp and its Python client.
enum class Kind : std::uint8_t { create_image = 4, update_image = 6 };

class Packet {
 public:
  explicit Packet(Kind kind) { add_byte(static_cast<std::uint8_t>(kind)); }
  Packet& add_byte(std::uint8_t value) {
    bytes_ += static_cast<char>(value);
    return *this;
  }
  template <class Integer>
  Packet& add(Integer value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      add_byte(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
    return *this;
  }
  Packet& add(const std::string& text) {
    bytes_ += text;
    return add_byte(0);
  }
  Packet& add(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) add(text);
    return *this;
  }
  Packet& add(float value) { return add(std::bit_cast<std::uint32_t>(value)); }
  /// With its length.
  const std::string& finish() {
    for (std::size_t i = 0; i < 4; ++i) bytes_[i] = static_cast<char>(bytes_.size() >> (8 * i));
    return bytes_;
  }

 private:
  std::string bytes_ = std::string(4, '\0');
};

std::vector<std::string> channel_names(const Image& image) {
  if (image.type() == QUELL_TYPE_COLOR || image.type() == QUELL_TYPE_ALBEDO) return {"R", "G", "B"};
  if (image.channels() == 1) return {"Y"};
  return image.channels() == 2 ? std::vector<std::string>{"X", "Y"} : std::vector<std::string>{"X", "Y", "Z"};
}

struct Address {
  std::string host, port;
  std::string text() const { return (host.find(':') == std::string::npos ? host : "[" + host + "]") + ":" + port; }
};

/// HOST, HOST:PORT, [IPV6]:PORT, [IPV6], or IPV6, whose colons part no port.
Address parse_address(const std::string& text) {
  const std::size_t bracket = text.starts_with('[') ? text.find(']') : std::string::npos;
  const std::size_t from = bracket == std::string::npos ? 0 : bracket;
  const std::size_t colon = text.find(':', from);
  const bool has_port = colon != std::string::npos && text.find(':', colon + 1) == std::string::npos;
  Address address{has_port ? text.substr(0, colon) : text, has_port ? text.substr(colon + 1) : kPort};
  if (bracket != std::string::npos && address.host.ends_with(']')) address.host = address.host.substr(1, bracket - 1);
  if (address.host.empty() || address.host.find_first_of("[]") != std::string::npos || address.port.empty())
    throw Error(Fault::usage, "--tev",
                "'" + text + "' is no address; write HOST:PORT, such as localhost:14158, or [::1]:14158 for one of IPv6");
  return address;
}

/// Why a connection, or sending, failed.
std::string describe(int error) {
  const bool is_late = error == EINPROGRESS || error == EAGAIN || error == EWOULDBLOCK;  // what SO_SNDTIMEO makes of waiting
  return is_late ? "no answer within " + std::to_string(kPatience.tv_sec) + " s" : std::strerror(error);
}

/// -1 when nobody answers; errno tells why, or is 0 when the host is not known.
int open_connection(const Address& to) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(to.host.c_str(), to.port.c_str(), &hints, &found) != 0) {
    errno = 0;  // it leaves there whatever its search came upon
    return -1;
  }
  int connection = -1;
  for (const addrinfo* address = found; address && connection < 0; address = address->ai_next) {
    connection = socket(address->ai_family, address->ai_socktype | SOCK_CLOEXEC, address->ai_protocol);
    if (connection < 0) continue;
    setsockopt(connection, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);  // for connecting, too
    if (connect(connection, address->ai_addr, address->ai_addrlen) == 0) break;
    const int error = errno;
    close(connection);
    connection = -1;
    errno = error;
  }
  freeaddrinfo(found);
  return connection;
}

}  // namespace

struct TevSink::State {
  std::string address;
  std::mutex mutex;     // a packet is sent whole
  int connection = -1;  // -1: tev went away

  ~State() {
    if (connection >= 0) close(connection);
  }
  bool send(const std::string& bytes) {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t count = ::send(connection, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return false;
      at += static_cast<std::size_t>(count);
    }
    return true;
  }
  bool send_image(const std::string& name, const Image& image) {
    const std::vector<std::string> channels = channel_names(image);
    const auto count = static_cast<std::int32_t>(channels.size());
    Packet create(Kind::create_image);
    create.add_byte(0).add(name).add(image.width()).add(image.height()).add(count).add(channels);
    if (!send(create.finish())) return false;
    const std::size_t row = static_cast<std::size_t>(image.width()) * channels.size() * sizeof(float);
    const int rows = static_cast<int>(std::max<std::size_t>(1, kMostBytes / row));
    for (int y = 0; y < image.height(); y += rows)
      if (!send_rows(name, image, channels, y, std::min(rows, image.height() - y))) return false;
    return true;
  }
  bool send_rows(const std::string& name, const Image& image, const std::vector<std::string>& channels, int y, int height) {
    const FloatImage pixels = image.floats();
    Packet update(Kind::update_image);
    update.add_byte(0).add(name).add(static_cast<std::int32_t>(channels.size())).add(channels);
    update.add(0).add(y).add(image.width()).add(height);
    for (std::int64_t c = 0; c < pixels.channels; ++c) update.add(c * image.width() * height);  // where a channel begins
    for (int c = 0; c < pixels.channels; ++c) update.add(std::int64_t{1});                      // from a pixel to the next
    for (int c = 0; c < pixels.channels; ++c)
      for (int row = y; row < y + height; ++row)
        for (int x = 0; x < pixels.width; ++x) update.add(pixels.at(x, row, c));
    return send(update.finish());
  }
};

TevSink::TevSink(FrameSink& sink, const std::string& address) : sink_(sink), state_(std::make_unique<State>()) {
  const Address parts = parse_address(address);
  state_->address = address;
  state_->connection = open_connection(parts);
  if (state_->connection < 0)
    throw Error(Fault::usage, "--tev",
                "no tev answers at " + parts.text() + ": " + (errno == 0 ? "the host or port is not known" : describe(errno)) +
                    "; start it first (tev listens at port " + kPort + ")");
}

TevSink::~TevSink() = default;

bool TevSink::uses_processor() const { return sink_.uses_processor(); }

void TevSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  sink_.write(output, frame, item);
  const Image* image = item.image();
  if (!image || image->type() == QUELL_TYPE_ID) return;
  const std::lock_guard lock(state_->mutex);
  if (state_->connection < 0) return;
  const std::string number = std::to_string(frame);
  const std::string name = std::string(output) + "." + std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number;
  if (state_->send_image(name, *image)) return;
  spdlog::warn("--tev: {} takes no more images: {}", state_->address, describe(errno));
  close(std::exchange(state_->connection, -1));
}

}  // namespace quell::app
