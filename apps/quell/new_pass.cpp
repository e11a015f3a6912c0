// The skeleton of a pass: a plugin of its own, or a pass of quell's source tree.
#include "installation.h"
#include "new_names.h"
#include "new_skeleton.h"
#include "quell/plugin/registry.h"
#include "quell/text/error.h"
#include "quell/text/shell_word.h"
#include "source_tree.h"
#include "templates.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

void refuse_known_pass(const std::string& id) {
  const Registry registry = load_plugins();
  if (const RegisteredPass* pass = registry.find(id))
    throw Error(Fault::usage, "", "there is a pass '" + id + "' already, in " + pass->file.string() + "; choose another name");
}

std::string fill(std::string_view text, const NewPass& pass) {
  return fill_template(text, {{"my_pass", pass.name},
                              {"MyPass", pascal_case(pass.name)},
                              {"MyClass", class_name(pass.name, "Pass")},
                              {"my_plugin", pass.plugin}});
}

void add(Skeleton& skeleton, const fs::path& file, std::string text) {
  skeleton.written.push_back(file.string());
  skeleton.files.add(file, std::move(text));
}

Skeleton make_plugin(NewPass pass) {
  if (pass.plugin.empty()) pass.plugin = pass.name;
  const fs::path folder = pass.folder.empty() ? fs::path(pass.name) : pass.folder;
  Skeleton skeleton;
  add(skeleton, folder / "CMakeLists.txt", fill(kPassCMakeTemplate, pass));
  add(skeleton, folder / (pass.name + ".cpp"), fill(kPassTemplate, pass));
  add(skeleton, folder / (pass.name + "_test.cpp"), fill(kPassTestTemplate, pass));
  const std::string source = shell_word(folder.string()), build = shell_word((folder / "build").string());
  const CMakePrefix prefix = cmake_prefix();
  if (!prefix.before.empty()) skeleton.next.push_back({"install quell, once, so that CMake finds it", prefix.before});
  skeleton.next.push_back(
      {"build it, test it, and see it in quell",
       {"cmake -S " + source + " -B " + build + " -DCMAKE_PREFIX_PATH=" + prefix.word,
        "cmake --build " + build + " && ctest --test-dir " + build + " --output-on-failure",
        "quell passes " + pass.name + " --plugin-path " + shell_word((folder / "build" / QUELL_PASSES_DIR).string())}});
  return skeleton;
}

void refuse_taken_in_tree(const SourceTree& tree, const NewPass& pass) {
  if (const std::string plugin = tree.plugin_of(pass.name); !plugin.empty())
    throw Error(Fault::usage, tree.passes_cmake().string(),
                "there is a pass '" + pass.name + "' already, in the plugin '" + plugin + "'; choose another name");
  const std::string program = pass.name + "_test";
  if (const fs::path place = tree.place_of_test(program); !place.empty())
    throw Error(Fault::usage, place.string(),
                "there is a test program '" + program + "' already, and the pass's test would be called so; choose another name");
}

Skeleton make_in_tree(NewPass pass, const fs::path& root) {
  if (pass.plugin.empty()) pass.plugin = kDefaultPlugin;
  const SourceTree tree(root);
  refuse_taken_in_tree(tree, pass);
  Skeleton skeleton;
  add(skeleton, root / "passes" / pass.plugin / (pass.name + ".cpp"), fill(kPassTemplate, pass));
  add(skeleton, root / "tests/passes" / (pass.name + "_test.cpp"), fill(kPassTestTemplate, pass));
  skeleton.files.replace(tree.passes_cmake(), tree.passes_with(pass.plugin, pass.name));
  skeleton.written.push_back(tree.passes_cmake().string() +
                             (tree.has_plugin(pass.plugin) ? ": one line more" : ": a new plugin, '" + pass.plugin + "'"));
  Skeleton::Step step{"build it, and test it", {}};
  if (!pass.folder.empty()) step.commands.push_back("cd " + shell_word(root.string()));
  step.commands.push_back("cmake --preset release -DQUELL_BUILD_TESTS=ON");
  step.commands.push_back("cmake --build --preset release --target " + pass.plugin + " " + pass.name + "_test");
  step.commands.push_back("build/release/bin/" + pass.name + "_test");
  skeleton.next.push_back(step);
  skeleton.next.push_back({"let editors know it (a test compares the schema that ships with the passes)",
                           {"quell schema --plugin-path build/release/" QUELL_PASSES_DIR " -o graphs/quell-graph.schema.json"}});
  return skeleton;
}

}  // namespace

Skeleton make_pass_skeleton(const NewPass& pass) {
  check_new_name(pass.name, "a pass");
  if (!pass.plugin.empty()) check_new_name(pass.plugin, "a plugin");
  refuse_known_pass(pass.name);
  const fs::path root = pass.folder.empty() ? fs::path(".") : pass.folder;
  if (!SourceTree::is_at(root)) return make_plugin(pass);
  return make_in_tree(pass, pass.folder.empty() ? fs::path() : root);
}

}  // namespace quell::app
