#include "tests/core/graph/schema_validator.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "quell/text/json.h"
#include "quell/text/json_clean.h"

namespace quell::test {
namespace {

namespace fs = std::filesystem;

/// A folder for the validator's files, removed at the end.
struct Scratch {
  Scratch() : folder(fs::path(testing::TempDir()) / ("quell_schema_" + std::to_string(getpid()))) {
    fs::create_directories(folder);
  }
  ~Scratch() { fs::remove_all(folder); }
  fs::path folder;
};

std::string read(const fs::path& file) { return read_text(file, Fault::input)->text; }

}  // namespace

std::map<std::string, Verdict> validate(const std::string& schema, const std::map<std::string, std::string>& graphs) {
  const Scratch scratch;
  std::string request = "{\"schema\": " + schema + ", \"graphs\": {";
  for (const auto& [name, text] : graphs)
    request += (request.ends_with('{') ? "" : ", ") + quote_json(name) + ": " + quote_json(text);
  std::ofstream(scratch.folder / "request.json") << request << "}}";
  const std::string folder = scratch.folder.string();
  const std::string command = QUELL_PYTHON " '" QUELL_SOURCE_DIR "/tests/core/graph/validate.py' '" + folder +
                              "/request.json' > '" + folder + "/reply.json' 2> '" + folder + "/errors.txt'";
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error("the validator fails (the package python3-jsonschema is needed):\n" +
                             read(scratch.folder / "errors.txt"));
  Diagnostics errors;
  const std::optional<Json> reply = parse_json(read_text(scratch.folder / "reply.json", Fault::input), errors);
  if (!reply || reply->members.size() != graphs.size()) throw std::runtime_error("the validator's answer is not whole");
  std::map<std::string, Verdict> verdicts;
  for (const JsonMember& member : reply->members) {
    Verdict& verdict = verdicts[member.key];
    verdict.is_json = member.value.kind == Json::Kind::array;
    for (const Json& error : member.value.elements) verdict.errors.push_back(error.string);
  }
  return verdicts;
}

std::string read_cleaned(const fs::path& file) {
  const SourceTextPtr source = read_text(file, Fault::input);
  Diagnostics ignored;
  return detail::clean_json(source, ignored).value_or(source->text);
}

}  // namespace quell::test
