// Names for new passes and graphs, and texts made from templates with them.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quell::app {

/// Throws Error(usage), with a suggestion, unless the name has small letters, digits and '_', starts with a letter, is at most 64
/// characters long, and is none that CMake or compilers keep for themselves. `what` is "a pass", "a graph" or "a plugin".
void check_new_name(const std::string& name, const char* what);

/// "soften_edges" -> "SoftenEdges"
std::string pascal_case(std::string_view name);
/// The same followed by `suffix`, which is not doubled. No type of quell's headers is called so, whatever the name.
std::string class_name(std::string_view name, std::string_view suffix);

/// Replaces each key by its value. What was put in is not looked at again.
std::string fill_template(std::string_view text, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace quell::app
