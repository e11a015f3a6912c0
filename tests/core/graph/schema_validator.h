// A validator that is not quell's own, python3-jsonschema, on the schema of graph files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace quell::test {

/// What the validator says of a text.
struct Verdict {
  bool is_json = false;
  std::vector<std::string> errors;
  bool accepted() const { return is_json && errors.empty(); }
};

/// The verdict on each graph by its name. The schema itself is checked against the schema of schemas. Texts are plain JSON.
/// Throws std::runtime_error when the validator cannot be run, or finds the schema wrong.
std::map<std::string, Verdict> validate(const std::string& schema, const std::map<std::string, std::string>& graphs);

/// The text of a graph file without its comments and trailing commas, as the loader blanks them; as it is, when it is not well
/// formed.
std::string read_cleaned(const std::filesystem::path& file);

}  // namespace quell::test
