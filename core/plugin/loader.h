// Opens a plugin file, and tells in plain words why it cannot be opened. Private to this box.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <string>

#include "quell/sdk/abi.h"

namespace quell {

/// What a plugin's quell_plugin_passes returned; valid for the rest of the process, since plugins are never closed.
struct PassList {
  const quell_pass_desc* const* passes = nullptr;
  std::uint32_t count = 0;
};

/// Loads a shared object and asks it for its passes. Throws Error(plugin), with `file` as the place, when it is not a shared
/// object for this machine, does not link, lacks a symbol, was built for another interface, or throws.
PassList open_plugin(const std::filesystem::path& file);

/// The folder of the built-in passes: `quell/passes` beside the core library, in the build tree as after installation.
std::filesystem::path built_in_passes();

/// Runs a plugin's function; what it throws, although it must not, becomes the text "it threw ...". Empty when all went well.
template <class Body>
std::string thrown_by(const Body& body) {
  try {
    body();
    return {};
  } catch (const std::exception& error) { return std::string("it threw '") + error.what() + "'"; } catch (...) {
    return "it threw something that is not a std::exception";
  }
}

}  // namespace quell
