#include "quell/plugin/pass_instance.h"

#include <gtest/gtest.h>

#include "tests/core/plugin/test_plugins.h"
#include "tests/core/plugin/valid_pass.h"

namespace quell::test {
namespace {

/// What a frame needs of the host when nothing runs in parallel.
struct FrameHost {
  quell_host host{sizeof(quell_host),
                  QUELL_ABI_VERSION,
                  this,
                  nullptr,
                  [](const quell_host*, int, const char*) {},
                  [](const quell_host*) { return 0; },
                  [](const quell_host* self, const char* text) { static_cast<FrameHost*>(self->context)->error = text; }};
  std::string error;
};

/// The shapes of a pass with one plain input and one plain output, 4 x 3 pixels.
struct Question {
  quell_shape in_item{sizeof(quell_shape), QUELL_TYPE_COLOR, 4, 3, 0, 1};
  quell_shape out_item = in_item;
  quell_port_shape in{sizeof(quell_port_shape), 1, &in_item};
  quell_port_shape out{sizeof(quell_port_shape), 1, &out_item};
  std::int32_t radius = 0, in_place_of = -1;
  quell_inference raw{sizeof(quell_inference), 1, 1, &in, &out, &radius, &in_place_of, 0, 0};
};

class PluginPasses : public testing::Test {
 protected:
  PluginPasses() {
    for (const char* name : {"raw", "fails", "throws_raw", "throws_sdk"}) registry_.load_file(test_plugin(name));
  }
  const quell_pass_desc& desc(const char* id) const { return *registry_.find(id)->desc; }
  /// The message of the Error that body throws, checked for whose fault it is.
  template <class Body>
  static std::string error_of(Fault fault, const Body& body) {
    try {
      body();
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), fault);
      return error.what();
    }
    return "nothing was thrown";
  }
  std::string create_error(Fault fault, const char* id, std::vector<ParamValue> values = {}) const {
    return error_of(fault, [&] { PassInstance(desc(id), values); });
  }
  std::string infer_error(Fault fault, const char* id, std::vector<ParamValue> values = {}) const {
    const PassInstance pass(desc(id), values);
    return error_of(fault, [&] {
      Question question;
      pass.infer(question.raw);
    });
  }
  std::string process_error(const char* id, std::vector<ParamValue> values = {}) const {
    const PassInstance pass(desc(id), values);
    FrameHost host;
    const quell_exec exec{sizeof(quell_exec), 1, 1, 1, 0, nullptr, nullptr, nullptr, nullptr};
    EXPECT_EQ(pass.process(host.host, exec), QUELL_FAILED);
    return host.error;
  }
  static std::vector<ParamValue> thrower_at(std::int64_t where) { return {{std::vector<std::int64_t>{where}}}; }

 private:
  Registry registry_;
};

TEST_F(PluginPasses, InPlainCComputeAFrame) {
  const PassInstance pass(desc("raw"), {});
  Question question;
  pass.infer(question.raw);
  float from[3 * 12], to[3 * 12];
  for (int i = 0; i < 36; ++i) from[i] = static_cast<float>(i);
  quell_image in{sizeof(quell_image), QUELL_TYPE_COLOR, QUELL_FORMAT_F32, 3, 4, 3, 4, 12, from}, out = in;
  out.data = to;
  const quell_item in_item{sizeof(quell_item), QUELL_TYPE_COLOR, &in, nullptr, nullptr};
  const quell_item out_item{sizeof(quell_item), QUELL_TYPE_COLOR, &out, nullptr, nullptr};
  const quell_port in_port{sizeof(quell_port), 1, &in_item}, out_port{sizeof(quell_port), 1, &out_item};
  const quell_exec exec{sizeof(quell_exec), 1, 1, 1, 0, &in_port, &out_port, nullptr, nullptr};
  FrameHost host;
  ASSERT_EQ(pass.process(host.host, exec), QUELL_OK);
  for (int i = 0; i < 36; ++i) EXPECT_EQ(to[i], static_cast<float>(i) / 2);
}

TEST_F(PluginPasses, ThatFailAreQuoted) {
  EXPECT_EQ(create_error(Fault::usage, "create_with_words"), "pass 'create_with_words': the weights do not fit");
  EXPECT_EQ(infer_error(Fault::usage, "infer_with_words"), "pass 'infer_with_words': needs an even width");
  EXPECT_EQ(process_error("process_with_words"), "the frame is too dark");
}

TEST_F(PluginPasses, ThatFailWithoutWordsAreNamed) {
  EXPECT_EQ(create_error(Fault::usage, "create_without_words"),
            "pass 'create_without_words': the pass failed and gave no reason");
  EXPECT_EQ(infer_error(Fault::usage, "infer_without_words"), "pass 'infer_without_words': the pass failed and gave no reason");
}

TEST_F(PluginPasses, ThatCreateNothingBreakTheInterface) {
  EXPECT_EQ(create_error(Fault::plugin, "create_nothing"),
            "pass 'create_nothing': create breaks the plugin interface: it reports success without an instance");
}

TEST_F(PluginPasses, WrittenWithTheSdkThrowIntoAStatus) {
  EXPECT_EQ(create_error(Fault::usage, "thrower", thrower_at(1)), "pass 'thrower': thrown in create");
  EXPECT_EQ(infer_error(Fault::usage, "thrower", thrower_at(2)), "pass 'thrower': thrown in infer");
  EXPECT_EQ(process_error("thrower", thrower_at(3)), "thrown in run");
  EXPECT_EQ(process_error("thrower", thrower_at(4)), "the pass threw something that is not a std::exception");
}

TEST_F(PluginPasses, ThatThrowThroughTheInterfaceAreContained) {
  EXPECT_EQ(create_error(Fault::plugin, "raw_create"),
            "pass 'raw_create': create breaks the plugin interface: it threw 'no create today'");
  EXPECT_EQ(infer_error(Fault::plugin, "raw_infer"),
            "pass 'raw_infer': infer breaks the plugin interface: it threw 'no infer today'");
  EXPECT_EQ(process_error("raw_process"), "process breaks the plugin interface: it threw something that is not a std::exception");
  PassInstance(desc("raw_destroy"), {});  // goes out of scope, and the host lives on
}

struct WrongAnswer {
  const char* name;
  void (*change)(quell_inference&);
  const char* message;
};
void PrintTo(const WrongAnswer& answer, std::ostream* out) { *out << answer.name; }

class WrongAnswerToInfer : public testing::TestWithParam<WrongAnswer> {};

// A C function pointer carries no state: the test's answer reaches it this way.
void (*answer_now)(quell_inference&) = nullptr;

TEST_P(WrongAnswerToInfer, IsTheFaultOfThePlugin) {
  ValidPass valid;
  valid.desc.input_count = valid.desc.output_count = 1;
  valid.desc.param_count = valid.desc.change_count = 0;
  valid.desc.infer = [](const void*, const quell_host*, quell_inference* inference) {
    answer_now(*inference);
    return QUELL_OK;
  };
  ASSERT_EQ(check(valid.desc), "");
  const PassInstance pass(valid.desc, {});
  Question question;
  answer_now = GetParam().change;
  try {
    pass.infer(question.raw);
    EXPECT_STREQ(GetParam().message, "");
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::plugin);
    EXPECT_EQ(error.what(), std::string("pass 'valid': infer breaks the plugin interface: ") + GetParam().message);
  }
}

using I = quell_inference;
INSTANTIATE_TEST_SUITE_P(
    All, WrongAnswerToInfer,
    testing::Values(
        WrongAnswer{"None", [](I& i) { i.outputs->items->width = 8, i.in_place_of[0] = 0; }, ""},
        WrongAnswer{"Radius", [](I& i) { i.radius[0] = -2; }, "it gives the input 'color' the radius -2"},
        WrongAnswer{"NoWidth", [](I& i) { i.outputs->items->width = 0; }, "output 'color' is given the size 0 x 3"},
        WrongAnswer{"Huge", [](I& i) { i.outputs->items->height = 65537; }, "output 'color' is given the size 4 x 65537"},
        WrongAnswer{"OtherType", [](I& i) { i.outputs->items->type = QUELL_TYPE_DEPTH; },
                    "output 'color' is given a type other than color"},
        WrongAnswer{"UnknownType", [](I& i) { i.outputs->items->type = 77; }, "output 'color' is given a type other than color"},
        WrongAnswer{"Count", [](I& i) { i.outputs->count = 2; }, "output 'color' has another number of items than asked about"},
        WrongAnswer{"NoSuchPlace", [](I& i) { i.in_place_of[0] = 1; },
                    "output 'color' takes the place of an input that does not exist"},
        WrongAnswer{"InPlaceWithRadius", [](I& i) { i.in_place_of[0] = 0, i.radius[0] = 1; },
                    "output 'color' takes the place of an input whose radius is not 0"}),
    [](const testing::TestParamInfo<WrongAnswer>& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace quell::test
