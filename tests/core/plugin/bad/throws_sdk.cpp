// Passes written with the SDK that throw, where `where` says. The SDK turns that into a status with the message.
#include <stdexcept>

#include "quell/sdk/pass.h"

namespace {
using namespace quell;

enum class Where { nowhere, create, infer, run, number };

struct Params {
  Where where = Where::nowhere;
  void describe(auto&& field) {
    field("where", where,
          Choices{{"nowhere", ""}, {"create", ""}, {"infer", ""}, {"run", ""}, {"number", "in run, and no std::exception"}},
          "Where to throw.");
  }
};

class Thrower final : public Pass {
 public:
  explicit Thrower(const Params& params) : where_(params.where) {
    if (where_ == Where::create) throw std::runtime_error("thrown in create");
  }
  void infer(Inference&) const override {
    if (where_ == Where::infer) throw std::runtime_error("thrown in infer");
  }
  void run(const Frame&) const override {
    if (where_ == Where::run) throw std::runtime_error("thrown in run");
    if (where_ == Where::number) throw 42;
  }

 private:
  Where where_;
};

const PassInfo kInfo{.id = "thrower",
                     .summary = "Throws.",
                     .inputs = {{.name = "color", .types = kColor}},
                     .outputs = {{.name = "color", .types = kColor}}};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Thrower, Params)
