#include "tests/layering/layering.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace quell::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(Layering, HoldsInEverySourceFile) {
  const fs::path root = QUELL_SOURCE_DIR;
  std::size_t files = 0;
  for (const char* folder : {"core", "passes", "apps"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp" && extension != ".c") continue;
      std::ifstream stream(entry.path());
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      EXPECT_THAT(find_bad_includes(entry.path().lexically_relative(root).string(), text), IsEmpty());
      ++files;
    }
  }
  EXPECT_GT(files, 40u) << "the sources were not found";
}

TEST(LayeringRules, NameTheLineThatReachesUpwards) {
  EXPECT_THAT(find_bad_includes("core/image/item.cpp",
                                "#include \"quell/image/item.h\"\n\n#include <map>\n#include \"quell/graph/plan.h\"\n"),
              ElementsAre("core/image/item.cpp:4: #include \"quell/graph/plan.h\": core/image may not include core/graph"));
  EXPECT_THAT(find_bad_includes("core/sequence/a.cpp", "  #  include \"quell/plugin/registry.h\"  // spaces"),
              ElementsAre("core/sequence/a.cpp:1:   #  include \"quell/plugin/registry.h\"  // spaces: "
                          "core/sequence may not include core/plugin"));
}

TEST(LayeringRules, ConfineThirdPartyHeaders) {
  EXPECT_THAT(find_bad_includes("core/graph/a.cpp", "#include <nlohmann/json.hpp>"),
              ElementsAre("core/graph/a.cpp:1: #include <nlohmann/json.hpp>: nlohmann is visible in core/text only"));
  EXPECT_THAT(find_bad_includes("core/text/a.cpp", "#include <nlohmann/json.hpp>"), IsEmpty());
  EXPECT_THAT(find_bad_includes("core/image/a.cpp", "#include <png.h>"),
              ElementsAre("core/image/a.cpp:1: #include <png.h>: this header is not known; third-party headers are listed in "
                          "tests/layering"));
  EXPECT_THAT(find_bad_includes("apps/a.cpp", "#include <OpenImageIO/imageio.h>").size(), 1u);
}

TEST(LayeringRules, ShowAPassTheSdkAndItsOwnFolder) {
  EXPECT_THAT(find_bad_includes(
                  "passes/spatial/a.cpp",
                  "#include <hwy/highway.h>\n#include \"quell/sdk/pass.h\"\n#include \"passes/spatial/a.h\"\n#include \"a.h\""),
              IsEmpty());
  EXPECT_THAT(
      find_bad_includes("passes/spatial/a.cpp",
                        "#include \"passes/temporal/b.h\"\n#include \"quell/image/image.h\"\n#include <unistd.h>"),
      ElementsAre(
          "passes/spatial/a.cpp:1: #include \"passes/temporal/b.h\": passes includes only \"quell/...\" and its own folder",
          "passes/spatial/a.cpp:2: #include \"quell/image/image.h\": passes may not include core/image",
          "passes/spatial/a.cpp:3: #include <unistd.h>: passes may not include headers of the operating system"));
}

TEST(LayeringRules, KeepPathsFromGoingUpAndFromTheTests) {
  EXPECT_THAT(find_bad_includes("core/graph/a.cpp", "#include \"../text/json.h\""),
              ElementsAre("core/graph/a.cpp:1: #include \"../text/json.h\": "
                          "paths go down from the root or stay in their folder, never up"));
  EXPECT_THAT(find_bad_includes("core/graph/a.cpp", "#include \"tests/core/graph/b.h\"").size(), 1u);
}

TEST(LayeringRules, AskForAPlaceForEveryFolder) {
  EXPECT_THAT(find_bad_includes("core/misc/a.h", ""),
              ElementsAre("core/misc/a.h:1: the folder core/misc has no place in the layering"));
}

}  // namespace
}  // namespace quell::test
