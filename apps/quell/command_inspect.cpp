// quell inspect: what is there, what quell makes of it, and whether it is meant so.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "arguments.h"
#include "commands.h"
#include "inspect_text.h"
#include "inspection.h"
#include "quell/sequence/checks/picture.h"
#include "quell/sequence/image_writer.h"
#include "quell/sequence/pending_file.h"
#include "quell/text/diagnostic.h"
#include "results.h"

namespace quell::app {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  SequenceArguments sequence;
  VerbosityArguments verbosity;
  std::optional<fs::path> picture, json;
};

constexpr int kPanelsInARow = 4;

void show(Console& console, const std::string& status) {
  if (spdlog::should_log(spdlog::level::info)) console.set_status(status);
}

/// A single image, not a sequence.json.
bool is_image_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && path.extension() != ".json";
}

void tell_file(const fs::path& path, Console& console) {
  ImageFile file(path);
  const std::string text = describe_file(file, [&](double share) {
    show(console, "reading " + path.filename().string() + ": " + std::to_string(static_cast<int>(100 * share)) + " %");
  });
  console.set_status("");
  std::cout << printable(text) << std::flush;  // names and attributes are whatever the file says
}

/// The sequence, or nothing for a single file in which nothing is recognized: its content was told, and there is nothing to test.
std::unique_ptr<Sequence> open_sequence(const SequenceArguments& arguments) {
  const SequenceOptions options = sequence_options(arguments);
  if (!is_image_file(arguments.sequence) || !arguments.in.empty()) return Sequence::open(arguments.sequence, options);
  try {
    return Sequence::open(arguments.sequence, options);
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    spdlog::info("not tested: {}", error.what());
    return nullptr;
  }
}

std::vector<std::int64_t> frames_to_test(const Sequence& sequence, const Arguments& arguments) {
  const std::vector<std::int64_t> all = all_frames(sequence);
  if (all.empty())
    throw Error(Fault::input, arguments.sequence.sequence.empty() ? "--in" : arguments.sequence.sequence.string(),
                "no input has any file");
  if (!arguments.sequence.frames) return choose_frames(all);
  const auto has_one = [&](const InputFiles& input) {
    return std::ranges::any_of(input.frames, [&](std::int64_t frame) { return std::ranges::binary_search(all, frame); });
  };
  if (std::ranges::none_of(sequence.inputs(), has_one))
    throw Error(Fault::input, "--frames", "no input has a file of the frames " + FrameRange(all).text() + "; see the list above");
  return all;
}

void write_picture(const fs::path& file, const Inspection& inspection, const std::string& title) {
  const std::vector<Panel> panels = make_panels(inspection.picture, inspection.picture_findings);
  if (panels.empty()) return spdlog::warn("--picture: there is no image to be drawn");
  const std::string heading = title + ", frame " + std::to_string(inspection.picture.frame);
  if (!write_contact_sheet(file, heading, panels, kPanelsInARow))
    spdlog::warn("--picture: no font was found, so that nothing in {} is labeled; install fonts-dejavu-core", file.string());
}

void write_json(const fs::path& file, const Inspection& inspection, const Sequence& sequence) {
  PendingFile pending(file);
  write_text(to_json(inspection, sequence), pending.path());
  pending.commit();
}

ExitCode test(Sequence& sequence, const Arguments& arguments, Console& console) {
  const std::vector<std::int64_t> frames = frames_to_test(sequence, arguments);
  const Inspection inspection = inspect(sequence, frames, [&](std::size_t done) {
    show(console, "testing frame " + std::to_string(frames[done]) + " (" + std::to_string(done + 1) + " of " +
                      std::to_string(frames.size()) + ")");
  });
  console.set_status("");
  std::cout << printable(describe(inspection)) << std::flush;
  for (const std::string& warning : sequence.warnings()) spdlog::warn(warning);
  if (arguments.json) write_json(*arguments.json, inspection, sequence);
  if (arguments.picture) write_picture(*arguments.picture, inspection, arguments.sequence.sequence.string());
  return inspection.count(Verdict::wrong) > 0 ? kFoundWrong : kOk;
}

ExitCode run(const Arguments& arguments, Console& console) {
  set_verbosity(arguments.verbosity.verbosity());
  if (arguments.picture && arguments.picture->extension() != ".png")
    throw Error(Fault::usage, "--picture", "'" + arguments.picture->string() + "' is no name of a PNG; let it end in .png");
  if (arguments.picture) refuse_to_replace_others(*arguments.picture, "\x89PNG", "--picture");
  if (arguments.json) refuse_to_replace_others(*arguments.json, "{\"sequence\":", "--json");
  if (!arguments.sequence.given())
    throw Error(Fault::usage, "SEQUENCE",
                "nothing is given to look at; name a folder, a sequence.json, an image, or --in INPUT=PATTERN");
  if (is_image_file(arguments.sequence.sequence)) tell_file(arguments.sequence.sequence, console);
  const std::unique_ptr<Sequence> sequence = open_sequence(arguments.sequence);
  if (!sequence) return kOk;
  std::cout << printable(sequence->describe()) << "\n" << std::flush;
  return test(*sequence, arguments, console);
}

}  // namespace

Command add_inspect(CLI::App& program) {
  CLI::App& app =
      *program.add_subcommand("inspect", "Show what a sequence or an image holds, and test that it is read as it was meant.");
  app.footer(
      "Example:\n"
      "  quell inspect shot/ --picture shot.png\n"
      "lists the inputs that are recognized, then tests them on the first three frames and the middle one: whether the camera "
      "projects positions onto their pixels, motion agrees with the matrices, depth with the positions, normals with the "
      "surfaces, and more. Each verdict is ok, suspicious, WRONG, or not tested, with the figures or the reason. Where "
      "another convention agrees, the --in option that states it is shown.\n"
      "  quell inspect beauty.exr\n"
      "shows the layers of one image, what their channels hold, and as which input each is recognized.\n"
      "\n"
      "Exit status: 0 nothing is wrong, 1 something is, 2 usage, 3 nothing there or unreadable, 70 internal error.");
  auto arguments = std::make_shared<Arguments>();
  add_options(app, arguments->sequence);
  app.get_option("--frames")->description("Frames to test: 1-3, 1,5,9-12. Without it, the first three and the middle one.");
  app.add_option("--picture", arguments->picture,
                 "Draw the inputs of a tested frame, and where the tests find errors, into a PNG file.")
      ->type_name("FILE.png")
      ->group(kOutputGroup);
  app.add_option("--json", arguments->json, "Write the verdicts with all figures into a JSON file, for programs.")
      ->type_name("FILE")
      ->group(kOutputGroup);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console& console) { return run(*arguments, console); }};
}

}  // namespace quell::app
