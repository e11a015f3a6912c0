// What renderers call what they write: a table.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "quell/sequence/layers.h"

namespace quell {

/// One row: a layer that a renderer writes, and what it is.
struct RendererName {
  std::string_view renderer;
  std::string_view input;  ///< the input that it serves, "color"; where that is a type's name, inputs of other names with it, too
  PortType type;
  std::string_view layer;  ///< how the layer's name ends; "*.Normal": with something before; "": no layer; "*": whatever its name
  std::string_view channels;  ///< suffixes, one for each plane ("X,Y,Z"), alternatives with |; "*": the only channel there
  int rank;                   ///< the smallest of a file wins
  Conventions conventions;
  std::string_view beside;  ///< a channel that the file must have, too, for the row to count; "" for none
  std::string_view source;  ///< where this is known from
};

/// Rows for layers of a file. For a layer and an input, the first that matches counts.
std::span<const RendererName> renderer_names();
/// Rows for files that hold one image each; `layer` is how the file's name without frame and extension ends.
std::span<const RendererName> renderer_file_names();

/// Whether a name ends as a row's pattern says; case does not count.
bool matches(std::string_view pattern, std::string_view name);

/// What a file offers for an input: nothing, the one candidate of the best rank, or several of that rank. A layer
/// that has the input's own name counts like a row of rank 0, and like one of rank 2 where only its last part is that name.
std::vector<Selection> recognize(const std::vector<FileChannel>& channels, std::string_view input, PortType type);
/// The same for a file of one image by its name ("Mogwai.GBufferRT.mvec").
std::vector<Selection> recognize_by_file_name(std::string_view stem, const std::vector<FileChannel>& channels,
                                              std::string_view input, PortType type);
/// As what a layer is known: the first row for this layer and input; nothing when there is none.
std::optional<Selection> recognize_layer(const Layer& layer, const std::vector<FileChannel>& channels, std::string_view input,
                                         PortType type);

/// Inputs that files are searched for when nobody says which are wanted.
const std::vector<std::string>& usual_inputs();

}  // namespace quell
