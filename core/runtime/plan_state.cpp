#include "quell/runtime/plan_state.h"

#include <algorithm>

namespace quell {
namespace {

Item make_constant(const InitialConstant& constant, BufferPool& pool) {
  const std::vector<double>& values = constant.values;
  const Shape& shape = constant.shape;
  if (shape.type == QUELL_TYPE_VALUE) return Item(Values(values));
  const auto of_plane = [&](int c) { return values.size() == 1 ? values[0] : values[static_cast<std::size_t>(c)]; };
  Image image(shape.type, shape.size, pool);
  for (int c = 0; c < image.channels(); ++c)
    for (int y = 0; y < image.height(); ++y) {
      if (info(shape.type).format == QUELL_FORMAT_U32)
        std::fill_n(image.writable_ids().row(y, c), image.width(), static_cast<std::uint32_t>(of_plane(c)));
      else
        std::fill_n(image.writable_floats().row(y, c), image.width(), static_cast<float>(of_plane(c)));
    }
  return image;
}

}  // namespace

PlanState::PlanState(Plan to_run, int frames_in_flight, BufferPool& pool, std::vector<std::int64_t> cuts)
    : plan(std::move(to_run)), wiring(plan), history(plan, frames_in_flight, std::move(cuts), wiring.resets.size()) {
  for (const InitialConstant& constant : wiring.constants) constants.push_back(make_constant(constant, pool));
}

}  // namespace quell
