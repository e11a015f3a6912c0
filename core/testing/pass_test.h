// Unit tests of one pass: small images in, parameters set, the pass run, its outputs looked at. No files, no graph, no runner.
//
//   #include <gtest/gtest.h>
//   #include "quell/testing/pass_test.h"
//   using namespace quell;
//
//   TEST(Invert, TurnsBlackIntoWhite) {
//     PassTest pass("invert");
//     pass.set("amount", 1.0);
//     pass.input("color", test_image(QUELL_TYPE_COLOR, {4, 3}, [](int, int, int) { return 0.0F; }));
//     pass.run();
//     EXPECT_EQ(pass.output("color").at(0, 0), 1.0F);
//   }
//
// The test program links the pass itself (quell_add_pass does that), so that a debugger and sanitizers see it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/item.h"
#include "quell/runtime/host.h"
#include "quell/sdk/pass.h"

// Defined by QUELL_REGISTER_PASS in the pass that is linked in.
extern "C" const quell_pass_desc* const* quell_plugin_passes(uint32_t* count);

namespace quell {

/// A float image whose pixels are value(x, y, channel).
Image test_image(PortType type, Size size, const std::function<float(int x, int y, int c)>& value, int spare_lines = 0);
/// An id image.
Image test_ids(Size size, const std::function<std::uint32_t(int x, int y)>& value, int spare_lines = 0);

/// The descriptor of a pass that is linked into this program; throws Error(usage) when there is none of that id.
const quell_pass_desc& find_pass(const quell_pass_desc* const* passes, std::uint32_t count, std::string_view id);
inline const quell_pass_desc& linked_pass(std::string_view id) {
  std::uint32_t count = 0;
  const quell_pass_desc* const* passes = quell_plugin_passes(&count);
  return find_pass(passes, count, id);
}

/// One pass, its parameters and its inputs. Mistakes in the test (an unknown port, a value out of range) and a pass that refuses
/// or fails throw Error with the words that a user would read.
class PassTest {
 public:
  explicit PassTest(std::string_view id) : PassTest(linked_pass(id)) {}
  explicit PassTest(const quell_pass_desc& pass);
  ~PassTest();
  PassTest(PassTest&&) noexcept;

  /// Sets a parameter: a number, a bool, text (also for enums), or a list of numbers. Others keep their defaults.
  PassTest& set(std::string_view param, bool value) { return set_json(param, value ? "true" : "false"); }
  PassTest& set(std::string_view param, int value) { return set_json(param, std::to_string(value)); }
  PassTest& set(std::string_view param, double value);
  PassTest& set(std::string_view param, std::string_view text);
  PassTest& set(std::string_view param, const char* text) { return set(param, std::string_view(text)); }
  PassTest& set(std::string_view param, const std::vector<double>& values);
  PassTest& set_json(std::string_view param, std::string json);

  /// What the port carries from the next frame on. A port array takes one item a call.
  PassTest& input(std::string_view port, Item item);
  PassTest& input_ids(std::string_view port, Size size, const std::function<std::uint32_t(int x, int y)>& value) {
    return input(port, test_ids(size, value));
  }
  /// Unconnects an optional port; empties a port array.
  PassTest& disconnect(std::string_view port);
  /// From the second frame on the input carries the output of the frame before; on the first it is absent.
  PassTest& feed_back(std::string_view output, std::string_view input);

  PassTest& threads(int count);
  /// Rows of every chunk, whatever the pass asks for; 0 as the pass asks.
  PassTest& grain(int rows);
  /// Runs a pass that works row by row on so many rows at a time, as where it is fused with others: of its outputs nothing else
  /// is there. 0: on all. Other passes run as ever.
  PassTest& rows_at_a_time(int rows);
  /// What every byte of outputs and scratch holds before the pass runs; at first kNanByte, so that what is not written shows.
  PassTest& fresh_memory(unsigned char byte);
  static constexpr unsigned char kNanByte = 0xff;
  /// Lets outputs take over the memory of inputs, where the pass allows it. Inputs then have to be given anew for each frame.
  PassTest& in_place();

  /// Runs the next frame: 0, 1, 2, ... History is lost when a parameter, a connection or a size has changed.
  void run();
  /// The number of the frame that runs next.
  PassTest& next_frame(std::int64_t number);

  FloatImage output(std::string_view port, int item = 0) const;
  IdImage output_ids(std::string_view port, int item = 0) const;
  Values output_values(std::string_view port) const;
  const Item& output_item(std::string_view port, int item = 0) const;

  /// Pixels that the pass says it reads around each pixel of an input, with the inputs and parameters at hand.
  int radius(std::string_view input);
  /// The input whose memory the output may take over, or "".
  std::string in_place_of(std::string_view output);
  const quell_pass_desc& desc() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace quell
