// quell run --tev: what a viewer is sent.
#include <gmock/gmock.h>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <map>
#include <memory>
#include <thread>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Takes all that one connection sends, at a port of its own.
class Server {
 public:
  Server() : listening_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    const bool listens = bind(listening_, reinterpret_cast<const sockaddr*>(&address), size) == 0 && listen(listening_, 1) == 0 &&
                         getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size) == 0;
    EXPECT_TRUE(listens) << std::strerror(errno);
    port_ = ntohs(address.sin_port);
  }
  ~Server() {
    shutdown(listening_, SHUT_RDWR);  // so that nobody waits for a connection that does not come
    if (thread_.joinable()) thread_.join();
    close(listening_);
  }

  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  /// Takes no more than `most` bytes.
  void take(std::size_t most = SIZE_MAX) {
    thread_ = std::thread([this, most] {
      const int connection = accept(listening_, nullptr, nullptr);
      std::string buffer(65536, '\0');
      while (taken_.size() < most) {
        const ssize_t count = read(connection, buffer.data(), buffer.size());
        if (count <= 0) break;
        taken_.append(buffer, 0, static_cast<std::size_t>(count));
      }
      close(connection);
    });
  }
  const std::string& finish() {
    thread_.join();
    return taken_;
  }

 private:
  int listening_;
  int port_ = 0;
  std::string taken_;
  std::thread thread_;
};

/// What tev makes of a stream: after the documentation of its protocol (tev's src/Ipc.h and scripts/tev.py).
class Viewer {
 public:
  struct Shown {
    int width = 0, height = 0;
    std::map<std::string, std::vector<float>> channels;
    int updated = 0;  ///< pixels
  };
  explicit Viewer(const std::string& stream) : stream_(stream) {
    while (at_ < stream_.size()) {
      const std::size_t begin = at_, length = static_cast<std::size_t>(number<std::uint32_t>());
      read_packet();
      EXPECT_EQ(at_, begin + length);
      if (at_ != begin + length) return;
    }
  }
  std::map<std::string, Shown> images;

 private:
  template <class Number>
  Number number() {
    Number value{};
    EXPECT_LE(at_ + sizeof value, stream_.size());
    if (at_ + sizeof value <= stream_.size()) std::memcpy(&value, stream_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string word() {
    const std::size_t end = stream_.find('\0', at_);
    std::string text = stream_.substr(at_, end - at_);
    at_ = end + 1;
    return text;
  }
  std::vector<std::string> words(int count) {
    std::vector<std::string> all;
    for (int i = 0; i < count; ++i) all.push_back(word());
    return all;
  }
  void read_packet() {
    const int kind = number<std::uint8_t>();
    EXPECT_EQ(number<std::uint8_t>(), 0);  // does not take the focus
    const std::string name = word();
    Shown& image = images[name];
    if (kind == 4) {
      image.width = number<std::int32_t>(), image.height = number<std::int32_t>();
      for (const std::string& channel : words(number<std::int32_t>()))
        image.channels[channel].resize(static_cast<std::size_t>(image.width * image.height));
      return;
    }
    ASSERT_EQ(kind, 6);
    const std::vector<std::string> channels = words(number<std::int32_t>());
    const int x = number<std::int32_t>(), y = number<std::int32_t>(), width = number<std::int32_t>(),
              height = number<std::int32_t>();
    std::vector<std::int64_t> offsets, strides;
    for (std::size_t i = 0; i < channels.size(); ++i) offsets.push_back(number<std::int64_t>());
    for (std::size_t i = 0; i < channels.size(); ++i) strides.push_back(number<std::int64_t>());
    std::vector<float> data;
    for (std::size_t i = 0; i < channels.size() * static_cast<std::size_t>(width * height); ++i) data.push_back(number<float>());
    for (std::size_t c = 0; c < channels.size(); ++c)
      for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column)
          image.channels.at(channels[c]).at(static_cast<std::size_t>((y + row) * image.width + x + column)) =
              data.at(static_cast<std::size_t>(offsets[c] + strides[c] * (row * width + column)));
    image.updated += width * height;
  }
  const std::string& stream_;
  std::size_t at_ = 0;
};

class Tev : public RunnerTest {};

TEST_F(Tev, IsSentEveryImageInFloats) {
  make_shot(2);
  Server server;
  server.take();
  const Outcome outcome =
      run({"run", make_graph(R"({"gain": 0.5})"), text("shot"), "-o", text("out"), "--tev", server.address()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Viewer viewer(server.finish());
  ASSERT_EQ(viewer.images.size(), 2U);
  for (const int frame : {1, 2}) {
    const Viewer::Shown& image = viewer.images.at("color.000" + std::to_string(frame));
    EXPECT_EQ(image.width, 16);
    EXPECT_EQ(image.updated, 16 * 8);
    EXPECT_THAT(image.channels.at("R"), ::testing::Each(0.125F));
    EXPECT_THAT(image.channels.at("G"), ::testing::Each(0.5F * static_cast<float>(frame)));
    EXPECT_THAT(image.channels.at("B"), ::testing::Each(4.0F));
  }
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0002.exr"));
}

TEST_F(Tev, ThatGoesAwayDoesNotEndTheRun) {
  make_shot(4);
  std::string nodes, from = "color";  // 1024 x 512 pixels: more than sockets take for a tev that does not read
  for (int i = 0; i < 6; ++i) {
    const std::string name = "double" + std::to_string(i);
    nodes += (i > 0 ? ", \"" : "\"") + name + R"(": {"pass": "scale", "in": {"image": ")" + from +
             R"("}, "params": {"to": "double"}})";
    from = name + ".image";
  }
  write_file("large.json",
             R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {)" + nodes + R"(}, "outputs": {"color": ")" + from + "\"}}");
  Server server;
  server.take(100);
  const Outcome outcome = run({"run", text("large.json"), text("shot"), "-o", text("out"), "--tev", server.address()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  server.finish();
  const std::string warning = "--tev: " + server.address() + " takes no more images: ";
  const std::size_t first = outcome.err.find(warning);
  ASSERT_NE(first, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find(warning, first + 1), std::string::npos) << "told more than once";
  EXPECT_EQ(list("out").size(), 4U);
}

TEST_F(Tev, ThatDoesNotAnswerIsAnErrorBeforeTheRun) {
  make_shot(1);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "--tev", "127.0.0.1:1"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--tev: no tev answers at 127.0.0.1:1: Connection refused; start it first"));
  const auto told = [&](const std::string& address) {
    const Outcome refused = run({"run", make_graph(), text("shot"), "-o", text("out"), "--tev", address});
    EXPECT_EQ(refused.code, 2) << address;
    return refused.err;
  };
  for (const std::string bad : {":1", "[::1", "[]:1", "host:"}) EXPECT_THAT(told(bad), HasSubstr("'" + bad + "' is no address"));
  EXPECT_THAT(told("127.0.0.1:tev"), HasSubstr("no tev answers at 127.0.0.1:tev: the host or port is not known; start it first"));
  EXPECT_THAT(told("[::1]:1"), HasSubstr("no tev answers at [::1]:1: "));
  EXPECT_THAT(told("::1"), HasSubstr("no tev answers at [::1]:14158: "));
  EXPECT_THAT(told("[::1]"), HasSubstr("no tev answers at [::1]:14158: "));
  EXPECT_THAT(told("127.0.0.1"), HasSubstr("no tev answers at 127.0.0.1:14158: "));
}

TEST_F(Tev, ThatGoesAwayBetweenRunsDoesNotEndWatching) {
  make_shot(1);
  auto server = std::make_unique<Server>();
  server->take(100);
  const std::string address = server->address();
  Program program({"run", make_graph(), text("shot"), "-o", text("out"), "--watch", "--tev", address, "--log-json",
                   text("run.jsonl"), "--plugin-path", TEST_PLUGINS});
  ASSERT_TRUE(program.wait_for_error_text("waiting for "));
  server.reset();
  make_graph(R"({"gain": 2})");
  ASSERT_TRUE(program.wait_for_error_text(
      "no tev answers at " + address +
      ": Connection refused; start it first (tev listens at port 14158); this run goes on without\n"));
  const auto runs = [&] {
    int count = 0;
    const std::string log = read_file(path("run.jsonl")), end = R"("outcome":"done")";
    for (std::size_t at = log.find(end); at != std::string::npos; at = log.find(end, at + 1)) ++count;
    return count;
  };
  for (int tries = 0; tries < 6000 && runs() < 2; ++tries) usleep(10'000);
  EXPECT_EQ(runs(), 2);
  program.send(SIGINT);
  EXPECT_EQ(program.finish().code, 0);
}

}  // namespace
}  // namespace quell::app::testing
