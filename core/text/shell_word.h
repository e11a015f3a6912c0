// Words of command lines that a person is told to type.
#pragma once

#include <string>

namespace quell {

/// The text as a shell takes it for one word: as it is, or quoted.
std::string shell_word(const std::string& text);

}  // namespace quell
