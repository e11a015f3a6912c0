// The texts that `quell new` starts from: the files of templates/, built into the program.
#pragma once

#include <string_view>

namespace quell::app {

// What fill_template (new_names.h) replaces: my_pass or my_graph, MyPass, MyClass, my_plugin, and GRAPH_FOLDER.
extern const std::string_view kPassTemplate, kPassTestTemplate, kPassCMakeTemplate;
extern const std::string_view kGraphTemplate, kGraphTestTemplate, kGraphCMakeTemplate;

}  // namespace quell::app
