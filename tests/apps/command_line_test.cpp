// Help, version, and command lines that cannot be understood.
#include <gmock/gmock.h>

#include <iterator>
#include <sstream>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class CommandLine : public RunnerTest {};

TEST_F(CommandLine, WithoutArgumentsGivesAShortHelp) {
  const Outcome outcome = quell({});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("Usage: quell COMMAND"));
  EXPECT_THAT(outcome.out, HasSubstr("Example:"));
  EXPECT_EQ(outcome.err, "");
}

TEST_F(CommandLine, HelpFitsTheTerminalAndHasAnExample) {
  for (const std::string command :
       {"run", "batch", "check", "compare", "graph", "passes", "report", "plan", "new", "new pass", "new graph"}) {
    std::istringstream words(command + " --help");
    const Outcome outcome = quell({std::istream_iterator<std::string>(words), {}});
    EXPECT_EQ(outcome.code, 0) << command;
    EXPECT_THAT(outcome.out, HasSubstr("Usage: quell " + command)) << command;
    EXPECT_THAT(outcome.out, HasSubstr("Example:\n  quell " + command)) << command;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << command << ": " << line;
  }
}

TEST_F(CommandLine, VersionNamesThePluginInterface) {
  const Outcome outcome = quell({"--version"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, ::testing::MatchesRegex("quell [0-9]+\\.[0-9]+\\.[0-9]+ \\(plugin interface [0-9]+\\.[0-9]+\\)\n"));
}

struct WrongLine {
  std::vector<std::string> arguments;
  std::string message;
};
void PrintTo(const WrongLine& line, std::ostream* out) {
  for (const std::string& argument : line.arguments) *out << argument << ' ';
}

class WrongCommandLine : public ::testing::TestWithParam<WrongLine> {};

TEST_P(WrongCommandLine, IsExplained) {
  const Outcome outcome = quell(GetParam().arguments);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, GetParam().message + "\n");
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongCommandLine,
    ::testing::Values(
        WrongLine{{"rum"},
                  "error: there is no command 'rum'; did you mean 'run'?; the commands are 'run', 'batch', 'check', 'inspect', "
                  "'compare', "
                  "'graph', 'passes', 'plan', 'schema', 'tune', 'report' and 'new'\n"
                  "`quell --help` tells more"},
        WrongLine{{"--vesion"}, "error: there is no option '--vesion'; did you mean '--version'?\n`quell --help` tells more"},
        WrongLine{{"new", "pas"},
                  "error: there is no command 'pas'; did you mean 'pass'?; the commands are 'pass' and 'graph'\n"
                  "`quell new --help` tells more"},
        WrongLine{{"new", "pass"}, "error: NAME is missing\n`quell new pass --help` tells more"},
        WrongLine{{"new", "pass", "a", "b"}, "error: 'b' is one argument too many\n`quell new pass --help` tells more"},
        WrongLine{{"new", "graph", "a", "--foldr", "b"},
                  "error: there is no option '--foldr'; did you mean '--folder'?\n`quell new graph --help` tells more"},
        WrongLine{{"new", "pass", "a", "--plugin"},
                  "error: --plugin needs a value: --plugin PLUGIN\n`quell new pass --help` tells more"},
        WrongLine{{"run"}, "error: GRAPH is missing\n`quell run --help` tells more"},
        WrongLine{{"run", "g", "s"}, "error: --out FOLDER is missing\n`quell run --help` tells more"},
        WrongLine{{"run", "--frame", "0-3", "g", "s", "-o", "x"},
                  "error: there is no option '--frame'; did you mean '--frames' or '--trace'?\n`quell run --help` tells more"},
        WrongLine{{"run", "g", "s", "-o"}, "error: --out needs a value: --out FOLDER\n`quell run --help` tells more"},
        WrongLine{{"run", "g", "s", "t", "-o", "x"}, "error: 't' is one argument too many\n`quell run --help` tells more"},
        WrongLine{{"run", "g", "s", "-o", "x", "-o", "y"}, "error: --out may be given only once\n`quell run --help` tells more"},
        WrongLine{{"run", "g", "s", "-o", "x", "--quiet=3"}, "error: --quiet takes no value\n`quell run --help` tells more"},
        WrongLine{{"run", "g", "s", "-o", "x", "--threads", "two"},
                  "error: --threads: 'two' is not a whole number from 0 to 1024"},
        WrongLine{{"run", "g", "s", "-o", "x", "--threads", "-1"}, "error: --threads: '-1' is not a whole number from 0 to 1024"},
        WrongLine{{"run", "g", "s", "-o", "x", "--frames-in-flight", "0"},
                  "error: --frames-in-flight: '0' is not a whole number from 1 to 1024, or 'auto'"},
        WrongLine{{"run", "g", "s", "-o", "x", "--frames-in-flight", "1025"},
                  "error: --frames-in-flight: '1025' is not a whole number from 1 to 1024, or 'auto'"},
        WrongLine{{"run", "g", "s", "-o", "x", "--frames-in-flight", "2", "--executor", "serial"},
                  "error: --frames-in-flight: '2' is not possible with --executor serial, which takes one frame after the other"},
        WrongLine{{"run", "g", "s", "-o", "x", "--memory", "2GB"},
                  "error: --memory: '2GB' is not an amount of memory; write bytes, with K, M, G or T for powers of 1024, such as "
                  "512M or 1.5G, or 'auto'"},
        WrongLine{{"run", "g", "s", "-o", "x", "--executor", "tbbb"},
                  "error: --executor: 'tbbb' is not possible; did you mean 'tbb'?; choose 'serial' or 'tbb'"},
        WrongLine{{"run", "g", "s", "-o", "x", "--on-error", "ignore"},
                  "error: --on-error: 'ignore' is not possible; choose 'continue', 'stop', 'reset' or 'hold'"},
        WrongLine{{"run", "g", "s", "-o", "x", "--log-json", ""}, "error: --log-json: the name is empty; name a file"},
        WrongLine{{"run", "g", "s", "-o", "x", "--type", "hlaf"},
                  "error: --type: 'hlaf' is not possible; did you mean 'half'?; choose 'auto', 'half' or 'float'"},
        WrongLine{{"run", "g", "s", "-o", "x", "--format", "tiff"},
                  "error: --format: 'tiff' is not possible; choose 'exr' or 'png'"},
        WrongLine{{"run", "g", "s", "-o", "x", "--padding", "0"}, "error: --padding: '0' is not a whole number from 1 to 20"}));

TEST_F(CommandLine, AnUnknownCompressionIsAnsweredWithTheList) {
  const Outcome outcome = quell({"run", "g", "s", "-o", "x", "--compression", "zap"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, StartsWith("error: --compression: 'zap' is not possible; did you mean 'zip'"));
  EXPECT_THAT(outcome.err, HasSubstr("'piz'"));
}

TEST_F(CommandLine, HelpTellsHowToRunAndEveryExitCode) {
  const Outcome outcome = quell({"run", "--help"});
  EXPECT_THAT(outcome.out, HasSubstr("\nHow to run:\n  --threads N "));
  for (const char* code : {"0 all", "1 some", "2 usage", "3 input", "4 plugin", "33 memory", "70 ", "75 interrupted"})
    EXPECT_THAT(outcome.out, HasSubstr(code));
}

TEST_F(CommandLine, ColorsAreForTerminalsAlone) {
  if (!terminals_exist()) GTEST_SKIP() << "no pseudo-terminals here";
  EXPECT_THAT(quell({"run"}).err, StartsWith("error: "));
  EXPECT_THAT(Program({"run"}, true).finish().err, StartsWith("\x1b[1;31merror: \x1b[0m"));
  EXPECT_THAT(Program({"run"}, true, {"NO_COLOR=1"}).finish().err, StartsWith("error: "));
}

TEST_F(CommandLine, OutputThatCannotBeWrittenIsAnInternalError) {
  const Outcome outcome = Program({"passes"}, false, {}, "/dev/full").finish();
  EXPECT_EQ(outcome.code, 70);
  EXPECT_THAT(outcome.err, HasSubstr("error: the output cannot be written: No space left on device"));
}

}  // namespace
}  // namespace quell::app::testing
