// The report as one file: the page of apps/report, built into the program, and what it shows.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "quell/text/json_write.h"
#include "report_pixels.h"

namespace quell::app {

/// Made by CMake from apps/report/page.html.
extern const std::string_view kReportPage;
/// From apps/report/src/means.json: an object whose keys are the passes whose weights the page tells.
extern const std::string_view kReportMeans;

/// The text of a value that can stand in a <script> of a page whatever its strings hold.
std::string script_json(const Json& value);

/// Throws Error(usage) naming --out when something stands there that is no report, or there is no such folder.
void check_report_file(const std::filesystem::path& file);

/// Writes the page with the data in place of its marker. The file takes its name when it is complete. Throws Error(usage) naming
/// --out when it cannot be written.
void write_report(const std::filesystem::path& file, const std::string& title, const Json& data, const PackedImages& images);

}  // namespace quell::app
