// --isa and QUELL_ISA: which vector unit computes.
#include "quell/simd/isa.h"

#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class IsaOption : public RunnerTest {
 protected:
  Outcome run_verbose(std::vector<std::string> more, const std::vector<std::string>& environment = {}) {
    std::vector<std::string> arguments = {"run",       make_graph(), text("shot"),    "-o",
                                          text("out"), "-v",         "--plugin-path", TEST_PLUGINS};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Program(arguments, false, environment).finish();
  }
};

TEST_F(IsaOption, PinsTheVectorUnit) {
  make_shot(1);
  for (const std::string& isa : isas()) EXPECT_THAT(run_verbose({"--isa", isa}).err, HasSubstr("computing on " + isa + "\n"));
  EXPECT_THAT(run_verbose({"--isa", "best"}).err, HasSubstr("computing on " + isas().front() + "\n"));
}

TEST_F(IsaOption, WinsOverTheEnvironment) {
  make_shot(1);
  const std::string last = "QUELL_ISA=" + isas().back();
  EXPECT_THAT(run_verbose({}, {last}).err, HasSubstr("computing on " + isas().back() + "\n"));
  EXPECT_THAT(run_verbose({"--isa", "best"}, {last}).err, HasSubstr("computing on " + isas().front() + "\n"));
  EXPECT_THAT(run_verbose({}, {"QUELL_ISA="}).err, HasSubstr("computing on " + isas().front() + "\n"));
}

TEST_F(IsaOption, RefusesWhatTheMachineHasNot) {
  make_shot(1);
  const Outcome option = run_verbose({"--isa", "mmx"});
  EXPECT_EQ(option.code, 2);
  EXPECT_THAT(option.err, StartsWith("error: --isa: 'mmx' is no vector unit; choose 'best', '" + isas().front() + "'"));
  const Outcome variable = run_verbose({}, {"QUELL_ISA=mmx"});
  EXPECT_EQ(variable.code, 2);
  EXPECT_THAT(variable.err, StartsWith("error: QUELL_ISA: 'mmx' is no vector unit; choose 'best', "));
  const Outcome idle = run({"graph", make_graph(), "--isa", "best"});
  EXPECT_EQ(idle.code, 2);
  EXPECT_THAT(idle.err, StartsWith("error: --isa requires --analyze\n"));
}

}  // namespace
}  // namespace quell::app::testing
