#include "quell/plugin/loader.h"

#include <dlfcn.h>
#include <link.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "quell/text/error.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

// Something of this library itself. A function would not do: its address may be a stub inside the executable.
const char kAnchor = 0;

fs::path core_library() {
  Dl_info info{};
  if (dladdr(&kAnchor, &info) == 0 || !info.dli_fname) throw Error(Fault::plugin, "", "the core library's own place is unknown");
  return fs::canonical(info.dli_fname);
}

[[noreturn]] void fail(const fs::path& file, const std::string& what) { throw Error(Fault::plugin, file.string(), what); }

std::string version(std::uint32_t abi) { return std::to_string(abi >> 16) + "." + std::to_string(abi & 0xffffu); }

/// The file's ELF header; all bytes 0 when the file is shorter.
ElfW(Ehdr) read_elf_header(const fs::path& file) {
  ElfW(Ehdr) header{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(&header), sizeof(header));
  return stream ? header : ElfW(Ehdr){};
}

/// True when every segment lies within the file. dlopen maps segments without looking, and dies on those that do not.
bool is_whole(const fs::path& file, const ElfW(Ehdr) & header) {
  const std::uintmax_t size = fs::file_size(file);
  if (header.e_phentsize != sizeof(ElfW(Phdr)) || header.e_phoff > size) return false;
  std::vector<ElfW(Phdr)> segments(header.e_phnum);
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(header.e_phoff));
  stream.read(reinterpret_cast<char*>(segments.data()), static_cast<std::streamsize>(segments.size() * sizeof(ElfW(Phdr))));
  if (!stream) return false;
  for (const ElfW(Phdr) & segment : segments)
    if (segment.p_filesz > size || segment.p_offset > size - segment.p_filesz) return false;
  return true;
}

void require_shared_object(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) fail(file, error ? "cannot be read: " + error.message() : "there is no such file");
  if (!fs::is_regular_file(file)) fail(file, "not an ELF shared object: this is not a regular file");
  if (!std::ifstream(file, std::ios::binary)) fail(file, "cannot be read: " + std::string(std::strerror(errno)));
  const ElfW(Ehdr) header = read_elf_header(file);
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) fail(file, "not an ELF shared object: the file has no ELF header");
  const ElfW(Ehdr) own = read_elf_header(core_library());
  const bool same_class = header.e_ident[EI_CLASS] == own.e_ident[EI_CLASS] && header.e_ident[EI_DATA] == own.e_ident[EI_DATA];
  if (!same_class || header.e_machine != own.e_machine)
    fail(file, "not an ELF shared object for this machine; build the plugin for the machine that runs quell");
  if (header.e_type != ET_DYN)
    fail(file, "not an ELF shared object: this is an ELF file of another kind, such as an object file");
  if (!is_whole(file, header)) fail(file, "not an ELF shared object: the file is truncated");
}

template <class Function>
Function find_symbol(void* library, const fs::path& file, const char* name) {
  void* symbol = dlsym(library, name);
  if (!symbol)
    fail(file, std::string("not a quell plugin: the symbol '") + name + "' is missing; QUELL_REGISTER_PASS would define it");
  return reinterpret_cast<Function>(symbol);
}

void require_known_abi(const fs::path& file, std::uint32_t abi) {
  if (abi >> 16 == QUELL_ABI_MAJOR && abi <= QUELL_ABI_VERSION) return;
  const std::string built = "built for plugin interface " + version(abi) + ", this quell supports ";
  if (abi > QUELL_ABI_VERSION) fail(file, built + "up to " + version(QUELL_ABI_VERSION) + "; rebuild the plugin or update quell");
  fail(file, built + version(QUELL_ABI_MAJOR << 16) + " to " + version(QUELL_ABI_VERSION) + "; rebuild the plugin");
}

}  // namespace

fs::path built_in_passes() { return core_library().parent_path() / "quell" / "passes"; }

PassList open_plugin(const fs::path& file) {
  require_shared_object(file);
  // A name without a slash would be looked for in the system's folders.
  void* library = dlopen(fs::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) fail(file, std::string("cannot be loaded: ") + dlerror());

  // The cheap probe comes first: nothing else of a plugin from another time is touched.
  const auto probe = find_symbol<quell_plugin_abi_fn>(library, file, QUELL_PLUGIN_ABI_SYMBOL);
  std::uint32_t abi = 0;
  if (const std::string thrown = thrown_by([&] { abi = probe(); }); !thrown.empty())
    fail(file, std::string(QUELL_PLUGIN_ABI_SYMBOL) + " failed: " + thrown);
  require_known_abi(file, abi);

  const auto list = find_symbol<quell_plugin_passes_fn>(library, file, QUELL_PLUGIN_PASSES_SYMBOL);
  PassList result;
  if (const std::string thrown = thrown_by([&] { result.passes = list(&result.count); }); !thrown.empty())
    fail(file, std::string(QUELL_PLUGIN_PASSES_SYMBOL) + " failed: " + thrown);
  return result;
}

}  // namespace quell
