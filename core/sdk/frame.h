// What a pass sees: the shapes it is asked about (Inference) and the data of one frame (Frame).
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "quell/sdk/types.h"

namespace quell {

/// One port of a pass, as data. An output has either `types` (exactly one) or `same_as`, the input whose type it takes.
struct PortInfo {
  const char* name;
  Types types = 0;
  const char* doc = "";
  bool optional = false;  ///< input: may be unconnected or absent
  bool array = false;     ///< input: a list of sources. output: one item for each of `same_as`
  const char* same_as = nullptr;
  bool any_size = false;  ///< input: its images may have another size than those of the other inputs
};

namespace detail {
inline int find_port(const std::vector<PortInfo>& ports, std::string_view name) {
  for (std::size_t i = 0; i < ports.size(); ++i)
    if (name == ports[i].name) return static_cast<int>(i);
  throw std::logic_error("the pass asks for a port '" + std::string(name) + "' that it does not declare");
}
}  // namespace detail

/// The size of an image; 0 x 0 for what is not an image.
struct Size {
  int width = 0, height = 0;
  bool operator==(const Size&) const = default;
};

/// The question and answer of Pass::infer. Unless told otherwise, every output has the size of the first image input that is not
/// of any size, every radius is 0, nothing is computed in place and no scratch is given.
class Inference {
 public:
  Inference(const std::vector<PortInfo>& inputs, const std::vector<PortInfo>& outputs, quell_inference& raw)
      : inputs_(inputs), outputs_(outputs), raw_(raw) {}

  std::size_t count(std::string_view input) const { return in(input).count; }
  bool present(std::string_view input, std::size_t item = 0) const {
    return item < count(input) && shape(in(input), item).present;
  }
  Size size(std::string_view input, std::size_t item = 0) const {
    const quell_shape& s = shape(in(input), item);
    return {s.width, s.height};
  }
  quell_type type(std::string_view input, std::size_t item = 0) const {
    return static_cast<quell_type>(shape(in(input), item).type);
  }

  void set_size(std::string_view output, Size size, std::size_t item = 0) {
    quell_shape& s = shape(out(output), item);
    s.width = size.width, s.height = size.height;
  }
  void set_value_count(std::string_view output, std::uint32_t count) { shape(out(output), 0).value_count = count; }
  /// Pixels read around a pixel, in each direction.
  void set_radius(std::string_view input, int radius) { raw_.radius[detail::find_port(inputs_, input)] = radius; }
  /// Pixels may be read from anywhere, as a fetch by motion vector does.
  void set_unbounded(std::string_view input) { set_radius(input, QUELL_RADIUS_UNBOUNDED); }
  /// The output may be written over the input, pixel for pixel. Needs radius 0.
  void set_in_place(std::string_view output, std::string_view input) {
    raw_.in_place_of[detail::find_port(outputs_, output)] = detail::find_port(inputs_, input);
  }
  void set_scratch(std::size_t bytes) { raw_.scratch_bytes = bytes; }
  void set_slot_scratch(std::size_t bytes) { raw_.slot_scratch_bytes = bytes; }
  /// Promises that run() touches images within parallel_rows() alone, over the rows of its outputs, and that each row depends by
  /// itself on rows of the inputs no farther off than the radius. The host may then run it on some rows at a time, together with
  /// the nodes before and behind it, so that what passes between them stays in the cache. See quell_inference::by_rows.
  void set_by_rows() {
    if (raw_.struct_size >= offsetof(quell_inference, by_rows) + sizeof(raw_.by_rows)) raw_.by_rows = 1;
  }
  /// How fast earlier frames fade from results that come back in later ones: no more than `kept` of the history, 0 to 1, is left
  /// after each frame, and a counter is the same after `settles` frames, whatever it was. See quell_inference::kept.
  void set_fading(double kept, int settles = 0) {
    if (raw_.struct_size < offsetof(quell_inference, settles) + sizeof(raw_.settles)) return;
    raw_.kept = kept, raw_.settles = settles;
  }

 private:
  const quell_port_shape& in(std::string_view name) const {
    return *QUELL_AT(quell_port_shape, raw_.inputs, detail::find_port(inputs_, name));
  }
  const quell_port_shape& out(std::string_view name) const {
    return *QUELL_AT(quell_port_shape, raw_.outputs, detail::find_port(outputs_, name));
  }
  static quell_shape& shape(const quell_port_shape& port, std::size_t item) {
    if (item >= port.count) throw std::logic_error("the pass asks for an item that the port does not have");
    return const_cast<quell_shape&>(*QUELL_AT(quell_shape, port.items, item));  // NOLINT: the host's arrays are writable
  }
  const std::vector<PortInfo>& inputs_;
  const std::vector<PortInfo>& outputs_;
  quell_inference& raw_;
};

/// One frame of one node: its inputs, its outputs, and the host's services.
class Frame {
 public:
  static constexpr int kRowsPerChunk = 8;  // small enough to balance, large enough that a chunk's overhead does not show

  Frame(const std::vector<PortInfo>& inputs, const std::vector<PortInfo>& outputs, const quell_host& host, const quell_exec& raw)
      : inputs_(inputs), outputs_(outputs), host_(host), raw_(raw) {}

  std::int64_t number() const { return raw_.frame; }

  /// How many items the input has: 0 when unconnected, 1 for a plain port, more for an array.
  std::size_t count(std::string_view input) const { return in(input).count; }
  /// False when the input is unconnected or has nothing in this frame.
  bool has(std::string_view input, std::size_t i = 0) const {
    const quell_item* it = item(in(input), i);
    return it && (it->image || it->camera || it->values);
  }
  /// The type of what the input carries; it has that item.
  quell_type type(std::string_view input, std::size_t i = 0) const {
    const quell_item* it = item(in(input), i);
    if (!it) throw std::logic_error("the pass asks for an item that the port does not have");
    return static_cast<quell_type>(it->type);
  }
  /// Float planes of an input; a false view when absent.
  FloatImage image(std::string_view input, std::size_t i = 0) const {
    return view<const float>(item(in(input), i), QUELL_FORMAT_F32);
  }
  IdImage ids(std::string_view input, std::size_t i = 0) const {
    return view<const std::uint32_t>(item(in(input), i), QUELL_FORMAT_U32);
  }
  const quell_camera* camera(std::string_view input) const {
    const quell_item* it = item(in(input), 0);
    return it ? it->camera : nullptr;
  }
  std::span<const double> values(std::string_view input) const {
    const quell_item* it = item(in(input), 0);
    return it && it->values ? std::span<const double>(it->values->data, it->values->count) : std::span<const double>();
  }

  FloatOutput output(std::string_view name, std::size_t i = 0) const { return view<float>(item(out(name), i), QUELL_FORMAT_F32); }
  IdOutput output_ids(std::string_view name, std::size_t i = 0) const {
    return view<std::uint32_t>(item(out(name), i), QUELL_FORMAT_U32);
  }
  std::span<double> output_values(std::string_view name) const {
    const quell_item* it = item(out(name), 0);
    if (!it || !it->values) throw std::logic_error("the pass writes values to an output that carries none");
    return {it->values->data, it->values->count};
  }

  void* scratch() const { return raw_.scratch; }
  void* slot_scratch(std::uint32_t slot) const { return raw_.slot_scratch[slot]; }

  /// Calls body(y0, y1) for bands of rows that cover [0, height), in parallel. The bands do not depend on the number of threads.
  /// An exception of the topmost failing band is passed on. body may take the slot as a third argument.
  template <class Body>
  void parallel_rows(int height, const Body& body, int rows = kRowsPerChunk) const {
    struct Context {
      const quell_host& host;
      const Body& body;
      std::mutex mutex{};
      std::int64_t failed_chunk = 0;
      std::exception_ptr error{};
    } context{host_, body};
    const quell_chunk_fn run = [](void* raw, std::int64_t chunk, std::int64_t begin, std::int64_t end,
                                  std::uint32_t slot) -> quell_status {
      Context& c = *static_cast<Context*>(raw);
      if (c.host.cancelled(&c.host)) return QUELL_CANCELLED;
      try {
        if constexpr (std::is_invocable_v<const Body&, int, int, std::uint32_t>)
          c.body(static_cast<int>(begin), static_cast<int>(end), slot);
        else
          c.body(static_cast<int>(begin), static_cast<int>(end));
        return QUELL_OK;
      } catch (...) {
        const std::scoped_lock lock(c.mutex);
        if (!c.error || chunk < c.failed_chunk) c.error = std::current_exception(), c.failed_chunk = chunk;
        return QUELL_FAILED;
      }
    };
    const quell_status status = host_.parallel_for(&host_, 0, height, rows, run, &context);
    if (context.error) std::rethrow_exception(context.error);
    if (status == QUELL_CANCELLED) throw Cancelled();
    if (status != QUELL_OK) throw std::runtime_error("the host could not run a parallel loop");
  }

  bool cancelled() const { return host_.cancelled(&host_) != 0; }
  void log(int level, const std::string& message) const { host_.log(&host_, level, message.c_str()); }

 private:
  const quell_port& in(std::string_view name) const {
    return *QUELL_AT(quell_port, raw_.inputs, detail::find_port(inputs_, name));
  }
  const quell_port& out(std::string_view name) const {
    return *QUELL_AT(quell_port, raw_.outputs, detail::find_port(outputs_, name));
  }
  static const quell_item* item(const quell_port& port, std::size_t i) {
    return i < port.count ? QUELL_AT(quell_item, port.items, i) : nullptr;
  }
  template <class Value>
  static ImageView<Value> view(const quell_item* item, quell_format format) {
    if (!item || !item->image) return {};
    const quell_image& image = *item->image;
    if (image.format != static_cast<std::uint32_t>(format))
      throw std::logic_error("the pass reads float planes as ids, or ids as float");
    return {image.width,      image.height,       static_cast<int>(image.channels),
            image.row_stride, image.plane_stride, static_cast<Value*>(image.data)};
  }
  const std::vector<PortInfo>& inputs_;
  const std::vector<PortInfo>& outputs_;
  const quell_host& host_;
  const quell_exec& raw_;
};

}  // namespace quell
