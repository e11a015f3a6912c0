/* A small correct pass in plain C, from which the bad plugins of this folder depart. It halves a color image. */
#ifndef QUELL_TESTS_PLAIN_PASS_H
#define QUELL_TESTS_PLAIN_PASS_H

#include "quell/sdk/abi.h"

#define EXPORT __attribute__((visibility("default")))

static const quell_port_desc plain_input = {sizeof(quell_port_desc), 0, "color", QUELL_TYPE_BIT(QUELL_TYPE_COLOR), -1, "in"};
static const quell_port_desc plain_output = {sizeof(quell_port_desc), 0, "color", QUELL_TYPE_BIT(QUELL_TYPE_COLOR), -1, "out"};

static inline quell_status plain_create(const quell_host* host, const quell_param_value* params, void** instance) {
  static int something;
  (void)host, (void)params;
  *instance = &something;
  return QUELL_OK;
}

static inline void plain_destroy(void* instance) { (void)instance; }

static inline quell_status plain_infer(const void* instance, const quell_host* host, quell_inference* inference) {
  (void)instance, (void)host, (void)inference;
  return QUELL_OK;
}

static inline quell_status plain_process(const void* instance, const quell_host* host, const quell_exec* exec) {
  const quell_image* from = QUELL_AT(quell_port, exec->inputs, 0)->items->image;
  const quell_image* to = QUELL_AT(quell_port, exec->outputs, 0)->items->image;
  (void)instance, (void)host;
  for (uint32_t c = 0; c < to->channels; ++c)
    for (int32_t y = 0; y < to->height; ++y)
      for (int32_t x = 0; x < to->width; ++x)
        ((float*)to->data)[c * to->plane_stride + y * to->row_stride + x] =
            ((const float*)from->data)[c * from->plane_stride + y * from->row_stride + x] / 2;
  return QUELL_OK;
}

/* A descriptor with the given id and functions. */
#define PASS(id, create, infer, process)                                                                                     \
  {                                                                                                                          \
    sizeof(quell_pass_desc), 1, 1, id, "Halves.", "", "", &plain_input, 1, &plain_output, 1, 0, 0, 0, 0, create, plain_destroy, \
        infer, process                                                                                                       \
  }
#define PLAIN_PASS(id) PASS(id, plain_create, plain_infer, plain_process)

#endif
