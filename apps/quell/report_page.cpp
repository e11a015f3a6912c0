#include "report_page.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "quell/sequence/pending_file.h"
#include "quell/text/error.h"
#include "quell/text/html_text.h"
#include "results.h"

namespace quell::app {
namespace {

// Where the page, which begins so, wants its title and its data.
constexpr std::string_view kBeginning = "<!doctype html>\n<!-- quell report -->\n";
constexpr std::string_view kTitle = "<title>quell report</title>", kData = "<!-- data of the report -->";

void write_images(std::ostream& out, const PackedImages& images) {
  int number = 0;
  for (const PackedImage& image : images.all())
    out << "<script type=\"text/plain\" id=\"image-" << number++ << "\">" << image.text << "</script>\n";
}

}  // namespace

std::string script_json(const Json& value) {
  std::string text;
  for (const char c : write_json(value))
    if (c == '<')  // of a tag's end, or of a comment's beginning; in JSON it stands in strings alone
      text += "\\u003c";
    else
      text += c;
  return text;
}

void check_report_file(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    throw Error(Fault::usage, "--out", file.string() + " is not a file; choose another name");
  refuse_to_replace_others(file, kBeginning, "--out");
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error))
    throw Error(Fault::usage, "--out", "there is no folder " + folder.string() + "; make it first");
}

void write_report(const std::filesystem::path& file, const std::string& title, const Json& data, const PackedImages& images) {
  const std::size_t head = kReportPage.find(kTitle), body = kReportPage.find(kData);
  PendingFile pending(file);
  std::ofstream stream(pending.path(), std::ios::binary);
  stream << kReportPage.substr(0, head) << "<title>" << escape_html(title) << "</title>"
         << kReportPage.substr(head + kTitle.size(), body - head - kTitle.size());
  stream << "<script type=\"application/json\" id=\"report\">\n" << script_json(data) << "</script>\n";
  write_images(stream, images);
  stream << kReportPage.substr(body + kData.size());
  stream.close();
  if (!stream) throw Error(Fault::usage, "--out", file.string() + " cannot be written: " + std::strerror(errno));
  pending.commit();
}

}  // namespace quell::app
