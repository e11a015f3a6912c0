#include "tuning.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <nlopt.hpp>
#include <utility>

namespace quell::app {
namespace {

constexpr double kFirstStep = 0.15, kLastStep = 1e-3;  // of the box

/// What NLopt calls, and what it must not see: exceptions.
struct Objective {
  const std::function<double(const std::vector<double>&)>& cost;
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  std::exception_ptr thrown;
  nlopt::opt* running = nullptr;

  static double call(const std::vector<double>& place, std::vector<double>&, void* data) {
    auto& self = *static_cast<Objective*>(data);
    try {
      const double cost = self.cost(place);
      if (cost < self.least) self.least = cost, self.best = place;
      return cost;
    } catch (...) {
      self.thrown = std::current_exception();
      self.running->force_stop();
      return self.least;
    }
  }
};

void run(nlopt::algorithm algorithm, int evaluations, Objective& objective) {
  nlopt::opt opt(algorithm, static_cast<unsigned>(objective.best.size()));
  opt.set_lower_bounds(0.0), opt.set_upper_bounds(1.0);
  opt.set_min_objective(Objective::call, &objective);
  opt.set_maxeval(evaluations);
  opt.set_xtol_abs(kLastStep);
  if (algorithm == nlopt::LN_SBPLX) opt.set_initial_step(kFirstStep);
  objective.running = &opt;
  std::vector<double> place = objective.best;
  double least = 0;
  try {
    opt.optimize(place, least);
  } catch (const nlopt::roundoff_limited&) {  // as near as it gets
  } catch (const nlopt::forced_stop&) { std::rethrow_exception(objective.thrown); }
}

}  // namespace

void find_least(const std::vector<double>& start, const SearchOptions& options,
                const std::function<double(const std::vector<double>&)>& cost) {
  Objective objective{cost, start, std::numeric_limits<double>::infinity(), {}, nullptr};
  const int everywhere = options.looks_everywhere ? options.evaluations / 2 : 0;
  if (everywhere > 0) run(nlopt::GN_DIRECT_L, everywhere, objective);
  run(nlopt::LN_SBPLX, std::max(options.evaluations - everywhere, 1), objective);
}

}  // namespace quell::app
