#include "stats/distribution.hpp"

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/extreme_value.hpp>
#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/triangular.hpp>
#include <boost/math/distributions/weibull.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace grainsweep::stats {
namespace {

namespace bm = boost::math;

/// A root that is not found to the last bit, far below any probability of a design, is good enough as it is.
using Policy = bm::policies::policy<bm::policies::promote_double<false>,
                                    bm::policies::evaluation_error<bm::policies::ignore_error>>;

constexpr double nearest_to_end = 0x1p-32;
constexpr double outside = 0.001;  // of the stated range, on each side

bm::normal_distribution<double, Policy> in_boost(const Normal& form) {
    return {form.mean, form.sd};
}

bm::lognormal_distribution<double, Policy> in_boost(const Lognormal& form) {
    return {std::log(form.median), form.sigma};
}

bm::weibull_distribution<double, Policy> in_boost(const Weibull& form) {
    return {form.shape, form.scale};
}

bm::extreme_value_distribution<double, Policy> in_boost(const Gumbel& form) {
    return {form.location, form.scale};
}

bm::triangular_distribution<double, Policy> in_boost(const Triangular& form) {
    return {form.low, form.mode, form.high};
}

bm::beta_distribution<double, Policy> in_boost(const Beta& form) {
    return {form.a, form.b};
}

/// Probabilities below and above a number.
struct Tails {
    double below = 0, above = 0;
};

template <class Of>
Tails tails_at(const Of& distribution, double x) {
    return {bm::cdf(distribution, x), bm::cdf(bm::complement(distribution, x))};
}

template <class Of>
double quantile_at(const Of& distribution, const Tails& tails) {
    return tails.below < tails.above ? bm::quantile(distribution, tails.below)
                                     : bm::quantile(bm::complement(distribution, tails.above));
}

/// Probabilities below and above x of a form that has no ends.
struct TailsOf {
    double x;
    Tails operator()(const Normal& form) const { return tails_at(in_boost(form), x); }
    Tails operator()(const Lognormal& form) const { return x <= 0 ? Tails{0, 1} : tails_at(in_boost(form), x); }
    Tails operator()(const Weibull& form) const { return x <= 0 ? Tails{0, 1} : tails_at(in_boost(form), x); }
    Tails operator()(const Gumbel& form) const { return tails_at(in_boost(form), x); }
    Tails operator()(const Triangular& form) const {
        return tails_at(in_boost(form), std::clamp(x, form.low, form.high));
    }
    Tails operator()(const Beta& form) const {
        return tails_at(in_boost(form), std::clamp((x - form.low) / (form.high - form.low), 0.0, 1.0));
    }
    Tails operator()(const SampleColumn& form) const {
        const double u = form.sample->cumulative(form.column, x);
        return {u, 1 - u};
    }
};

struct QuantileOf {
    Tails tails;
    double operator()(const Normal& form) const { return quantile_at(in_boost(form), tails); }
    double operator()(const Lognormal& form) const { return quantile_at(in_boost(form), tails); }
    double operator()(const Weibull& form) const { return quantile_at(in_boost(form), tails); }
    double operator()(const Gumbel& form) const { return quantile_at(in_boost(form), tails); }
    double operator()(const Triangular& form) const { return quantile_at(in_boost(form), tails); }
    double operator()(const Beta& form) const {
        return form.low + (form.high - form.low) * quantile_at(in_boost(form), tails);
    }
    double operator()(const SampleColumn& form) const { return form.sample->quantile(form.column, tails.below); }
};

struct EndsOf {
    std::pair<double, double> truncated;
    std::pair<double, double> operator()(const Triangular& form) const { return {form.low, form.high}; }
    std::pair<double, double> operator()(const Beta& form) const { return {form.low, form.high}; }
    std::pair<double, double> operator()(const SampleColumn& form) const {
        return {form.sample->quantile(form.column, 0), form.sample->quantile(form.column, 1)};
    }
    template <class Endless>
    std::pair<double, double> operator()(const Endless&) const {
        return truncated;
    }
};

}  // namespace

Distribution::Distribution(Form form, double low, double high) : form_(std::move(form)), low_(low), high_(high) {
    std::tie(low_, high_) = std::visit(EndsOf{{low, high}}, form_);
    if (has_ends()) return;
    if (std::isfinite(low_)) below_ = std::visit(TailsOf{low_}, form_).below;
    if (std::isfinite(high_)) above_ = std::visit(TailsOf{high_}, form_).above;
}

bool Distribution::has_ends() const {
    return !std::holds_alternative<Normal>(form_) && !std::holds_alternative<Lognormal>(form_) &&
           !std::holds_alternative<Weibull>(form_) && !std::holds_alternative<Gumbel>(form_);
}

std::pair<double, double> Distribution::range() const {
    if (has_ends()) return {low_, high_};
    return {quantile(outside), quantile(1 - outside)};
}

double Distribution::quantile(double u) const {
    if (has_ends() && !(u > 0)) return low_;
    if (has_ends() && !(u < 1)) return high_;
    if (!has_ends()) u = std::clamp(u, nearest_to_end, 1 - nearest_to_end);
    const double left = 1 - below_ - above_;
    const Tails tails{below_ + u * left, above_ + (1 - u) * left};
    return std::clamp(std::visit(QuantileOf{tails}, form_), low_, high_);
}

double Distribution::cumulative(double x) const {
    if (x < low_) return 0;
    if (x > high_) return 1;
    const auto tails = std::visit(TailsOf{x}, form_);
    const double left = 1 - below_ - above_;
    const double u = tails.below < tails.above ? (tails.below - below_) / left : 1 - (tails.above - above_) / left;
    return std::clamp(u, 0.0, 1.0);
}

}  // namespace grainsweep::stats
