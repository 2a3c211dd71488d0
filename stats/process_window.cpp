#include "stats/process_window.hpp"

#include "stats/confidence.hpp"
#include "stats/hypervolume.hpp"
#include "stats/sobol_sequence.hpp"

#include <boost/math/special_functions/gamma.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace grainsweep::stats {
namespace {

constexpr std::size_t integration_points = 1024, fewest_scores = 40;
constexpr double narrowest_share = 0.1, searched = 2;

/// The response whose error is `t` standard errors; of a probability see the header.
double response_at(const Prediction& p, Judged judged, double error, double t) {
    if (!p.latent) return p.mean + error * t;
    if (judged == Judged::mean) return normal_cdf(p.latent->mean + p.latent->error * t);
    return normal_cdf(t) > 1 - p.mean ? 1 : 0;
}

/// Standard error of what is judged. `widest`: of the header.
double judged_error(const Prediction& p, Judged judged, double widest) {
    if (judged == Judged::mean) return p.mean_error;
    if (!std::isfinite(p.even_scatter)) return p.run_error();
    return std::hypot(searched * p.mean_error, std::min(widest * p.scatter, std::max(p.scatter, p.even_scatter)));
}

/// The quantile of a sample, linear between its values.
double sample_quantile(std::span<const double> sorted, double u) {
    const double at =
        std::clamp(u * static_cast<double>(sorted.size()) - 0.5, 0.0, static_cast<double>(sorted.size() - 1));
    const auto below = std::min(static_cast<std::size_t>(at), sorted.size() - 2);
    return std::lerp(sorted[below], sorted[below + 1], at - static_cast<double>(below));
}

/// m* of the header; none where the condition is nowhere more likely than not.
std::optional<double> effective_best(std::span<const Prediction> objective, std::span<const double> probability,
                                     double sign) {
    std::optional<double> best;
    double best_cautious = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < objective.size(); ++i) {
        const double cautious = sign * objective[i].mean - objective[i].mean_error;
        if (probability[i] < 0.5 || cautious <= best_cautious) continue;
        best_cautious = cautious;
        best = sign * objective[i].mean;
    }
    return best;
}

}  // namespace

/// By Sobol points, cells centred.
SampledErrors::SampledErrors(std::span<const double> freedom, std::span<const std::vector<double>> scores)
    : models_(freedom.size()) {
    if (freedom.empty()) throw std::invalid_argument("process window: no model");
    std::vector<std::vector<double>> sorted(models_);
    for (std::size_t k = 0; k < models_; ++k) {
        if (k < scores.size() && scores[k].size() >= fewest_scores) sorted[k] = scores[k];
        std::ranges::sort(sorted[k]);
        const double f = freedom[k];
        const auto ratio = [&](double share) {
            return std::isfinite(f) ? std::sqrt(f / (2 * boost::math::gamma_p_inv(f / 2, share))) : 1;
        };
        widest_.push_back(ratio(narrowest_share));
        narrowest_.push_back(ratio(1 - narrowest_share));
    }
    SobolSequence sequence(models_);
    constexpr double cells = 0x1p64;
    for (std::size_t i = 0; i < integration_points * models_; ++i) {
        const double drawn = (static_cast<double>(sequence.next()) + 0.5 * cells / integration_points) / cells;
        const double u = std::min(drawn, 1 - 0x1p-53);
        const double f = freedom[i % models_];
        double error = std::isfinite(f) ? student_quantile(f, u) : normal_quantile(u);
        if (const auto& seen = sorted[i % models_]; !seen.empty()) {
            const double observed = sample_quantile(seen, u);
            error = u < 0.5 ? std::min(error, observed) : std::max(error, observed);
        }
        errors_.push_back(error);
    }
}

std::size_t SampledErrors::points() const {
    return integration_points;
}

std::vector<double> probability_of(std::span<const std::vector<Prediction>> predictions, const Condition& condition,
                                   Judged judged, const SampledErrors& errors) {
    const std::size_t d = predictions.size();
    if (d != errors.models()) throw std::invalid_argument("process window: errors of another number of models");
    const std::size_t n = predictions.front().size();
    std::vector<double> probability(n), responses(d), scale(d);
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t held = 0;
        for (std::size_t k = 0; k < d; ++k) scale[k] = judged_error(predictions[k][i], judged, errors.widest(k));
        for (std::size_t q = 0; q < errors.points(); ++q) {
            const auto error = errors.at(q);
            for (std::size_t k = 0; k < d; ++k)
                responses[k] = response_at(predictions[k][i], judged, scale[k], error[k]);
            held += condition(responses) ? 1U : 0U;
        }
        probability[i] = static_cast<double>(held) / static_cast<double>(errors.points());
    }
    return probability;
}

double learned(const Prediction& p) {
    return p.mean_error > 0 ? 1 - p.scatter / std::hypot(p.mean_error, p.scatter) : 0;
}

std::vector<double> expected_improvement(std::span<const Prediction> objective, std::span<const double> probability,
                                         bool maximise) {
    if (objective.size() != probability.size())
        throw std::invalid_argument("process window: one probability is needed for each setting");
    const double sign = maximise ? 1 : -1;
    const auto best = effective_best(objective, probability, sign);
    std::vector<double> gain(objective.size());
    for (std::size_t i = 0; i < gain.size(); ++i) {
        const Prediction& p = objective[i];
        gain[i] = probability[i];
        if (!best) continue;
        const double above = sign * p.mean - *best, s = p.mean_error;
        gain[i] *= expected_positive(above, s) * learned(p);
    }
    return gain;
}

std::vector<std::size_t> trade_off_front(std::span<const double> first, bool maximise_first,
                                         std::span<const double> second, bool maximise_second) {
    if (first.size() != second.size())
        throw std::invalid_argument("process window: the two figures have different numbers of points");
    const double sign = maximise_first ? 1 : -1, other_sign = maximise_second ? 1 : -1;
    std::vector<std::size_t> order(first.size()), front;
    std::iota(order.begin(), order.end(), std::size_t{0});
    // From the best first figure on, a point is on the front where its second figure is better than all before.
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
        if (first[a] != first[b]) return sign * first[a] > sign * first[b];
        if (second[a] != second[b]) return other_sign * second[a] > other_sign * second[b];
        return a < b;
    });
    for (const std::size_t i : order)
        if (std::isfinite(first[i]) && std::isfinite(second[i]) &&
            (front.empty() || other_sign * second[i] > other_sign * second[front.back()]))
            front.push_back(i);
    if (maximise_first) std::ranges::reverse(front);
    return front;
}

}  // namespace grainsweep::stats
