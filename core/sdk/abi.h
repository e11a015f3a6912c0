// The plugin interface in plain C: everything that crosses between quell and a plugin is declared here.
//
// A plugin exports two functions, quell_plugin_abi and quell_plugin_passes. The first is a cheap probe; the second returns
// the plugin's passes as constant data. Writing them by hand is possible, but `pass.h` (C++20, header only) is the pleasant way.
//
// Rules that hold for the whole interface:
//  - Every struct starts with `struct_size`, the size its writer compiled with. A reader uses a field only when the size covers
//    it. Elements of an array lie `struct_size` of the first element apart (QUELL_AT), so that structs can grow at the end.
//  - A plugin loads when its major version equals the host's and its minor version is not newer. The minor version rises with
//    everything that is added and that a plugin may use: a function of the host, a field, a type, a flag. An older host would
//    not know it, and says so.
//  - The host owns every buffer. No exception, no std type and no ownership crosses. Strings are UTF-8, zero-terminated.
//  - A pass keeps nothing between frames, and may be run on several frames at once.
#ifndef QUELL_SDK_ABI_H
#define QUELL_SDK_ABI_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define QUELL_ABI_MAJOR 1u
// 1: quell_inference::by_rows, QUELL_PORT_ANY_SIZE. 2: quell_inference::kept, settles
#define QUELL_ABI_MINOR 2u
#define QUELL_ABI_VERSION ((QUELL_ABI_MAJOR << 16) | QUELL_ABI_MINOR)

// Element i of an array whose elements may be larger than this header knows.
#define QUELL_AT(type, array, i) ((const type*)(const void*)((const char*)(array) + (size_t)(i) * (size_t)(array)->struct_size))

typedef enum quell_status {
  QUELL_OK = 0,
  QUELL_FAILED = 1,     // the reason was given to quell_host::set_error
  QUELL_CANCELLED = 2,  // stopped because quell_host::cancelled said so
} quell_status;

// ---------------------------------------------------------------------------------------------------------------- images

typedef enum quell_format { QUELL_FORMAT_F32 = 0, QUELL_FORMAT_U32 = 1 } quell_format;

// What a port carries. Each meaning is fixed; whoever reads files converts to it once.
typedef enum quell_type {
  QUELL_TYPE_COLOR = 0,  // 3 planes, scene-linear radiance
  QUELL_TYPE_ALBEDO,     // 3, reflectance, at least 0 (above 1 at grazing angles in some renderers)
  QUELL_TYPE_NORMAL,     // 3, world space, unit length, 0 where there is no surface
  QUELL_TYPE_POSITION,   // 3, world space
  QUELL_TYPE_DEPTH,      // 1, distance along the view axis, world units; exactly 1e10 where there is no surface
  QUELL_TYPE_ID,         // 1, uint32 object index; QUELL_NO_ID where there is no surface
  QUELL_TYPE_MOTION,     // 2, pixels, y down: previous position minus current position
  QUELL_TYPE_MOMENTS,    // 2, first and second moment of luminance
  QUELL_TYPE_VARIANCE,   // 1, of luminance
  QUELL_TYPE_SCALAR,     // 1, anything else with one value a pixel
  QUELL_TYPE_MASK,       // 1, 0 or 1
  QUELL_TYPE_ALPHA,      // 1, coverage
  QUELL_TYPE_CAMERA,     // not an image: quell_camera
  QUELL_TYPE_VALUE,      // not an image: an array of doubles
  QUELL_TYPE_COUNT
} quell_type;

#define QUELL_TYPE_BIT(type) (1u << (type))
#define QUELL_NO_ID 0xffffffffu
#define QUELL_NO_SURFACE_DEPTH 1e10f

// A planar image. Each row starts on a 64-byte boundary, and at least 64 bytes past its last pixel may be read (their content
// is unspecified). Coordinates: x right, y down; pixel (x, y) covers [x, x+1) x [y, y+1).
typedef struct quell_image {
  uint32_t struct_size;
  uint32_t type;           // quell_type
  uint32_t format;         // quell_format of every plane
  uint32_t channels;       // number of planes
  int32_t width, height;   // pixels, each at least 1
  ptrdiff_t row_stride;    // elements from a pixel to the one below it
  ptrdiff_t plane_stride;  // elements from a channel to the next
  void* data;              // channel 0 of pixel (0, 0); read-only for inputs
} quell_image;

// Where the camera and the objects stand in one frame. Matrices are 4x4, row-major, for column vectors (p' = M p).
typedef struct quell_camera {
  uint32_t struct_size;
  int32_t width, height;  // resolution that world_to_screen maps to
  double world_to_camera[16];
  double world_to_screen[16];  // after division by w: x and y in pixels, y down, pixel (i, j) covering [i, i+1) x [j, j+1)
  double jitter[2];            // pixels, already contained in world_to_screen
  uint32_t object_count;
  const uint32_t* object_ids;     // ascending
  const double* object_to_world;  // object_count matrices, in the order of object_ids; objects not listed did not move
} quell_camera;

typedef struct quell_values {
  uint32_t struct_size;
  uint32_t count;  // an output may lower it, never raise it above what infer asked for
  double* data;    // read-only for inputs
} quell_values;

// One thing that a port carries in one frame. All three pointers null: absent (an optional port, or no history yet).
typedef struct quell_item {
  uint32_t struct_size;
  uint32_t type;  // quell_type
  const quell_image* image;
  const quell_camera* camera;
  quell_values* values;
} quell_item;

// A plain port has one item, a port array as many as the graph connects, an unconnected optional port none.
typedef struct quell_port {
  uint32_t struct_size;
  uint32_t count;
  const quell_item* items;
} quell_port;

// ----------------------------------------------------------------------------------------------------------- descriptors

#define QUELL_PORT_OPTIONAL 1u  // input: may be unconnected, and may be absent in a frame
#define QUELL_PORT_ARRAY 2u     // input: a list of sources; output: as many items as the input array `same_as`
#define QUELL_PORT_ANY_SIZE 4u  // input: images of it may have another size than those of the other inputs; infer is told which

typedef struct quell_port_desc {
  uint32_t struct_size;
  uint32_t flags;    // QUELL_PORT_*
  const char* name;  // snake_case
  uint32_t types;    // QUELL_TYPE_BIT of every type accepted; 0 for an output whose type is that of `same_as`; outputs: no camera
  int32_t same_as;   // output: index of the input whose type (and, for arrays, count) it takes; -1 otherwise
  const char* doc;
} quell_port_desc;

typedef enum quell_param_type {
  QUELL_PARAM_BOOL = 0,
  QUELL_PARAM_INT = 1,  // int64
  QUELL_PARAM_DOUBLE = 2,
  QUELL_PARAM_STRING = 3,
  QUELL_PARAM_ENUM = 4,  // int64 index into enum_values
  QUELL_PARAM_PATH = 5,  // relative paths in a graph file are taken from that file's folder
} quell_param_type;

// A tagged value. `count` is 1 for a plain parameter; arrays (a matrix is 16 doubles) have any count.
typedef struct quell_param_value {
  uint32_t struct_size;
  uint32_t type;  // quell_param_type; tells which pointer is valid
  uint32_t count;
  union {
    const uint8_t* bools;
    const int64_t* ints;  // QUELL_PARAM_INT and QUELL_PARAM_ENUM
    const double* doubles;
    const char* const* strings;  // QUELL_PARAM_STRING and QUELL_PARAM_PATH
  } data;
} quell_param_value;

typedef struct quell_param_desc {
  uint32_t struct_size;
  uint32_t type;     // quell_param_type
  const char* name;  // snake_case
  const char* unit;  // "px", "world unit", ... or ""
  const char* doc;
  uint32_t is_array;               // 0: exactly one value
  uint32_t min_count, max_count;   // of an array
  double min_value, max_value;     // inclusive; for INT and DOUBLE
  const char* const* enum_values;  // for ENUM
  const char* const* enum_docs;
  uint32_t enum_count;
  const quell_param_value* default_value;
} quell_param_desc;

// What a version of a pass changed, so that graphs written for an earlier version keep their meaning.
typedef struct quell_change {
  uint32_t struct_size;
  uint32_t version;                         // the version that brought the change
  const char* param;                        // the parameter's name before it
  const char* renamed_to;                   // or null
  const quell_param_value* former_default;  // what a graph that does not set it meant; or null
} quell_change;

// --------------------------------------------------------------------------------------------------------- host services

#define QUELL_LOG_DEBUG 0
#define QUELL_LOG_INFO 1
#define QUELL_LOG_WARNING 2

typedef quell_status (*quell_chunk_fn)(void* context, int64_t chunk, int64_t begin, int64_t end, uint32_t slot);

typedef struct quell_host quell_host;
struct quell_host {
  uint32_t struct_size;
  uint32_t abi;   // QUELL_ABI_VERSION of the host
  void* context;  // the host's own
  // Cuts [begin, end) into chunks of `grain` (the last may be shorter) and calls fn once for each, on any thread. Chunks depend
  // on the arguments alone, never on the number of threads. `slot` is below quell_exec::slot_count and is not used by two
  // calls at a time. A nested call runs inline. All chunks run, and the status is that of the lowest chunk that failed; when
  // the run is cancelled, the chunks that have not begun are left out, and the status is QUELL_CANCELLED.
  quell_status (*parallel_for)(const quell_host*, int64_t begin, int64_t end, int64_t grain, quell_chunk_fn fn, void* context);
  void (*log)(const quell_host*, int level, const char* message);
  int (*cancelled)(const quell_host*);                        // non-zero: return QUELL_CANCELLED soon
  void (*set_error)(const quell_host*, const char* message);  // says why QUELL_FAILED is about to be returned
};

// -------------------------------------------------------------------------------------------------------------- a pass

#define QUELL_RADIUS_UNBOUNDED (-1)

// What an item will look like. `type` is quell_type; width and height are 0 for cameras and values.
typedef struct quell_shape {
  uint32_t struct_size;
  uint32_t type;
  int32_t width, height;
  uint32_t value_count;  // for QUELL_TYPE_VALUE
  uint32_t present;      // 0: this item is never there in this graph
} quell_shape;

typedef struct quell_port_shape {
  uint32_t struct_size;
  uint32_t count;  // items, as in quell_port
  quell_shape* items;
} quell_port_shape;

// A pass's answer to "what would you do with these inputs?". The host fills in everything before the call; infer changes what
// differs. Arrays have one element for each port of the descriptor, in its order.
typedef struct quell_inference {
  uint32_t struct_size;
  uint32_t input_count, output_count;
  const quell_port_shape* inputs;
  quell_port_shape* outputs;  // prefilled: declared (first) type, size of the first image input that is not of any size
  int32_t* radius;            // pixels read around a pixel, for each input; prefilled 0; or QUELL_RADIUS_UNBOUNDED
  int32_t* in_place_of;       // for each output: the input whose memory it may take over; prefilled -1 (needs radius 0)
  size_t scratch_bytes;       // for the whole frame; prefilled 0
  size_t slot_scratch_bytes;  // for each slot of parallel_for; prefilled 0
  // Not 0 promises that process touches images in loops of parallel_for alone, each over all rows of its outputs, which have one
  // height: for rows [begin, end) a loop writes just these rows of the outputs and reads no row of an input farther off than the
  // radius, and what becomes of a row depends neither on where chunks begin and end nor on their numbers. The host may then call
  // process several times for a frame, each time for some rows: its parallel_for leaves out the others, and only the rows that
  // these need are there in the images, whose sizes and coordinates are those of the whole. Needs scratch_bytes 0, and images as
  // outputs. Prefilled 0.
  uint32_t by_rows;
  // How long earlier frames last in this node's results, where these come back to it in later frames. kept: the largest share of
  // its history that is left in a result, so that k frames on no more than kept^k is; 0 to 1. settles: after how many frames
  // what it counts is the same, whatever it was before. Prefilled 1 and 0, which says that earlier frames may last for ever.
  double kept;
  int32_t settles;
} quell_inference;

typedef struct quell_exec {
  uint32_t struct_size;
  uint32_t input_count, output_count;
  uint32_t slot_count;
  int64_t frame;
  const quell_port* inputs;
  const quell_port* outputs;  // memory given by the host, content unspecified
  void* scratch;              // scratch_bytes, 64-byte aligned, content unspecified
  void* const* slot_scratch;  // slot_count blocks of slot_scratch_bytes, 64-byte aligned
} quell_exec;

typedef struct quell_pass_desc {
  uint32_t struct_size;
  uint32_t version;         // rises when a result or a parameter changes its meaning
  uint32_t oldest_version;  // graphs that name an older version are refused
  const char* id;           // snake_case, unique among all plugins
  const char* summary;      // one line
  const char* doc;          // paragraphs; may be ""
  const char* source;       // paper and equations that it implements, and where it departs from them
  const quell_port_desc* inputs;
  uint32_t input_count;
  const quell_port_desc* outputs;
  uint32_t output_count;
  const quell_param_desc* params;
  uint32_t param_count;
  const quell_change* changes;
  uint32_t change_count;
  // `params` holds param_count values in the order of the descriptor, all within type and range. What create builds depends on
  // them alone and does not change afterwards.
  quell_status (*create)(const quell_host*, const quell_param_value* params, void** instance);
  void (*destroy)(void* instance);
  quell_status (*infer)(const void* instance, const quell_host*, quell_inference*);
  quell_status (*process)(const void* instance, const quell_host*, const quell_exec*);
} quell_pass_desc;

// The two functions that a plugin exports. The second is called only when the first returned a version that the host can load.
typedef uint32_t (*quell_plugin_abi_fn)(void);
typedef const quell_pass_desc* const* (*quell_plugin_passes_fn)(uint32_t* count);
#define QUELL_PLUGIN_ABI_SYMBOL "quell_plugin_abi"
#define QUELL_PLUGIN_PASSES_SYMBOL "quell_plugin_passes"

#ifdef __cplusplus
}
#endif
#endif
