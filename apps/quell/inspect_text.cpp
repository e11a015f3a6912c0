#include "inspect_text.h"

#include "json_lines.h"
#include "text_layout.h"

namespace quell::app {
namespace {

constexpr std::size_t kIndent = 2, kColumn = 14;

std::string describe_one(const Told& told, bool many_frames) {
  const Finding& finding = told.finding;
  std::string text = finding.subject + ": " + finding.text;
  const bool alarming = finding.verdict >= Verdict::suspicious;
  if (many_frames && alarming && finding.frame_matters) text += " (frame " + std::to_string(finding.frame) + ")";
  std::string out = entry(name(finding.verdict), text, kIndent, kColumn);
  if (!told.option.empty()) out += std::string(kColumn, ' ') + "try " + told.option + "\n";  // unbroken, to be copied
  return out;
}

std::string sum_up(const Inspection& inspection) {
  const auto some = [&](Verdict verdict, const char* word) {
    const std::size_t n = inspection.count(verdict);
    return n == 0 ? std::string() : ", " + std::to_string(n) + " " + word;
  };
  const std::size_t wrong = inspection.count(Verdict::wrong);
  return (wrong == 0 ? std::string("nothing is wrong") : std::to_string(wrong) + (wrong == 1 ? " is" : " are") + " wrong") +
         some(Verdict::suspicious, "suspicious") + some(Verdict::not_tested, "not tested") + "\n";
}

}  // namespace

std::string describe(const Inspection& inspection) {
  std::string text = "tested in frame" + std::string(inspection.frames.size() == 1 ? " " : "s ") +
                     FrameRange(inspection.frames).text() +
                     (inspection.frames.size() > 1 ? ", the figures are of the worst:\n" : ":\n");
  for (const Told& told : inspection.told) text += describe_one(told, inspection.frames.size() > 1);
  return text + sum_up(inspection);
}

std::string to_json(const Inspection& inspection, const Sequence& sequence) {
  std::vector<JsonObject> findings, inputs;
  for (const InputFiles& input : sequence.inputs())
    inputs.push_back(JsonObject()
                         .text("input", input.input)
                         .text("type", input.type ? quell::name(*input.type) : "")
                         .text("files", input.pattern)
                         .text("frames", FrameRange(input.frames).text()));
  for (const auto& [finding, option] : inspection.told) {
    JsonObject figures;
    for (const Figure& figure : finding.figures) figures.value(figure.name, figure.value);
    findings.push_back(JsonObject()
                           .text("subject", finding.subject)
                           .text("verdict", finding.verdict == Verdict::wrong ? "wrong" : quell::name(finding.verdict))
                           .text("text", finding.text)
                           .text("option", option)
                           .number("frame", finding.frame)
                           .object("figures", figures));
  }
  return JsonObject()
             .text("sequence", sequence.describe())
             .objects("inputs", inputs)
             .text("frames", FrameRange(inspection.frames).text())
             .objects("findings", findings)
             .str() +
         "\n";
}

}  // namespace quell::app
