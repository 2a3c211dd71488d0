#include "stats/response/climb.hpp"

#include <nlopt.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace grainsweep::stats::response {
namespace {

constexpr double singular = 1e10;  // stands for an infinite minus log density

struct Search {
    const Ascent* function;
    Climbed best;
};

/// The function as NLopt calls it.
double objective(unsigned size, const double* x, double* gradient, void* data) {
    auto& search = *static_cast<Search*>(data);
    const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(x, static_cast<Eigen::Index>(size));
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(at.size());
    const double value = (*search.function)(at, slope);
    if (value > search.best.value) search.best = {value, at};
    if (gradient) Eigen::Map<Eigen::VectorXd>(gradient, slope.size()) = -slope;
    return std::isfinite(value) ? -value : singular;
}

}  // namespace

Climbed climb(const Ascent& function, const Eigen::VectorXd& from, const Bounds& bounds, double tolerance,
              int most_looks) {
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> opt(
        nlopt_create(NLOPT_LD_LBFGS, static_cast<unsigned>(from.size())), &nlopt_destroy);
    Search search{&function, {-std::numeric_limits<double>::infinity(), from}};
    nlopt_set_lower_bounds(opt.get(), bounds.low.data());
    nlopt_set_upper_bounds(opt.get(), bounds.high.data());
    nlopt_set_min_objective(opt.get(), objective, &search);
    nlopt_set_ftol_abs(opt.get(), tolerance);
    nlopt_set_maxeval(opt.get(), most_looks);
    Eigen::VectorXd x = from.cwiseMax(bounds.low).cwiseMin(bounds.high);
    double value = 0;
    // A line search that ends on round-off is reported as a failure; the best point seen counts either way.
    (void)nlopt_optimize(opt.get(), x.data(), &value);
    return std::move(search.best);
}

}  // namespace grainsweep::stats::response
