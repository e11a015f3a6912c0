// What renderers disagree about: sign, unit and direction of motion, what depth measures, in which space normals are, and the
// like.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/image.h"
#include "quell/image/item.h"
#include "quell/sequence/image_file.h"

namespace quell {

enum class MotionSign { previous_minus_current, current_minus_previous };
enum class MotionUnit {
  pixels,
  uv,   ///< fractions of the image: 1 is its whole width, or height
  ndc,  ///< -1 to 1 across the image: 2 is its whole width, or height
};
enum class YDirection { down, up };
enum class Jitter {
  excluded,  ///< a point that stands still, seen by a camera that stands still, has no motion
  included,  ///< the motion holds the difference of the two frames' jitter
};
enum class DepthMeasure {
  axis,        ///< distance along the view axis
  ray,         ///< distance from the camera
  reciprocal,  ///< 1 / distance along the view axis; 0 where there is no surface
};
enum class Space { world, camera };
enum class Encoding {
  signed_numbers,    ///< -1 to 1
  unsigned_numbers,  ///< (n + 1) / 2, so 0 to 1
};
enum class AlphaKind { premultiplied, straight };
enum class Transfer { linear, srgb };
/// How the 16 numbers of a header's matrix are to be understood.
enum class VectorOrder {
  row,     ///< p' = p M, as OpenEXR's own library multiplies: the translation stands in the last four numbers
  column,  ///< p' = M p: the translation ends each group of four numbers
};
enum class SignOfW {
  positive,  ///< the projection's w is above 0 in front of the camera
  negative,  ///< below 0, and x and y are to be divided by -w
};
enum class NdcRange {
  zero_to_one,         ///< 0 to 1 across the image, as OpenEXR describes worldToNDC
  minus_one_to_one,    ///< -1 to 1
  zero_to_one_shorter  ///< 0 to 1 across the shorter side, and as far as need be across the longer one, as pbrt-v4 writes it
};

/// How the numbers of one input's files are meant. What is not stated is as the recognized renderer or file format has it, else
/// as quell itself has it (the first choice of each enum); of a header's camera it is found out, see header_camera.h.
struct Conventions {
  std::optional<MotionSign> sign;          ///< of motion
  std::optional<MotionUnit> unit;          ///< of motion
  std::optional<YDirection> y;             ///< of motion, and of the NDC of a header's camera
  std::optional<Jitter> jitter;            ///< of motion
  std::optional<DepthMeasure> depth;       ///< of depth
  std::optional<Space> space;              ///< of normal and position
  std::optional<Encoding> encoding;        ///< of normal
  std::optional<std::int64_t> background;  ///< of id: the value where there is no surface
  std::optional<AlphaKind> alpha;          ///< of color
  std::optional<Transfer> transfer;        ///< of color and albedo
  std::optional<VectorOrder> vectors;      ///< of a header's camera
  std::optional<NdcRange> ndc;             ///< of a header's camera
  std::optional<SignOfW> w;                ///< of a header's camera

  /// These, and what they leave open as `others` have it.
  Conventions or_else(const Conventions& others) const;
  bool operator==(const Conventions&) const = default;
};

/// One convention as it is written in `--in NAME=PATTERN:key=value` and in a sequence.json.
struct ConventionKey {
  std::string_view key;                  ///< "sign"
  std::vector<PortType> types;           ///< of inputs that have it
  std::vector<std::string_view> values;  ///< "previous-current", ...; empty for an integer
  std::string_view doc;                  ///< a sentence for people
};
/// Every key, in the order of Conventions.
const std::vector<ConventionKey>& convention_keys();
/// Sets the convention named `key`. The message says what is wrong and what would be right; nothing when all is well.
std::optional<std::string> set_convention(Conventions& conventions, std::string_view key, std::string_view value);
/// "sign is a convention of motion, not of color", for the first that is stated although images of this type have none; nothing
/// when all is well.
std::optional<std::string> find_misplaced(const Conventions& conventions, PortType type);
/// "sign=current-previous, unit=uv"; "" when nothing is stated.
std::string describe(const Conventions& conventions);

/// What files of a format mean when nobody says otherwise. `format` is ImageFile::format(). 8 and 16 bit pictures hold color and
/// albedo by the sRGB curve with straight alpha, and normals as 0 to 1; everything else is as quell has it.
Conventions default_conventions(std::string_view format, Numbers numbers, PortType type);

/// What a conversion may have to ask for.
struct ConversionContext {
  std::string file;  ///< for messages
  /// The whole image as it was rendered (the display window), of which the one to be converted may be a part; 0 x 0: it is the
  /// whole.
  Size whole = {};
  int x = 0, y = 0;  ///< where in the whole image the part's pixel (0, 0) lies
  /// The camera of the whole image, `frames_back` frames before the image's own; nothing when there is none for that frame.
  /// Throws Error(input) when the sequence has no camera at all.
  std::function<std::shared_ptr<const Camera>(int frames_back)> camera = {};
  /// The file's alpha for the same pixels (one plane); nothing when it has none.
  std::function<std::optional<Image>()> alpha = {};
  /// Told what a person should know.
  std::function<void(const std::string&)> note = {};
};

/// Converts what was read as it stands in the file to the fixed meaning of the image's type, pixel by pixel, each computed in
/// double and rounded once. Ids are converted by convert_ids(). What is stated of another type is not looked at. NaN and infinity
/// stay what they are, to be counted later, but for depths (see mark_no_surface()). Throws Error(input) naming the file.
///
/// - motion: scaled to pixels of the whole image, turned to y down and to previous minus current; then the jitter's difference is
///   taken off. A frame without a camera before it counts as one without jitter, and that is noted.
/// - depth: along the view axis; `no surface` as mark_no_surface() says, looked for before the conversion (of a ray's length) or
///   after it (1 / 0 is infinite).
/// - normal: decoded, turned to world space, scaled to unit length. 0 (no surface) are the zero vector and, of unsigned
///   numbers, also three that each differ from 0.5 by 1/255 at most: 8 bits cannot say 0.5, and write 127 or 128.
/// - position: turned to world space; the zero vector, which in camera space is the camera itself, stays: no surface.
/// - color, albedo: the transfer curve is undone, then straight alpha multiplied.
void to_meaning(Image& image, const Conventions& conventions, const ConversionContext& context);

}  // namespace quell
