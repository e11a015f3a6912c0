#include <gtest/gtest.h>

#include "quell/sdk/pass.h"
#include "tests/core/sdk/fake_host.h"

namespace quell::test {
namespace {

struct Params {
  double sigma = 2;
  void describe(auto&& field) { field("sigma", sigma, Range<double>{0, 9}, "px", "Width."); }
};

/// Counts its instances, so that leaks show.
class Counted final : public Pass {
 public:
  explicit Counted(const Params& params) : sigma_(params.sigma) {
    if (params.sigma == 9) throw std::invalid_argument("sigma must not be 9");
    ++alive;
  }
  ~Counted() override { --alive; }
  void infer(Inference& inference) const override { inference.set_radius("color", static_cast<int>(sigma_)); }
  void run(const Frame& frame) const override {
    if (frame.cancelled()) throw Cancelled();
    if (frame.number() < 0) throw std::out_of_range("no such frame");
  }
  static inline int alive = 0;

 private:
  double sigma_;
};

const PassInfo kInfo{.id = "counted",
                     .version = 4,
                     .oldest_version = 2,
                     .summary = "Counts.",
                     .doc = "Long.",
                     .source = "A paper.",
                     .inputs = {{.name = "color", .types = kColor | kAlbedo, .doc = "what to count"},
                                {.name = "many", .types = kScalar, .optional = true, .array = true}},
                     .outputs = {{.name = "many", .array = true, .same_as = "many"}, {.name = "depth", .types = kDepth}},
                     .changes = {{.version = 3, .param = "width", .renamed_to = "sigma"},
                                 {.version = 4, .param = "sigma", .former_default = 1.0}}};

const quell_pass_desc& counted() { return *detail::Descriptor::make<Counted, Params>(kInfo).get(); }

quell_param_value sigma_value(const double* sigma) {
  quell_param_value value{sizeof(quell_param_value), QUELL_PARAM_DOUBLE, 1, {}};
  value.data.doubles = sigma;
  return value;
}

TEST(Descriptor, CarriesWhatThePassSaysOfItself) {
  const quell_pass_desc& desc = counted();
  EXPECT_EQ(desc.struct_size, sizeof(quell_pass_desc));
  EXPECT_STREQ(desc.id, "counted");
  EXPECT_EQ(desc.version, 4u);
  EXPECT_EQ(desc.oldest_version, 2u);
  EXPECT_STREQ(desc.summary, "Counts.");
  EXPECT_STREQ(desc.doc, "Long.");
  EXPECT_STREQ(desc.source, "A paper.");
  EXPECT_EQ(desc.input_count, 2u);
  EXPECT_EQ(desc.output_count, 2u);
  EXPECT_EQ(desc.param_count, 1u);
}

TEST(Descriptor, DescribesPorts) {
  const quell_pass_desc& desc = counted();
  EXPECT_STREQ(desc.inputs[0].doc, "what to count");
  EXPECT_EQ(desc.inputs[0].types, kColor | kAlbedo);
  EXPECT_EQ(desc.inputs[0].flags, 0u);
  EXPECT_EQ(desc.inputs[0].same_as, -1);
  EXPECT_EQ(desc.inputs[1].flags, QUELL_PORT_OPTIONAL | QUELL_PORT_ARRAY);
  EXPECT_EQ(desc.outputs[0].same_as, 1);
  EXPECT_EQ(desc.outputs[0].flags, QUELL_PORT_ARRAY);
  EXPECT_EQ(desc.outputs[1].same_as, -1);
}

TEST(Descriptor, DescribesChanges) {
  const quell_pass_desc& desc = counted();
  ASSERT_EQ(desc.change_count, 2u);
  EXPECT_EQ(desc.changes[0].version, 3u);
  EXPECT_STREQ(desc.changes[0].param, "width");
  EXPECT_STREQ(desc.changes[0].renamed_to, "sigma");
  EXPECT_EQ(desc.changes[0].former_default, nullptr);
  EXPECT_EQ(desc.changes[1].renamed_to, nullptr);
  ASSERT_NE(desc.changes[1].former_default, nullptr);
  EXPECT_EQ(desc.changes[1].former_default->type, static_cast<std::uint32_t>(QUELL_PARAM_DOUBLE));
  EXPECT_EQ(desc.changes[1].former_default->data.doubles[0], 1.0);
}

TEST(Descriptor, CreatesAsksRunsAndDestroysAPass) {
  const quell_pass_desc& desc = counted();
  FakeHost host;
  const double sigma = 3;
  const quell_param_value value = sigma_value(&sigma);
  void* pass = nullptr;
  ASSERT_EQ(desc.create(&host.raw, &value, &pass), QUELL_OK);
  EXPECT_EQ(Counted::alive, 1);

  std::int32_t radius[2] = {};
  quell_inference inference{sizeof(quell_inference), 2, 2, nullptr, nullptr, radius, nullptr, 0, 0};
  EXPECT_EQ(desc.infer(pass, &host.raw, &inference), QUELL_OK);
  EXPECT_EQ(radius[0], 3);

  quell_exec exec{sizeof(quell_exec), 2, 2, 1, 5, nullptr, nullptr, nullptr, nullptr};
  EXPECT_EQ(desc.process(pass, &host.raw, &exec), QUELL_OK);
  exec.frame = -1;
  EXPECT_EQ(desc.process(pass, &host.raw, &exec), QUELL_FAILED);
  EXPECT_EQ(host.error, "no such frame");
  host.error = "", host.cancel_at = 0;
  EXPECT_EQ(desc.process(pass, &host.raw, &exec), QUELL_CANCELLED);
  EXPECT_EQ(host.error, "");

  desc.destroy(pass);
  EXPECT_EQ(Counted::alive, 0);
}

TEST(Descriptor, ReportsAConstructorThatThrows) {
  FakeHost host;
  const double sigma = 9;
  const quell_param_value value = sigma_value(&sigma);
  void* pass = nullptr;
  EXPECT_EQ(counted().create(&host.raw, &value, &pass), QUELL_FAILED);
  EXPECT_EQ(host.error, "sigma must not be 9");
  EXPECT_EQ(pass, nullptr);
}

struct NoParams {};
class Plain final : public Pass {
 public:
  explicit Plain(const NoParams&) {}
  void run(const Frame&) const override {}
};
const PassInfo kPlain{.id = "plain"};

TEST(Descriptor, NeedsNoParameters) {
  const quell_pass_desc& desc = *detail::Descriptor::make<Plain, NoParams>(kPlain).get();
  EXPECT_EQ(desc.param_count, 0u);
  FakeHost host;
  void* pass = nullptr;
  ASSERT_EQ(desc.create(&host.raw, nullptr, &pass), QUELL_OK);
  desc.destroy(pass);
}

}  // namespace

TEST(Registration, KeepsTheOrderOfThePasses) {
  auto& passes = detail::registered_passes();
  passes.clear();
  EXPECT_TRUE((detail::register_pass<Counted, Params>(kInfo)));
  EXPECT_TRUE((detail::register_pass<Plain, NoParams>(kPlain)));
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_EQ(passes[0], &counted());
  EXPECT_STREQ(passes[1]->id, "plain");
}

}  // namespace quell::test
