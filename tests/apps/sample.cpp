#include "tests/apps/sample.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "quell/image/image.h"
#include "quell/sequence/file_sink.h"
#include "quell/sequence/image_file.h"

namespace quell::app::testing {
namespace fs = std::filesystem;

namespace {

constexpr Size kSize{16, 8};

FileSink sink(const fs::path& folder) { return FileSink({.folder = folder, .type = PixelType::single}); }

}  // namespace

RunnerTest::RunnerTest() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  folder_ = fs::temp_directory_path() /
            ("quell-runner-" + std::to_string(getpid()) + "-" + info->test_suite_name() + "-" + info->name());
  fs::remove_all(folder_);
  fs::create_directories(folder_);
}

RunnerTest::~RunnerTest() { fs::remove_all(folder_); }

void RunnerTest::make_shot(int count) {
  BufferPool pool;
  FileSink files = sink(path("shot"));
  for (int frame = 1; frame <= count; ++frame) {
    Image image(QUELL_TYPE_COLOR, kSize, pool);
    const FloatOutput pixels = image.writable_floats();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        pixels.at(x, y, 0) = 0.25F;
        pixels.at(x, y, 1) = static_cast<float>(frame);
        pixels.at(x, y, 2) = 8.0F;
      }
    files.write("color", frame, image);
  }
}

void RunnerTest::add_image(const std::string& input, int frame, float value) {
  BufferPool pool;
  FileSink files = sink(path("shot"));
  Image image(port_type(input).value_or(QUELL_TYPE_COLOR), kSize, pool);
  for (int c = 0; c < image.channels(); ++c)
    for (int y = 0; y < kSize.height; ++y) std::fill_n(image.writable_floats().row(y, c), kSize.width, value);
  files.write(input, frame, image);
}

void RunnerTest::write_file(const std::string& name, const std::string& content) const {
  fs::create_directories(path(name).parent_path());
  std::ofstream(path(name), std::ios::binary) << content;
}

std::string RunnerTest::read_file(const fs::path& file) const {
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  return content.str();
}

std::string RunnerTest::make_graph(const std::string& params) const {
  write_file("graph.json", R"({
  "quell": 1,
  "name": "small",
  "inputs": { "color": "color" },
  "nodes": { "scale": { "pass": "test_scale", "in": { "color": "color" }, "params": )" +
                               params + R"( } },
  "outputs": { "color": "scale.color" }
})");
  return text("graph.json");
}

Outcome RunnerTest::run(std::vector<std::string> arguments) const {
  arguments.insert(arguments.end(), {"--plugin-path", TEST_PLUGINS});
  return quell(arguments);
}

std::vector<std::string> RunnerTest::list(const std::string& folder) const {
  std::vector<std::string> names;
  if (!fs::exists(path(folder))) return names;
  for (const auto& file : fs::directory_iterator(path(folder))) names.push_back(file.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::pair<std::string, std::string>> RunnerTest::contents(const std::string& folder) const {
  std::vector<std::pair<std::string, std::string>> files;
  for (const std::string& name : list(folder)) files.emplace_back(name, read_file(path(folder) / name));
  return files;
}

std::vector<float> pixels_of(const fs::path& path) {
  ImageFile file(path);
  const Rectangle window = file.data_window(0);
  BufferPool pool;
  std::vector<float> values;
  for (int channel = 0; channel < static_cast<int>(file.channels().size()); ++channel) {
    Image image(QUELL_TYPE_SCALAR, {window.width, window.height}, pool);
    file.read({channel}, window, image.writable_floats());
    for (int y = 0; y < window.height; ++y)
      values.insert(values.end(), image.floats().row(y), image.floats().row(y) + window.width);
  }
  return values;
}

}  // namespace quell::app::testing
