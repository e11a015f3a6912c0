// Text that a command prints, or writes to a file that takes its name when it is complete.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace quell::app {

/// Prints the text, or writes it to the file that --out names. Throws Error(usage) naming the option when the file cannot be
/// written, or when something stands there that does not begin so: it was not written by the same command.
void write_output(const std::string& text, const std::optional<std::string>& out, std::string_view beginning,
                  const char* option = "--out");

/// The same refusals before there is a text, so that long work does not end with one.
void require_writable(const std::string& out, std::string_view beginning, const char* option = "--out");

}  // namespace quell::app
