// Files that the tests of sequences make.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "quell/image/image.h"
#include "quell/text/error.h"

namespace quell::test {

/// A folder of its own for a test, gone at its end.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// Everything in it, hidden files as well, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

/// How a test's EXR is made. Pixels are interleaved, rows from the top.
struct ExrContent {
  int width = 1, height = 1;
  std::vector<std::string> channels = {"Y"};
  std::vector<double> pixels = {};      ///< empty: all 0
  std::string format = "float";         ///< half, float, or uint (pixels are rounded)
  int x = 0, y = 0;                     ///< of the data window
  int full_width = 0, full_height = 0;  ///< display window at (0, 0); 0: that of the data
  int tile = 0;                         ///< tile size; 0: scan lines
  std::string part = {};                ///< its name, among several
  float pixel_aspect = 1;
  /// Matrices of the header, by name; the 16 numbers in this order.
  std::vector<std::pair<std::string, std::array<double, 16>>> matrices = {};
};
/// Several parts in one file. Their display windows have to be equal.
void make_parts(const std::filesystem::path& file, const std::vector<ExrContent>& parts);
void make_exr(const std::filesystem::path& file, const ExrContent& content);
void make_text(const std::filesystem::path& file, const std::string& text);
std::string read_bytes(const std::filesystem::path& file);

/// Sample values of a file, interleaved, and its channels as `name:format`.
struct ExrRead {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> pixels;
  std::string compression;
};
ExrRead load_exr(const std::filesystem::path& file);

/// The planes of an image one after the other, rows from the top.
std::vector<float> values(const Image& image);
std::vector<std::uint32_t> id_values(const Image& image);

/// A sidecar with identity matrices, `objects` being the inner text of that object.
std::string sidecar_text(int width, int height, const std::string& objects = "");
inline const std::string kIdentityText = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";

/// The message of the Error that `action` throws, "" when it throws none; its fault must be `fault`.
template <class Action>
std::string message_of(Fault fault, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), fault) << error.what();
    return error.what();
  }
  return "";
}

}  // namespace quell::test
