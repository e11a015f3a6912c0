#include "tests/apps/compare_fixture.h"

#include <algorithm>

#include "quell/sequence/file_sink.h"
#include "tests/core/sequence/test_files.h"

namespace quell::app::testing {

void CompareTest::make_image(const std::string& name, const std::vector<double>& values, int width, int height) const {
  std::filesystem::create_directories(path(name).parent_path());
  test::ExrContent content{.width = width, .height = height, .channels = {"R", "G", "B"}};
  for (const double value : values) content.pixels.insert(content.pixels.end(), 3, value);
  test::make_exr(path(name), content);
}

void CompareTest::make_flat(const std::string& name, double value, int width, int height) const {
  make_image(name, std::vector<double>(static_cast<std::size_t>(width * height), value), width, height);
}

void CompareTest::make_motion(const std::string& name) const {
  test::ExrContent content{.width = kWidth, .height = kHeight, .channels = {"X", "Y"}};
  for (int i = 0; i < kWidth * kHeight; ++i) content.pixels.insert(content.pixels.end(), {-2.0, 0.0});
  test::make_exr(path(name), content);
}

void CompareTest::make_png(const std::string& name, double radiance) const {
  BufferPool pool;
  Image image(QUELL_TYPE_COLOR, {kWidth, kHeight}, pool);
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kHeight; ++y) std::fill_n(image.writable_floats().row(y, c), kWidth, static_cast<float>(radiance));
  FileSink({.folder = path("png"), .formats = {FileFormat::png}}).write("made", 1, image);
  std::filesystem::rename(path("png/made.0001.png"), path(name));
}

Outcome CompareTest::compare(const std::vector<std::string>& operands, std::vector<std::string> options) const {
  std::vector<std::string> arguments = {"compare"};
  for (const std::string& operand : operands) {
    const std::size_t equals = operand.find('=');
    const bool has_label = equals != std::string::npos && operand.find(':') > equals;
    const std::string name = has_label ? operand.substr(equals + 1) : operand;
    arguments.push_back((has_label ? operand.substr(0, equals + 1) : "") + (name.front() == '/' ? name : text(name)));
  }
  arguments.insert(arguments.end(), options.begin(), options.end());
  return quell(arguments);
}

Json CompareTest::compare_json(const std::vector<std::string>& operands, std::vector<std::string> options) const {
  options.insert(options.end(), {"--json", "-", "-q"});
  const Outcome outcome = compare(operands, options);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return parse(outcome.out);
}

Json CompareTest::parse(const std::string& text) const {
  Diagnostics errors;
  const auto json = parse_json(std::make_shared<SourceText>(SourceText{"output", text}), errors);
  EXPECT_TRUE(json) << errors.render() << text;
  return json.value_or(Json{});
}

const Json& CompareTest::figure(const Json& comparison, const std::string& metric, std::size_t image, int frame,
                                const char* member) {
  const Json& images = frame < 0 ? *comparison.find("all")
                                 : *comparison.find("frames")->elements.at(static_cast<std::size_t>(frame)).find("images");
  return *images.elements.at(image).find("figures")->find(metric)->find(member);
}

}  // namespace quell::app::testing
