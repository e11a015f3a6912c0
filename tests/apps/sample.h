// A folder for one test, with small sequences and graphs in it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/apps/program.h"

namespace quell::app::testing {

/// Frames are 16 x 8, color.#.exr = 1/4 in red, the frame's number in green, 8 in blue; albedo = 1/2.
class RunnerTest : public ::testing::Test {
 protected:
  RunnerTest();
  ~RunnerTest() override;

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::string text(const std::string& name) const { return path(name).string(); }

  /// Frames 1..count of color in folder shot/.
  void make_shot(int count = 4);
  /// One more input, with one value in all channels, in one frame of shot/.
  void add_image(const std::string& input, int frame, float value);
  void write_file(const std::string& name, const std::string& content) const;
  std::string read_file(const std::filesystem::path& file) const;
  /// A graph with one node 'scale' from input color to output color; `params` as JSON.
  std::string make_graph(const std::string& params = "{}") const;
  /// quell COMMAND ... with the tests' own passes.
  Outcome run(std::vector<std::string> arguments) const;

  /// Names in a folder, hidden ones included, sorted; none when there is no such folder.
  std::vector<std::string> list(const std::string& folder) const;
  /// Names and bytes of all files in a folder.
  std::vector<std::pair<std::string, std::string>> contents(const std::string& folder) const;

 private:
  std::filesystem::path folder_;
};

/// All channels of an image file, one behind the other.
std::vector<float> pixels_of(const std::filesystem::path& file);

}  // namespace quell::app::testing
