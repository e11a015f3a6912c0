#include "run_traits.h"

#include <filesystem>
#include <system_error>

#include "quell/graph/graph_hash.h"
#include "quell/simd/isa.h"

namespace quell::app {
namespace {

std::string absolute(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::weakly_canonical(path, error);
  return error ? path.string() : full.string();
}

std::string value_of(const RunTraits& traits, const std::string& what) {
  const auto found = traits.find(what);
  return found == traits.end() ? "nothing" : found->second;
}

}  // namespace

RunTraits traits_of(const Job& job, const SequenceArguments& sequence, const SessionOptions& options) {
  RunTraits traits;
  traits["the graph's hash"] = graph_hash(*job.graph);
  for (const Node& node : job.graph->nodes)
    traits["the pass '" + std::string(node.pass->id) + "'"] = "version " + std::to_string(node.pass->version);
  traits["quell"] = QUELL_VERSION;
  traits["the vector unit"] = current_isa();
  for (const InputFiles& input : job.inputs) traits["the input '" + input.input + "'"] = absolute(input.pattern);
  for (std::size_t i = 0; i < sequence.in.size(); ++i) traits["--in, number " + std::to_string(i + 1)] = sequence.in[i];
  if (sequence.window) traits["--window"] = *sequence.window;
  if (sequence.crop) traits["--crop"] = *sequence.crop;
  if (!options.cuts.empty()) traits["--cut"] = FrameRange(options.cuts).text();
  return traits;
}

std::string list_differences(const RunTraits& now, const RunTraits& then) {
  RunTraits all = now;
  all.insert(then.begin(), then.end());
  std::string list;
  for (const auto& [what, text] : all) {
    const std::string is = value_of(now, what), was = value_of(then, what);
    if (is != was) list += "\n  " + what + ": " + is + " now, " + was + " in the checkpoint";
  }
  return list;
}

}  // namespace quell::app
