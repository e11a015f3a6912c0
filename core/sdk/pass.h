// How a pass is written: a PassInfo that describes it, a Params with its settings, a class with infer() and run(), and one line
// that registers them. See passes/README.md for a whole example.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "quell/sdk/frame.h"
#include "quell/sdk/params.h"
#include "quell/sdk/types.h"

namespace quell {

/// What a version of a pass changed (see quell_change).
struct Change {
  std::uint32_t version;
  const char* param;
  const char* renamed_to = nullptr;
  std::optional<std::variant<bool, std::int64_t, double, std::string>> former_default = std::nullopt;
};

struct PassInfo {
  const char* id;  ///< snake_case, unique among all plugins
  std::uint32_t version = 1;
  std::uint32_t oldest_version = 1;
  const char* summary = "";  ///< one line
  const char* doc = "";
  const char* source = "";  ///< paper and equations, and where the pass departs from them
  std::vector<PortInfo> inputs;
  std::vector<PortInfo> outputs;
  std::vector<Change> changes = {};
};

/// The algorithm. Immutable after construction; run() may be called for several frames at once.
class Pass {
 public:
  virtual ~Pass() = default;
  /// States radius, in-place, scratch and output sizes where they differ from Inference's defaults.
  virtual void infer(Inference&) const {}
  virtual void run(const Frame&) const = 0;
};

namespace detail {

template <class Body>
quell_status guard(const quell_host* host, const Body& body) noexcept {
  try {
    body();
    return QUELL_OK;
  } catch (const Cancelled&) { return QUELL_CANCELLED; } catch (const std::exception& error) {
    host->set_error(host, error.what());
  } catch (...) { host->set_error(host, "the pass threw something that is not a std::exception"); }
  return QUELL_FAILED;
}

/// Turns a PassInfo and a Params into the C descriptor, and owns what that points to. Hidden, as registered_passes() is: two
/// plugins may have classes of one name.
class [[gnu::visibility("hidden")]] Descriptor {
 public:
  template <class ConcretePass, class Params>
  static Descriptor& make(const PassInfo& info) {
    static Descriptor descriptor(info);
    static std::once_flag once;
    std::call_once(once, [] {
      Params defaults{};
      if constexpr (requires { defaults.describe(descriptor.params_); }) defaults.describe(descriptor.params_);
      descriptor.finish();
      quell_pass_desc& desc = descriptor.desc_;
      desc.create = [](const quell_host* host, const quell_param_value* values, void** instance) -> quell_status {
        return guard(host, [&] {
          Params params{};
          ParamReader reader(values);
          if constexpr (requires { params.describe(reader); }) params.describe(reader);
          *instance = static_cast<Pass*>(std::make_unique<ConcretePass>(params).release());
        });
      };
      desc.destroy = [](void* instance) { delete static_cast<Pass*>(instance); };
      desc.infer = [](const void* instance, const quell_host* host, quell_inference* raw) -> quell_status {
        return guard(host, [&] {
          Inference inference(descriptor.info_.inputs, descriptor.info_.outputs, *raw);
          static_cast<const Pass*>(instance)->infer(inference);
        });
      };
      desc.process = [](const void* instance, const quell_host* host, const quell_exec* exec) -> quell_status {
        return guard(host, [&] {
          static_cast<const Pass*>(instance)->run(Frame(descriptor.info_.inputs, descriptor.info_.outputs, *host, *exec));
        });
      };
    });
    return descriptor;
  }
  const quell_pass_desc* get() const { return &desc_; }

 private:
  explicit Descriptor(const PassInfo& info) : info_(info) {}

  void finish() {
    for (const PortInfo& port : info_.inputs) inputs_.push_back(describe(port));
    for (const PortInfo& port : info_.outputs) outputs_.push_back(describe(port));
    for (const Change& change : info_.changes) {
      const quell_param_value* former = nullptr;
      if (change.former_default)
        former =
            std::visit([this](const auto& value) { return former_defaults_.emplace_back(value).get(); }, *change.former_default);
      changes_.push_back({sizeof(quell_change), change.version, change.param, change.renamed_to, former});
    }
    desc_.struct_size = sizeof(desc_);
    desc_.version = info_.version, desc_.oldest_version = info_.oldest_version;
    desc_.id = info_.id, desc_.summary = info_.summary, desc_.doc = info_.doc, desc_.source = info_.source;
    desc_.inputs = inputs_.data(), desc_.input_count = static_cast<std::uint32_t>(inputs_.size());
    desc_.outputs = outputs_.data(), desc_.output_count = static_cast<std::uint32_t>(outputs_.size());
    desc_.params = params_.descriptors().data(), desc_.param_count = static_cast<std::uint32_t>(params_.descriptors().size());
    desc_.changes = changes_.data(), desc_.change_count = static_cast<std::uint32_t>(changes_.size());
  }
  quell_port_desc describe(const PortInfo& port) const {
    const std::uint32_t flags = (port.optional ? QUELL_PORT_OPTIONAL : 0u) | (port.array ? QUELL_PORT_ARRAY : 0u) |
                                (port.any_size ? QUELL_PORT_ANY_SIZE : 0u);
    // A name that no input has becomes an index that none has, which the host refuses: nothing may throw while a plugin loads.
    int same_as = port.same_as ? 0 : -1;
    while (same_as >= 0 && same_as < static_cast<int>(inputs_.size()) &&
           std::string_view(port.same_as) != info_.inputs[static_cast<std::size_t>(same_as)].name)
      ++same_as;
    return {sizeof(quell_port_desc), flags, port.name, port.types, same_as, port.doc};
  }

  PassInfo info_;
  ParamDescriber params_;
  std::vector<quell_port_desc> inputs_, outputs_;
  std::deque<OwnedValue> former_defaults_;
  std::vector<quell_change> changes_;
  quell_pass_desc desc_{};
};

/// The passes of this plugin. Hidden, so that every shared object has its own.
[[gnu::visibility("hidden")]] inline std::vector<const quell_pass_desc*>& registered_passes() {
  static std::vector<const quell_pass_desc*> passes;
  return passes;
}

/// Runs while the plugin is being loaded, when nothing may be thrown: what cannot be described becomes a null entry, which the
/// host reports.
template <class ConcretePass, class Params>
bool register_pass(const PassInfo& info) noexcept {
  const quell_pass_desc* desc = nullptr;
  try {
    desc = Descriptor::make<ConcretePass, Params>(info).get();
  } catch (...) {  // NOLINT: told to the host by the null
  }
  registered_passes().push_back(desc);
  return true;
}

}  // namespace detail
}  // namespace quell

/// Registers a pass and gives the plugin its two exported functions. At namespace scope, once a source file.
/// `info` is a PassInfo, `PassClass` derives from Pass and is constructed from a `const ParamsStruct&`.
#define QUELL_REGISTER_PASS(info, PassClass, ParamsStruct)                                                                  \
  extern "C" [[gnu::visibility("default"), gnu::used]] inline uint32_t quell_plugin_abi(void) { return QUELL_ABI_VERSION; } \
  extern "C" [[gnu::visibility("default"), gnu::used]] inline const quell_pass_desc* const* quell_plugin_passes(            \
      uint32_t* count) {                                                                                                    \
    const auto& passes = ::quell::detail::registered_passes();                                                              \
    *count = static_cast<uint32_t>(passes.size());                                                                          \
    return passes.data();                                                                                                   \
  }                                                                                                                         \
  [[maybe_unused]] static const bool quell_pass_is_registered = ::quell::detail::register_pass<PassClass, ParamsStruct>(info);
